#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| hysteron_fuzz::timestamps::read(data));
