#![no_main]

libfuzzer_sys::fuzz_target!(|walk: hysteron_fuzz::inverse::Walk| walk.check());
