#![no_main]

libfuzzer_sys::fuzz_target!(
    |calls: Vec<hysteron_fuzz::c_calls::Call>| hysteron_fuzz::c_calls::run(&calls)
);
