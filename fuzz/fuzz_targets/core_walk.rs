#![no_main]

libfuzzer_sys::fuzz_target!(|walk: hysteron_fuzz::core_walk::Walk| walk.check());
