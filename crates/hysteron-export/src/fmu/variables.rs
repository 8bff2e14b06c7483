//! The variables of the blocks.

use super::control::parameters;
use super::options::Block;
use super::staged::{first, first_target, is_loaded};
use hysteron::control::Scheme;
use hysteron::{Model, Quantity, Result};

/// A variable as FMI describes it.
pub(super) struct Variable {
    pub(super) name: String,
    /// Its place among the constants of `hysteron-capi/src/fmi/values.rs`.
    pub(super) reference: u32,
    pub(super) kind: Kind,
    pub(super) causality: &'static str,
    pub(super) variability: &'static str,
    pub(super) initial: Option<&'static str>,
    pub(super) start: Option<String>,
    pub(super) unit: Option<String>,
    /// Whether it is a difference, which the offset of a unit does not concern.
    pub(super) relative: bool,
    /// Lowest and highest value, as they are written.
    pub(super) range: (Option<&'static str>, Option<&'static str>),
    pub(super) description: String,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Real,
    Integer,
    Boolean,
}

const SIGN: (Option<&str>, Option<&str>) = (Some("-1"), Some("1"));
const STATUS: (Option<&str>, Option<&str>) = (Some("-1"), Some("3"));

/// All of a block, in the order of the description.
pub(super) fn all(model: &Model, block: Block<'_>) -> Result<Vec<Variable>> {
    let (low, high) = model.active_range();
    let active = match model.thermal {
        None => format!("active from {low} to {high}"),
        Some(_) => {
            let (low, high) = model.drive_range();
            format!("the drive of a thermal body, held over the step; from {low} to {high}")
        }
    };
    let outside = match model.thermal {
        None => "; outside it is taken as the nearest end",
        Some(_) => "",
    };
    let (off, on) = model.output_range();
    let reach = format!("from {off} with all operators off to {on} with all on");
    // Where the model file has no names: an input called `output` would say the wrong thing.
    let mut wanted = model.output.clone();
    if wanted.name == "output" {
        wanted.name = "target".into();
    }
    let mut variables = match block {
        Block::Forward => vec![
            time(),
            // No minimum and maximum: tools stop at them, and the model does not.
            input(
                1,
                &model.input,
                first(model).0,
                format!("{active}{outside}"),
            ),
            output(2, &model.output, reach),
            flag(
                3,
                "clipped",
                SIGN,
                "whether the input lay outside the active range: -1 below, 1 above",
            ),
            start_on(),
        ],
        Block::Inverse => vec![
            time(),
            input(
                1,
                &wanted,
                first_target(model)?,
                format!("the output that is wanted; {reach}"),
            ),
            output(
                2,
                &model.input,
                format!("the input that gives the wanted output; {active}"),
            ),
            flag(
                3,
                "status",
                STATUS,
                "whether the wanted output is reached: 0; -1 below and 1 above every output; 2 \
                 where a relay jumps past it; 3 where it cannot be reached in this step",
            ),
            heading(),
            tolerance(&model.output, 0.0),
            start_on(),
        ],
        Block::Controller(scheme) => controller(model, scheme, &wanted)?,
    };
    variables[0].description = match model.is_timed() {
        true => "simulation time; a communication step is a step of the model",
        false => "simulation time, on which nothing depends",
    }
    .into();
    if let Some(load) = model.load.as_ref().filter(|_| is_loaded(model)) {
        let (low, high) = load.range();
        let description = format!("the load, from {low} to {high}");
        variables.push(input(7, &load.quantity, first(model).1, description));
    }
    if model.thermal.is_some() {
        let temperature = Quantity::named("temperature");
        let description = "of the thermal body, at the end of the step".into();
        variables.push(output(8, &temperature, description));
    }
    if model.fitted().is_some() {
        let start = variables
            .iter_mut()
            .filter(|variable| variable.reference == 6);
        start.for_each(|start| start.description = START_FITTED.into());
    }
    Ok(with_names(variables))
}

/// The flags of a controller, added.
const FLAGS: (Option<&str>, Option<&str>) = (Some("0"), Some("95"));

/// Those of a controller.
fn controller(model: &Model, scheme: &Scheme, wanted: &Quantity) -> Result<Vec<Variable>> {
    let first = first_target(model)?;
    let named = |name: &str| Quantity {
        name: name.into(),
        ..model.output.clone()
    };
    let ahead = "by how much the wanted output will have changed when the drive is seen to act; 0 \
                 if unknown";
    let mut variables = vec![
        time(),
        input(1, wanted, first, "the output that is wanted now".into()),
        input(
            9,
            &named("measured"),
            first,
            "the output as its sensor read it; NaN where it gave nothing".into(),
        ),
        Variable {
            relative: true,
            ..input(10, &named("ahead"), 0.0, ahead.into())
        },
        output(2, &model.input, "the drive to write".into()),
        flag(
            3,
            "status",
            FLAGS,
            "flags, added: 1 the drive is at a limit; 2 out of reach; 4 no reading; 8 the reading \
             stands still; 16 given up, the drive is the safe one; 64 an outlier",
        ),
        heading(),
        tolerance(&model.output, scheme.tolerance),
        start_on(),
        Variable {
            causality: "input",
            variability: "discrete",
            initial: None,
            reference: 11,
            name: "manual".into(),
            description: "give `manual_drive`; the loop then goes on from there without a bump"
                .into(),
            ..start_on()
        },
        input(
            12,
            &Quantity {
                name: "manual_drive".into(),
                ..model.input.clone()
            },
            0.0,
            "the drive of manual operation".into(),
        ),
    ];
    let settings = parameters(scheme).into_iter().zip(13..);
    variables.extend(
        settings.map(|((name, start, description), reference)| Variable {
            name: name.into(),
            reference,
            causality: "parameter",
            variability: "tunable",
            initial: Some("exact"),
            start: Some(format!("{start:?}")),
            description: description.into(),
            ..time()
        }),
    );
    Ok(variables)
}

const START_FITTED: &str = "start with all operators on, as after an input at the top, instead of \
                            the state that the fit found";

fn time() -> Variable {
    Variable {
        name: "time".into(),
        reference: 0,
        kind: Kind::Real,
        causality: "independent",
        variability: "continuous",
        initial: None,
        start: None,
        unit: None,
        relative: false,
        range: (None, None),
        description: "simulation time, on which nothing depends".into(),
    }
}

fn input(reference: u32, quantity: &Quantity, start: f64, description: String) -> Variable {
    Variable {
        name: clean(&quantity.name),
        reference,
        causality: "input",
        start: Some(format!("{start:?}")),
        unit: unit(quantity),
        description,
        ..time()
    }
}

fn output(reference: u32, quantity: &Quantity, description: String) -> Variable {
    Variable {
        name: clean(&quantity.name),
        reference,
        causality: "output",
        initial: Some("calculated"),
        unit: unit(quantity),
        description,
        ..time()
    }
}

fn flag(
    reference: u32,
    name: &str,
    range: (Option<&'static str>, Option<&'static str>),
    description: &str,
) -> Variable {
    Variable {
        name: name.into(),
        reference,
        kind: Kind::Integer,
        causality: "output",
        variability: "discrete",
        initial: Some("calculated"),
        range,
        description: description.into(),
        ..time()
    }
}

fn heading() -> Variable {
    Variable {
        name: "heading".into(),
        reference: 4,
        kind: Kind::Integer,
        causality: "input",
        variability: "discrete",
        start: Some("0".into()),
        range: SIGN,
        description: "where the wanted output goes next: 1 or -1, so that the input crosses the \
                      dead band at once; 0 if unknown"
            .into(),
        ..time()
    }
}

fn tolerance(output: &Quantity, start: f64) -> Variable {
    Variable {
        name: "tolerance".into(),
        reference: 5,
        causality: "parameter",
        variability: "tunable",
        initial: Some("exact"),
        start: Some(format!("{start:?}")),
        unit: unit(output),
        relative: true,
        range: (Some("0.0"), None),
        description: "reversals of the wanted output up to this size are noise and not followed"
            .into(),
        ..time()
    }
}

fn start_on() -> Variable {
    Variable {
        name: "start_on".into(),
        reference: 6,
        kind: Kind::Boolean,
        causality: "parameter",
        variability: "fixed",
        initial: Some("exact"),
        start: Some("false".into()),
        description: "start with all operators on, as after an input at the top, instead of off"
            .into(),
        ..time()
    }
}

fn unit(quantity: &Quantity) -> Option<String> {
    let unit = quantity.unit.as_deref().map(clean);
    unit.filter(|unit| !unit.is_empty())
}

/// Without characters that XML or a tool cannot hold.
fn clean(text: &str) -> String {
    let legal = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().filter(legal).collect();
    text.trim().into()
}

/// Names that are not empty and differ: those of the model file where possible.
fn with_names(mut variables: Vec<Variable>) -> Vec<Variable> {
    for n in 0..variables.len() {
        let Variable {
            name,
            reference,
            causality,
            ..
        } = &variables[n];
        let taken = |name: &str| {
            let others = variables.iter().enumerate();
            // If two signals have one name, the later is renamed; a clash with our own names
            // renames the signal.
            others.clone().any(|(m, other)| {
                let ours = [3, 4, 5, 6].contains(&other.reference) || other.reference >= 9;
                m != n && other.name == name && (m < n || ours)
            })
        };
        let mut name = if name.is_empty() {
            causality.to_string()
        } else {
            name.clone()
        };
        if [1, 2, 7, 8].contains(reference) {
            while taken(&name) {
                name = format!("{name}_{causality}");
            }
        }
        variables[n].name = name;
    }
    variables
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use hysteron::{Operator, Plane, Sign};

    fn names(input: &str, output: &str) -> Vec<String> {
        let plane = Plane::new(0.0, 1.0, 2).unwrap();
        let mut model =
            Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
        model.input.name = input.into();
        model.output.name = output.into();
        all(&model, Block::Forward)
            .unwrap()
            .into_iter()
            .map(|v| v.name)
            .collect()
    }

    #[test]
    fn names_are_there_and_differ() {
        assert_eq!(names("a\tb ", "Länge <1>")[1..3], ["ab", "Länge <1>"]);
        assert_eq!(names("", " \n")[1..3], ["input", "output"]);
        assert_eq!(names("x", "x")[1..3], ["x", "x_output"]);
        assert_eq!(
            names("time", "clipped")[1..3],
            ["time_input", "clipped_output"]
        );
        for (input, output) in [
            ("x_output", "x"),
            ("output", ""),
            ("time", "time_input"),
            ("time_input", "time"),
        ] {
            let names = names(input, output);
            let different: std::collections::HashSet<_> = names.iter().collect();
            assert_eq!(different.len(), names.len(), "{names:?}");
        }
    }
}
