#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| hysteron_fuzz::scenario::read(text));
