#![no_main]

libfuzzer_sys::fuzz_target!(|asked: hysteron_fuzz::prepare::Asked| asked.check());
