//! `hysteron simulate` and `hysteron invert`: tables in, tables out, row by row.

use crate::terminal::{Result, print, say};
use crate::{args, model, progress, recording};
use hysteron::{Around, Counts, Invert, Policy, TableReader, TableWriter};
use serde_json::json;
use std::path::Path;

pub(crate) fn simulate(args: &args::Simulate) -> Result<()> {
    let (model, load) = args.load.apply(model::read(&args.model, &args.data)?)?;
    let band = match args.band {
        false => None,
        true => Some(model.band()?.ok_or_else(|| {
            let model = args.model.display();
            format!("{model}: the model has no 95 % band: fit it again with --bootstrap 200")
        })?),
    };
    let what = ["inputs above the plane", "inputs below the active range"];
    through(
        [&args.data, &args.model],
        args.out.as_deref(),
        &args.force,
        (args.json.json, args.repair.max_memory()),
        what,
        |table, out, progress| {
            let what = hysteron::Simulate {
                input: args.input.as_deref().unwrap_or(&model.input.name),
                around: Around {
                    time: args.time.as_deref(),
                    load: load.as_deref(),
                    repair: args.repair.what(),
                },
                rest: args.rest,
                band: band.as_ref(),
            };
            let state = args.start.state(&model);
            hysteron::simulate_table(&model, state, table, what, out, progress)
        },
    )
}

/// Rows to look ahead, unless others are asked for.
const LOOK_AHEAD: usize = 65_536;

pub(crate) fn invert(args: &args::Invert) -> Result<()> {
    let (model, load) = args.load.apply(model::read(&args.model, &args.data)?)?;
    model::say_if_poor(&model);
    let (policy, tolerance) = match args.policy {
        args::Policy::Hold => (Policy::Hold, 0.0),
        args::Policy::Anticipate => (Policy::Anticipate, model.usual_tolerance()),
    };
    if args.look_ahead.is_some() && policy == Policy::Hold {
        return Err("--look-ahead needs --policy anticipate: `hold` looks at no later row".into());
    }
    let how = Invert {
        target: args.target.as_deref().unwrap_or(&model.output.name),
        policy,
        tolerance: args.tolerance.unwrap_or(tolerance),
        look_ahead: args.look_ahead.unwrap_or(LOOK_AHEAD),
        around: Around {
            time: args.time.as_deref(),
            load: load.as_deref(),
            repair: args.repair.what(),
        },
        drive_range: args.drive_range,
        horizon: args.horizon,
        preview: args.preview,
    };
    let state = args.start.state(&model);
    let what = [
        "targets above the model's range",
        "targets below the model's range",
    ];
    through(
        [&args.data, &args.model],
        args.out.as_deref(),
        &args.force,
        (args.json.json, args.repair.max_memory()),
        what,
        |table, out, progress| {
            let counts = hysteron::invert_table(&model, state, table, how, out, progress)?;
            if counts.samples > 0 && counts.half_width.is_none() {
                say(format_args!(
                    "the model has neither a 95 % band nor an error on data that were not fitted, so \
                     there are no columns output_low and output_high: fit it with --bootstrap 200 \
                     or --hold-out branches:20%"
                ));
            }
            Ok(counts)
        },
    )
}

/// What is told how many bytes were read.
type Told<'a> = &'a dyn Fn(u64);

/// Opens reader and writer, runs `work` between them and reports the counts.
fn through(
    [data, model]: [&Path; 2],
    out: Option<&Path>,
    force: &args::Force,
    (json, max_memory): (bool, u64),
    what: [&str; 2],
    work: impl FnOnce(&mut TableReader, Option<TableWriter>, Told<'_>) -> hysteron::Result<Counts>,
) -> Result<()> {
    let inputs = [data, model];
    // With --json, standard output is for the JSON alone.
    let writer = match (out, json) {
        (None, true) => None,
        (path, _) => Some(TableWriter::create(
            path.map(|path| force.target(path, &inputs)),
        )?),
    };
    let mut table = TableReader::open_with(data, max_memory)?;
    if let Some(name) = out.filter(|out| table.header().iter().any(|name| *out == Path::new(name)))
    {
        let (name, data) = (name.display(), data.display());
        return Err(format!(
            "`{name}` is a column of {data}, and -o, --output names the file that is written: \
             ./{name} would be a file"
        )
        .into());
    }
    let bar = progress::bytes_of(data);
    let counts = work(&mut table, writer, &|bytes| bar.set_position(bytes))?;
    bar.finish_and_clear();
    recording::tell_of_table(data, &table);
    for (count, what) in [counts.high, counts.low].into_iter().zip(what) {
        if count > 0 {
            say(format_args!("{count} of {} {what}", counts.samples));
        }
    }
    if counts.anew > 0 {
        say(format_args!(
            "{} recordings of one experiment: the clock goes back, and the model begins anew",
            counts.anew + 1
        ));
    }
    if counts.passed > 0 {
        say(format_args!(
            "{} of {} targets lie inside a jump of the relay model: the output passes them",
            counts.passed, counts.samples
        ));
    }
    if counts.limited > 0 {
        say(format_args!(
            "{} of {} targets cannot be reached in their row: the range of the drive, or a stage that \
             needs time, allows no more",
            counts.limited, counts.samples
        ));
    }
    if json {
        let object = json!({
            "samples": counts.samples,
            "high": counts.high,
            "low": counts.low,
            "passed": counts.passed,
            "limited": counts.limited,
            "half_width": counts.half_width,
            "anew": counts.anew,
            "table": out,
        });
        print(&object.to_string())?;
    }
    Ok(())
}
