//! The stages of a model, as they declare themselves.

use crate::model::Model;
use hysteron_core::{Stages, Unit};
use serde::Serialize;

/// A stage that a model has.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageSummary {
    /// Its name.
    pub name: &'static str,
    /// What it does, in one sentence.
    pub about: &'static str,
    /// Its constants.
    pub constants: Vec<ConstantSummary>,
}

/// A constant of a stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstantSummary {
    /// Its name.
    pub name: &'static str,
    /// The unit of its numbers; `None` for none, and where the model does not know it.
    pub unit: Option<String>,
    /// Its numbers.
    pub numbers: Vec<f64>,
}

/// The stages that `model` has, in the order of the signal.
pub(super) fn stages_of(model: &Model) -> Vec<StageSummary> {
    let constants = model.constants();
    let stages = Stages::<f64>::declared().map(|stage| StageSummary {
        name: stage.name,
        about: stage.about,
        constants: stage
            .constants
            .iter()
            .map(|constant| ConstantSummary {
                name: constant.name,
                unit: unit_of(constant.unit, model),
                numbers: constants.get(constant.name).to_vec(),
            })
            .filter(|constant| !constant.numbers.is_empty())
            .collect(),
    });
    stages.filter(|stage| !stage.constants.is_empty()).collect()
}

fn unit_of(unit: Unit, model: &Model) -> Option<String> {
    match unit {
        Unit::Second => Some("s".into()),
        Unit::Hertz => Some("Hz".into()),
        // With a body the input is its drive, and the unit of its temperature is not recorded.
        Unit::Temperature if model.thermal.is_none() => model.input.unit.clone(),
        Unit::Load => model.load.as_ref()?.quantity.unit.clone(),
        Unit::Output => model.output.unit.clone(),
        Unit::One | Unit::Temperature | Unit::TemperaturePerDrive => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::inspect::inspect_model;
    use crate::model::{FirstOrder, Model, Plane, Sign};
    use hysteron_core::Operator;

    #[test]
    fn a_model_tells_its_stages_and_where_its_levels_are() {
        let plane = Plane::new(20.0, 30.0, 3).unwrap();
        let mut model =
            Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive).unwrap();
        model.input.unit = Some("degC".into());
        let plain = inspect_model(&model).unwrap();
        assert_eq!((plain.plane, plain.steps), ((20.0, 30.0), (5.0, 5.0)));
        assert!(plain.stages.is_empty());

        let corners = vec![10.0, 21.0, 22.0, 25.0];
        let model = model.with_spacing(corners.clone()).unwrap();
        let spaced = inspect_model(&model).unwrap();
        assert_eq!((spaced.plane, spaced.steps), ((21.0, 25.0), (1.0, 3.0)));
        assert!(corners.contains(&spaced.widest_loop_at));
        let constant = &spaced.stages[0].constants[0];
        assert_eq!(
            (constant.name, constant.unit.as_deref()),
            ("spacing", Some("degC"))
        );
        assert_eq!(constant.numbers, corners);

        let mut model = model;
        model.thermal = Some(FirstOrder::default());
        let heated = inspect_model(&model.with_latent(3.0).unwrap()).unwrap();
        let named = |stage: &crate::StageSummary| (stage.name, stage.constants.len());
        let named: Vec<_> = heated.stages.iter().map(named).collect();
        assert_eq!(named, [("body", 4), ("latent", 1), ("spacing", 1)]);
        assert_eq!(heated.stages[1].constants[0].numbers, [3.0]);
        // The model knows the unit of its drive.
        assert_eq!(heated.stages[2].constants[0].unit, None);
    }
}
