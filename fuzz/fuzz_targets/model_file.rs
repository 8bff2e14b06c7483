#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| hysteron_fuzz::model_file::read(text));
