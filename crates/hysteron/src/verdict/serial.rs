//! A verdict as JSON and Python have it.

use super::{Basis, Grade, Verdict, Worst};
use crate::series::Errors;
use serde::{Serialize, Serializer};

/// Numbers as fields, and the sentences as `text`.
impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Fields<'a> {
            grade: Grade,
            basis: Basis,
            rmse: f64,
            percent: Option<f64>,
            noise: f64,
            inverse: Option<Errors>,
            rival: Option<(&'a str, f64)>,
            causes: Vec<(&'static str, String)>,
            worst: Option<&'a Worst>,
            text: String,
        }
        let causes = self.causes.iter();
        Fields {
            grade: self.grade,
            basis: self.basis,
            rmse: self.rmse,
            percent: self.percent,
            noise: self.noise,
            inverse: self.inverse,
            rival: self
                .rival
                .as_ref()
                .map(|(name, percent)| (name.as_str(), *percent)),
            causes: causes
                .map(|cause| (cause.name(), self.sentence(cause)))
                .collect(),
            worst: self.worst.as_ref(),
            text: self.to_string(),
        }
        .serialize(serializer)
    }
}
