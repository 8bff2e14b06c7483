//! `hysteron design`

use crate::terminal::{Result, print};
use crate::{args, text};
use hysteron::{
    Design, DesignOptions, Excitation, Model, Quantity, Rates, TableReader, TableWriter,
};
use hysteron_files::{AtomicFile, Own};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &args::Design) -> Result<()> {
    if let Some(figure) = &args.figure {
        hysteron_files::refuse_one_file(&args.out, figure)?;
    }
    let to_stdout = args.out == Path::new("-");
    if to_stdout && args.json.json {
        return Err(
            "with --json standard output has the JSON object only: name a file with -o".into(),
        );
    }
    let inputs: Vec<&Path> = args.from.iter().map(PathBuf::as_path).collect();
    let table = TableWriter::plain(Some(args.force.target(&args.out, &inputs)))?;
    let figure = args.figure.as_ref().map(|figure| {
        let target = args.force.target(figure, &inputs);
        AtomicFile::create(target, Own::SAME_BYTES)
    });
    let figure = figure.transpose()?;
    let rates = args.heating_rate.zip(args.cooling_rate);
    let rates = rates.map(|(heating, cooling)| Rates { heating, cooling });
    let budget_s = args.budget.map(|minutes| 60.0 * minutes);
    let column = args.input.as_deref().unwrap_or("input");
    let design = match (&args.model, args.range, rates) {
        (Some(model), range, rates) => {
            let model = Model::read(model)?;
            let limits = (budget_s, args.step);
            hysteron::design_heated(&model, range, args.levels, rates, limits)?
        }
        (None, Some(range), Some(rates)) => {
            let options = DesignOptions {
                operator: args.operator.into(),
                budget_s,
                step_s: args.step,
                ..DesignOptions::within(range, args.levels, rates)?
            };
            let recorded = args.from.iter();
            let recorded = recorded.map(|path| input_of(path, column, args.memory.limit()));
            let recorded: Vec<Vec<f64>> = recorded.collect::<Result<_>>()?;
            let inputs: Vec<&[f64]> = recorded.iter().map(Vec::as_slice).collect();
            hysteron::design(&options, &inputs)?
        }
        _ => return Err("name a range and both rates, or a model".into()),
    };
    let profile = (!design.legs.is_empty()).then_some(&args.out);
    if profile.is_some() {
        design.write_to(table)?;
    }
    if let Some(file) = figure {
        let quantity = Quantity::from_column(column);
        let svg = hysteron_report::excitation_map(&design.plane, &design.excitation, &quantity);
        file.commit_with(svg.as_bytes())?;
    }
    if args.json.json {
        return print(&to_json(&design, profile.map(|path| path.as_path())).to_string());
    }
    let summary = summary(&design, args);
    if to_stdout {
        eprintln!("{}", hysteron_files::printable(&summary));
        return Ok(());
    }
    print(&summary)
}

fn input_of(path: &Path, column: &str, max_memory: u64) -> Result<Vec<f64>> {
    let mut table = TableReader::open_with(path, max_memory)?;
    let column = table.column(column)?;
    let mut input = Vec::new();
    while table.advance()? {
        input.push(table.number(column)?);
    }
    if input.is_empty() {
        return Err(table
            .fault(None, "there are no rows below the header".into())
            .into());
    }
    Ok(input)
}

fn counts(classes: &[Excitation]) -> [(Excitation, usize); 4] {
    Excitation::ALL.map(|class| (class, classes.iter().filter(|c| **c == class).count()))
}

fn to_json(design: &Design, profile: Option<&Path>) -> Value {
    let excitation = |classes: &Vec<Excitation>| {
        let mut object = serde_json::Map::new();
        for (class, count) in counts(classes) {
            object.insert(
                json!(class).as_str().unwrap_or_default().to_owned(),
                json!(count),
            );
        }
        Value::Object(object)
    };
    let legs: Vec<Value> = design
        .legs
        .iter()
        .map(|leg| json!({"from": leg.from, "to": leg.to, "new_corners": leg.new_corners}))
        .collect();
    json!({
        "profile": profile,
        "samples": design.time.len(),
        "duration_s": design.duration_s(),
        "full_duration_s": design.full_duration_s,
        "plane": {
            "min": design.plane.min(),
            "max": design.plane.max(),
            "levels": design.plane.levels(),
        },
        "operators": design.plane.operators(),
        "excitation": excitation(&design.excitation),
        "recorded": design.recorded.as_ref().map(excitation),
        "corners": design.corners,
        "classes": design.excitation,
        "branches": legs,
    })
}

fn summary(design: &Design, args: &args::Design) -> String {
    let count = design.plane.operators();
    let minutes = |seconds: f64| format!("{} min", text::number(seconds / 60.0));
    let mut lines = Vec::new();
    if let Some(recorded) = &design.recorded {
        lines.push(format!("recorded so far: {}", classes(recorded)));
    }
    if design.legs.is_empty() {
        lines.push(format!(
            "nothing is missing: the recordings determine all {count} operators, and no profile \
             was written"
        ));
        return lines.join("\n");
    }
    lines.push(format!(
        "{}: {}, {} branches, {} samples",
        args.out.display(),
        minutes(design.duration_s()),
        design.legs.len(),
        design.time.len()
    ));
    lines.push(format!("with it: {}", classes(&design.excitation)));
    lines.push(format!(
        "{} of {count} corners of the plane are covered ({:.0} %)",
        design.corners,
        100.0 * design.corners as f64 / count as f64
    ));
    if design.corners < count {
        lines.push(format!(
            "all operators would take {}",
            minutes(design.full_duration_s)
        ));
    }
    if design.recorded.is_some() {
        lines.push(format!(
            "measure next, from {} or below with every operator off:",
            text::number(design.legs[0].from)
        ));
        for leg in &design.legs {
            let way = if leg.to > leg.from { "rise" } else { "fall" };
            lines.push(format!(
                "  {way} from {} to {}{}",
                text::number(leg.from),
                text::number(leg.to),
                match leg.new_corners {
                    0 => "  (nothing new, leads on)",
                    _ => "",
                }
            ));
        }
    }
    lines.join("\n")
}

/// How many operators each class has.
fn classes(classes: &[Excitation]) -> String {
    let some = counts(classes).into_iter().filter(|(_, count)| *count > 0);
    let words: Vec<String> = some
        .map(|(class, count)| format!("{count} {}", class.words()))
        .collect();
    words.join(", ")
}
