#![no_main]

libfuzzer_sys::fuzz_target!(|chain: hysteron_fuzz::stages::Chain| chain.check());
