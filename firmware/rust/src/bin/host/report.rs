pub fn page(_: &(Vec<crate::data::Model>, Vec<crate::data::Run>), _: &str, _: &str) -> Result<String, String> { Ok(String::new()) }
