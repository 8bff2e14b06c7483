//! `hysteron fleet`

use crate::made::Typed;
use crate::terminal::{Result, print, say};
use crate::{args, fit, prepare, progress, remedy, text};
use hysteron::{
    Columns, FleetOptions, FleetRow, Model, Norm, Progress, Strangeness, fit_fleet, read_fleet,
};
use hysteron_files::AtomicFolder;
use hysteron_report::{Report, Shown};
use serde_json::json;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &args::Fleet) -> Result<()> {
    match args {
        args::Fleet::Fit(args) => fit_all(args),
        args::Fleet::Extract(args) => extract(args),
        args::Fleet::Join(args) => join(args),
        args::Fleet::Check(args) => check(args),
        args::Fleet::Report(args) => report(args),
    }
}

fn fit_all(args: &args::FleetFit) -> Result<()> {
    let how = &args.how;
    let (Some(input), Some(output)) = (&how.columns.input, &how.columns.output) else {
        return Err("the columns of a fleet are named: give --input and --output".into());
    };
    let columns = Columns {
        time: how.columns.time.as_deref(),
        load: how.quantities.load.as_deref(),
        ..Columns::new(input, output)
    };
    let hold_out = match &how.tests.hold_out[..] {
        [] => None,
        [args::HoldOut::Part(part)] => Some(part.clone()),
        _ => {
            let what = "--hold-out: of a fleet, one part of each recording can be held out";
            return Err(what.into());
        }
    };
    let options = FleetOptions {
        by: args.by.as_deref(),
        read: (&how.repair).into(),
        prepare: Some(prepare::steps_of(&how.prepare)),
        hold_out,
        choice: args.choice.into(),
        input_unit: how.quantities.input_unit.clone(),
        output_unit: how.quantities.output_unit.clone(),
        ..FleetOptions::new(columns, fit::fit_of(how)?)
    };
    let inputs: Vec<&Path> = args.data.iter().map(PathBuf::as_path).collect();
    let target = args.force.target(&args.out, &inputs);
    let bar = progress::share();
    let report = |what: &'static str, done: f64| {
        progress::stage(&bar, what, done);
        Ok(())
    };
    let found = fit_fleet(&args.data, &options, target, Progress::new(&report));
    bar.finish_and_clear();
    let found = found?;
    for note in &found.notes {
        say(format_args!("{note}"));
    }
    if let Some(shared) = &found.shared {
        say(format_args!("{shared}"));
    }
    for alone in &found.alone {
        say(format_args!("{alone}"));
    }
    let failed = found.failed.iter();
    let failed: Vec<_> = failed.map(|f| (&f.id, remedy::text_of(&f.error))).collect();
    for (id, reason) in &failed {
        say(format_args!("{id}: {reason}"));
    }
    match args.json.json {
        true => {
            let failed = failed.iter();
            let failed = failed.map(|(id, reason)| json!({"id": id, "reason": reason}));
            let object = json!({
                "models": args.out,
                "fitted": found.fitted,
                "resumed": found.resumed,
                "with_warnings": found.with_warnings,
                "failed": failed.collect::<Vec<_>>(),
                "notes": found.notes,
                "choice": found.shared,
                "alone": found.alone,
            });
            print(&object.to_string())?;
        }
        false if found.fitted > 0 => print(&summary(args, &found))?,
        false => {}
    }
    match found.failed.len() {
        0 => Ok(()),
        failed => Err(format!("{failed} of {} have no model", found.fitted + failed).into()),
    }
}

fn summary(args: &args::FleetFit, found: &hysteron::FleetFitted) -> String {
    let optional = |count: usize, words: &str| match count {
        0 => String::new(),
        count => format!(", {count} {words}"),
    };
    format!(
        "{}: {} actuators{}{}{}",
        args.out.display(),
        found.fitted,
        optional(found.resumed, "of an earlier run that was ended"),
        optional(found.with_warnings, "with warnings, which are in the table"),
        optional(found.alone.len(), "with choices of their own"),
    )
}

fn extract(args: &args::FleetExtract) -> Result<()> {
    let inputs = [args.models.as_path()];
    let file = Model::file(args.force.target(&args.out, &inputs))?;
    let mut found = None;
    read_fleet(&args.models, |row| {
        if row.id == args.id {
            found = Some(row.model);
        }
        Ok(found.is_none())
    })?;
    let model = found.ok_or_else(|| {
        let (models, id) = (args.models.display(), &args.id);
        format!("{models}: there is no actuator `{id}`")
    })?;
    Ok(file.commit_with(model.to_json().as_bytes())?)
}

fn join(args: &args::FleetJoin) -> Result<()> {
    let inputs: Vec<&Path> = args.parts.iter().map(PathBuf::as_path).collect();
    let target = args.force.target(&args.out, &inputs);
    let count = hysteron::join_fleets(&args.parts, target)?;
    print(&format!("{}: {count} actuators", args.out.display()))
}

fn check(args: &args::FleetCheck) -> Result<()> {
    let fleet = rows(&args.models)?;
    let norm = Norm::from_rows(&fleet)?;
    let mut found = Vec::new();
    for new in &args.new {
        let is_model = new
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let rows = match is_model {
            true => vec![FleetRow::of_model(
                &new.display().to_string(),
                Model::read(new)?,
            )],
            false => rows(new)?,
        };
        found.extend(rows.into_iter().map(|row| (norm.strangeness(&row), row.id)));
    }
    match args.json.json {
        true => {
            let each = found.iter().map(|(strange, id)| to_json(id, strange));
            print(&json!({"actuators": each.collect::<Vec<_>>()}).to_string())
        }
        false => print(&table(&found)),
    }
}

fn report(args: &args::FleetReport) -> Result<()> {
    let inputs = [args.models.as_path()];
    let mut folder = AtomicFolder::create(args.force.target(&args.out, &inputs), None)?;
    folder.claim(["index.html"])?;
    let rows = rows(&args.models)?;
    let typed = Typed::now()?;
    let report = Report {
        title: &format!("The fleet {}", args.models.display()),
        shown: Shown::Fleet {
            rows: &rows,
            norm: &Norm::from_rows(&rows)?,
        },
        made: typed.made(),
    };
    let written = report.write_into(&mut folder, Path::new(""))?;
    folder.commit()?;
    print(&written[0].display().to_string())
}

fn rows(path: &Path) -> Result<Vec<FleetRow>> {
    let mut rows = Vec::new();
    read_fleet(path, |row| {
        rows.push(row);
        Ok(true)
    })?;
    Ok(rows)
}

fn to_json(id: &str, strange: &Strangeness) -> serde_json::Value {
    let deviations = strange.deviations.iter();
    let deviations = deviations.map(|(name, by)| ((*name).to_owned(), json!(by)));
    json!({
        "id": id,
        "distance": strange.distance,
        "limit": strange.limit,
        "alike": !strange.is_outlier(),
        "deviations": deviations.collect::<serde_json::Map<_, _>>(),
    })
}

/// From so many deviations on a number is unusual by itself.
const ALONE: f64 = 3.0;

fn table(found: &[(Strangeness, String)]) -> String {
    let mut lines = vec![text::row(["actuator", "distance", "limit", ""])];
    for (strange, id) in found {
        let (name, by) = strange.most();
        let verdict = match strange.is_outlier() {
            true if by.abs() < ALONE => "unlike the others: the numbers together".into(),
            true => format!("unlike the others: {name} by {by:+.1} deviations"),
            false => "like the others".into(),
        };
        lines.push(vec![
            id.clone(),
            format!("{:.2}", strange.distance),
            format!("{:.2}", strange.limit),
            verdict,
        ]);
    }
    text::table(&lines)
}
