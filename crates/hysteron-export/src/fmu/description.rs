//! `modelDescription.xml`.

use super::Fmi;
use super::options::Block;
use super::units;
use super::variables::{Kind, Variable};
use hysteron::{Error, Model, Result};
use hysteron_core::Unit;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::collections::BTreeSet;
use std::io;

type Xml = Writer<Vec<u8>>;

pub(super) fn xml(
    model: &Model,
    (name, token): (&str, &str),
    (fmi, block, sources): (Fmi, Block<'_>, &[&str]),
    variables: &[Variable],
) -> Result<String> {
    let about = about(model, block);
    let step = match block {
        Block::Controller(scheme) => scheme.interval_s,
        Block::Forward | Block::Inverse => step(model),
    };
    // A loop remembers more than the bytes of a saved state have.
    let is_serial = !matches!(block, Block::Controller(_));
    let written = write(
        (name, token),
        (&about, step),
        (fmi, is_serial, sources),
        variables,
    );
    let text = written.map(String::from_utf8);
    match text {
        Ok(Ok(text)) => Ok(text + "\n"),
        _ => Err(Error::Export("the description cannot be made".into())),
    }
}

fn about(model: &Model, block: Block<'_>) -> String {
    let (operator, levels) = (model.operator(), model.plane().levels());
    let operator = format!("{operator:?}").to_uppercase();
    let name = match block {
        Block::Forward => format!("{operator} hysteresis model with {levels} levels"),
        Block::Inverse => {
            format!("Exact inverse of a hysteresis model ({operator}, {levels} levels)")
        }
        Block::Controller(_) => {
            format!("Controller with a hysteresis model ({operator}, {levels} levels)")
        }
    };
    // A clock is rounded; a nanosecond is no part of a time that one gives.
    let seconds = (model.delay().seconds() * 1e9).round() / 1e9;
    match (model.delay().is_none(), block) {
        (true, _) => name,
        (false, Block::Forward) => format!("{name}; its input acts {seconds} s later"),
        (false, Block::Controller(_)) => format!("{name}; its drive acts {seconds} s later"),
        (false, Block::Inverse) => format!(
            "{name}; its input acts {seconds} s later, so the wanted output is the one of then"
        ),
    }
}

/// The step of a default experiment: a tenth of the shortest time constant, or of 0.1 s for a model
/// without time.
fn step(model: &Model) -> f64 {
    let constants = model.constants();
    let times = constants
        .iter()
        .filter(|(constant, _)| constant.unit == Unit::Second);
    let times = times.flat_map(|(_, numbers)| numbers).copied();
    let shortest = times.filter(|tau| *tau > 0.0).fold(0.1, f64::min);
    0.1 * shortest
}

fn write(
    (name, token): (&str, &str),
    (about, step): (&str, f64),
    (fmi, is_serial, sources): (Fmi, bool, &[&str]),
    variables: &[Variable],
) -> io::Result<Vec<u8>> {
    let mut xml = Xml::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let token_name = match fmi {
        Fmi::V2 => "guid",
        Fmi::V3 => "instantiationToken",
    };
    let root = xml.create_element("fmiModelDescription").with_attributes([
        ("fmiVersion", fmi.version()),
        ("modelName", name),
        (token_name, token),
        ("description", about),
        (
            "generationTool",
            concat!("hysteron ", env!("CARGO_PKG_VERSION")),
        ),
        ("variableNamingConvention", "flat"),
    ]);
    root.write_inner_content(|xml| {
        co_simulation(xml, name, (fmi, is_serial), sources)?;
        unit_definitions(xml, variables)?;
        xml.create_element("LogCategories")
            .write_inner_content(|xml| {
                let category = xml.create_element("Category");
                let attributes = [
                    ("name", "logStatusError"),
                    ("description", "why a call failed"),
                ];
                category.with_attributes(attributes).write_empty()?;
                Ok(())
            })?;
        let stop = format!("{:?}", 1000.0 * step);
        let step = format!("{step:?}");
        let times = [("startTime", "0"), ("stopTime", &stop), ("stepSize", &step)];
        xml.create_element("DefaultExperiment")
            .with_attributes(times)
            .write_empty()?;
        xml.create_element("ModelVariables")
            .write_inner_content(|xml| {
                variables.iter().try_for_each(|variable| match fmi {
                    Fmi::V2 => scalar_variable(xml, variable),
                    Fmi::V3 => typed_variable(xml, variable),
                })
            })?;
        xml.create_element("ModelStructure")
            .write_inner_content(|xml| structure(xml, fmi, variables))?;
        Ok(())
    })?;
    Ok(xml.into_inner())
}

fn co_simulation(
    xml: &mut Xml,
    name: &str,
    (fmi, is_serial): (Fmi, bool),
    sources: &[&str],
) -> io::Result<()> {
    let element = xml.create_element("CoSimulation");
    let element = element.with_attributes([
        ("modelIdentifier", name),
        ("canHandleVariableCommunicationStepSize", "true"),
    ]);
    let offered = match fmi {
        Fmi::V2 => &[
            "canNotUseMemoryManagementFunctions",
            "canGetAndSetFMUstate",
            "canSerializeFMUstate",
        ][..],
        Fmi::V3 => &["canGetAndSetFMUState", "canSerializeFMUState"],
    };
    let offered = offered
        .iter()
        .filter(|name| is_serial || !name.contains("Serialize"));
    let element = element.with_attributes(offered.map(|name| (*name, "true")));
    // FMI 3.0 has a file of its own for them.
    if fmi == Fmi::V3 || sources.is_empty() {
        element.write_empty()?;
        return Ok(());
    }
    element.write_inner_content(|xml| {
        xml.create_element("SourceFiles")
            .write_inner_content(|xml| {
                sources.iter().try_for_each(|file| {
                    let element = xml.create_element("File").with_attribute(("name", *file));
                    element.write_empty().map(|_| ())
                })
            })?;
        Ok(())
    })?;
    Ok(())
}

fn unit_definitions(xml: &mut Xml, variables: &[Variable]) -> io::Result<()> {
    let units: BTreeSet<&str> = variables.iter().filter_map(|v| v.unit.as_deref()).collect();
    if units.is_empty() {
        return Ok(());
    }
    xml.create_element("UnitDefinitions")
        .write_inner_content(|xml| {
            for name in units {
                let unit = xml.create_element("Unit").with_attribute(("name", name));
                let Some(base) = units::base(name) else {
                    unit.write_empty()?;
                    continue;
                };
                unit.write_inner_content(|xml| {
                    let mut element = xml.create_element("BaseUnit");
                    for (unit, exponent) in base.exponents {
                        element = element.with_attribute((*unit, exponent.to_string().as_str()));
                    }
                    if base.factor != 1.0 {
                        element = element
                            .with_attribute(("factor", format!("{:?}", base.factor).as_str()));
                    }
                    if base.offset != 0.0 {
                        element = element
                            .with_attribute(("offset", format!("{:?}", base.offset).as_str()));
                    }
                    element.write_empty()?;
                    Ok(())
                })?;
            }
            Ok(())
        })?;
    Ok(())
}

/// What FMI 2.0 has on the variable and FMI 3.0 on its type alike.
fn common(variable: &Variable) -> Vec<(&'static str, String)> {
    let mut attributes = vec![
        ("name", variable.name.clone()),
        ("valueReference", variable.reference.to_string()),
        ("description", variable.description.clone()),
        ("causality", variable.causality.into()),
        ("variability", variable.variability.into()),
    ];
    attributes.extend(variable.initial.map(|initial| ("initial", initial.into())));
    attributes
}

fn of_type(variable: &Variable) -> Vec<(&'static str, String)> {
    let (min, max) = variable.range;
    let all = [
        ("unit", variable.unit.clone()),
        ("relativeQuantity", variable.relative.then(|| "true".into())),
        ("min", min.map(Into::into)),
        ("max", max.map(Into::into)),
        ("start", variable.start.clone()),
    ];
    all.into_iter()
        .filter_map(|(name, value)| Some((name, value?)))
        .collect()
}

fn pairs<'a>(attributes: &'a [(&'static str, String)]) -> impl Iterator<Item = (&'a str, &'a str)> {
    attributes
        .iter()
        .map(|(name, value)| (*name, value.as_str()))
}

fn scalar_variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let kind = match variable.kind {
        Kind::Real => "Real",
        Kind::Integer => "Integer",
        Kind::Boolean => "Boolean",
    };
    let element = xml.create_element("ScalarVariable");
    element
        .with_attributes(pairs(&common(variable)))
        .write_inner_content(|xml| {
            xml.create_element(kind)
                .with_attributes(pairs(&of_type(variable)))
                .write_empty()?;
            Ok(())
        })?;
    Ok(())
}

fn typed_variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let kind = match variable.kind {
        Kind::Real => "Float64",
        Kind::Integer => "Int32",
        Kind::Boolean => "Boolean",
    };
    let attributes = [common(variable), of_type(variable)].concat();
    xml.create_element(kind)
        .with_attributes(pairs(&attributes))
        .write_empty()?;
    Ok(())
}

/// Outputs depend on inputs, and at the start on parameters too.
fn structure(xml: &mut Xml, fmi: Fmi, variables: &[Variable]) -> io::Result<()> {
    // FMI 2.0 counts the variables from 1, FMI 3.0 takes their value references.
    let key = |n: usize| match fmi {
        Fmi::V2 => (n + 1).to_string(),
        Fmi::V3 => variables[n].reference.to_string(),
    };
    let having = |allowed: &[&str]| -> Vec<String> {
        let of = |n: &usize| allowed.contains(&variables[*n].causality);
        (0..variables.len()).filter(of).map(key).collect()
    };
    let outputs = having(&["output"]);
    let write = |xml: &mut Xml, element: &str, known: &[&str]| -> io::Result<()> {
        let (name, known) = (
            if fmi == Fmi::V2 {
                "index"
            } else {
                "valueReference"
            },
            having(known).join(" "),
        );
        for output in &outputs {
            let attributes = [(name, output.as_str()), ("dependencies", known.as_str())];
            xml.create_element(element)
                .with_attributes(attributes)
                .write_empty()?;
        }
        Ok(())
    };
    let at_start = ["input", "parameter"];
    match fmi {
        Fmi::V2 => {
            xml.create_element("Outputs")
                .write_inner_content(|xml| write(xml, "Unknown", &["input"]))?;
            xml.create_element("InitialUnknowns")
                .write_inner_content(|xml| write(xml, "Unknown", &at_start))?;
            Ok(())
        }
        Fmi::V3 => {
            write(xml, "Output", &["input"])?;
            write(xml, "InitialUnknown", &at_start)
        }
    }
}
