//! `hysteron adapt`

use crate::columns::{Given, Named};
use crate::terminal::{Result, print};
use crate::{args, model, recording, text};
use hysteron::{
    Adapted, Channel, Compared, Drift, Errors, EstimatorOptions, Model, ShiftFound, Start, Stuck,
    TableWriter,
};
use serde_json::{Value, json};
use std::ops::Range;

/// A recording that covers less of the model's range is said to.
const HALF: f64 = 0.5;

pub(crate) fn run(args: &args::Adapt) -> Result<()> {
    if let Some(table) = &args.table {
        hysteron_files::refuse_one_file(&args.out, table)?;
        if args.json.json && table.as_os_str() == "-" {
            return Err(
                "with --json standard output has the JSON object only: name a file for --table"
                    .into(),
            );
        }
    }
    let model = model::read(&args.model, &args.data)?;
    // The model is begun before the table and completed after it: if one of them cannot be written,
    // neither appears.
    let inputs = [args.model.as_path(), &args.data];
    let file = Model::file(args.force.target(&args.out, &inputs))?;
    let table = args.table.as_ref().map(|table| {
        let target = args.force.target(table, &inputs);
        TableWriter::create(Some(target))
    });
    let table = table.transpose()?;
    let given = Given::of(&args.columns, None);
    let named = Named::of(&args.data, &given, &args.repair)?;
    let columns = named.columns();
    let recordings = recording::segments(&args.data, columns, &args.repair)?;
    let mut adapted = hysteron::adapt(
        &model,
        &recordings,
        &args.options()?,
        hysteron::Progress::NONE,
    )?;
    if let Some(adapted) = adapted
        .model
        .fit
        .as_mut()
        .and_then(|fit| fit.other.get_mut("adapted"))
    {
        adapted["from"]["model"] = json!(args.model);
    }
    if let Some(table) = table {
        adapted.write_table(&recordings, table)?;
    }
    let faults = faults(args, &adapted);
    let refused = !faults.is_empty() && !args.force.force;
    if !refused {
        file.commit_with(adapted.model.to_json().as_bytes())?;
    }
    match args.json.json {
        true => print(&to_json(args, &adapted, refused).to_string())?,
        false => print(&to_text(args, &adapted, &model, (refused, &faults)))?,
    }
    match refused {
        true => Err(format!(
            "{}: the model is not written: {}; --force writes it",
            args.out.display(),
            faults.join("; ")
        )
        .into()),
        false => Ok(()),
    }
}

/// Why the model should not replace the one that it was.
fn faults(args: &args::Adapt, adapted: &Adapted) -> Vec<String> {
    let frozen = |stuck| frozen(args, stuck);
    let mut faults: Vec<String> = adapted.stuck.iter().map(frozen).collect();
    faults.extend(adapted.cut_off.map(|end| {
        let output = &adapted.model.output;
        format!(
            "{} came to {} {} times and stayed there for {} readings while the input went on, \
             and the model goes further: its sensor may end there, and the model has learned that end",
            output.name,
            output.text(end.value),
            end.times,
            end.samples
        )
    }));
    let far = 100.0 * adapted.drift.largest();
    if far > args.max_drift {
        faults.push(format!(
            "it moved by {far:.0} %, more than the {} % that --max-drift allows: {}",
            args.max_drift,
            drift(adapted)
        ));
    }
    if adapted.worse {
        faults.push(worse(adapted));
    }
    faults
}

fn frozen(args: &args::Adapt, stuck: &Stuck) -> String {
    let (still, moves) = match stuck.channel {
        Channel::Output => ("output", "input"),
        Channel::Input => ("input", "output"),
    };
    let Range { start, end } = &stuck.samples;
    format!(
        "the {still} stands still from row {} of {} on, up to row {end}, while the {moves} moves: a \
         frozen or dead sensor; nothing is learned from these rows",
        start + 1,
        args.data.display()
    )
}

/// How far the model moved, in percent.
fn drift(adapted: &Adapted) -> String {
    let Drift {
        lift, gain, shift, ..
    } = adapted.drift;
    format!(
        "offset by {:.1} % of the range, stroke by {:.1} %, operators by {:.1} % of the plane",
        100.0 * lift,
        100.0 * gain,
        100.0 * shift
    )
}

fn worse(adapted: &Adapted) -> String {
    let error = |errors: Errors| adapted.model.output.text(errors.rmse);
    let found = match (adapted.late, adapted.again_late) {
        (Some(late), Some(again)) => format!(
            "over the last third it erred by {} (RMSE) before it learned, and errs by {} as it is in \
             the end, the model left alone by {}, a constant by {}",
            error(late.adapting),
            error(again.adapting),
            error(late.fixed),
            adapted.model.output.text(adapted.late_spread)
        ),
        _ => "no reading of the last third can be compared".into(),
    };
    let first = adapted.again_first.map_or(String::new(), |first| {
        format!(
            "; over the first third it errs by {} as it is in the end, the model left alone by {}",
            error(first.adapting),
            error(first.fixed)
        )
    });
    format!(
        "it ended no better: {found}{first}: see the column `outcome` of --table, try another \
         --method, or keep the model as it is"
    )
}

fn to_json(args: &args::Adapt, adapted: &Adapted, refused: bool) -> Value {
    json!({
        "model": (!refused).then_some(&args.out),
        "table": args.table,
        "whole": adapted.whole,
        "thirds": adapted.thirds,
        "late": adapted.late,
        "worse": adapted.worse,
        "stuck": adapted.stuck,
        "cut_off": adapted.cut_off,
        "start": adapted.start,
        "covered": adapted.covered,
        "probation": adapted.probation,
        "again": adapted.again,
        "again_late": adapted.again_late,
        "again_first": adapted.again_first,
        "late_spread": adapted.late_spread,
        "counts": adapted.counts,
        "session": adapted.session,
        "one_load": adapted.one_load,
        "shares": adapted.shares.iter().copied().collect::<std::collections::BTreeMap<_, _>>(),
        "drift": adapted.drift,
        "shift": adapted.shift.as_ref().map(|found| json!({
            "shift": found.shift,
            "deviation": found.deviation,
            "load": found.load,
            "from": found.from,
        })),
        "fit": adapted.model.fit,
    })
}

/// The shift at the end, and the load that it tells.
fn shift(found: &ShiftFound, model: &Model) -> String {
    let mut line = format!(
        "shift of the axis at the end {}, give or take {}",
        model.input.text(found.shift),
        text::number(found.deviation)
    );
    if let (Some(load), Some(from), Some(dependence)) = (found.load, found.from, &model.load) {
        let (low, high) = dependence.range();
        line += &format!(
            " from that at {}: the load is then {} {}",
            dependence.quantity.text(from),
            match load {
                load if load <= low => "at most",
                load if load >= high => "at least",
                _ => "about",
            },
            dependence.quantity.text(load)
        );
    }
    line
}

fn to_text(
    args: &args::Adapt,
    adapted: &Adapted,
    model: &Model,
    (refused, faults): (bool, &[String]),
) -> String {
    let output = &adapted.model.output;
    let mut rows = vec![text::row(["RMSE", "adapting", "fixed", "samples"])];
    let mut line = |name: &str, compared: &Compared| {
        let Compared { adapting, fixed } = compared;
        rows.push(vec![
            name.to_owned(),
            output.text(adapting.rmse),
            output.text(fixed.rmse),
            adapting.samples.to_string(),
        ]);
    };
    line("each sample before it was learned from", &adapted.whole);
    for (name, third) in ["  first third", "  second", "  last"]
        .iter()
        .zip(&adapted.thirds)
    {
        line(name, third);
    }
    let again = Compared {
        adapting: adapted.again,
        fixed: adapted.whole.fixed,
    };
    line("last weights, over all of it again", &again);
    let counts = &adapted.counts;
    let moved = &adapted.drift;
    let learning = match adapted.options {
        EstimatorOptions::Refit(refit) => format!(
            "{} refits on the way and one at the end, over {}; {} samples taken, {} at rest, {} \
             readings rejected",
            counts.learned,
            refit.window,
            counts.learned + counts.waiting,
            counts.at_rest,
            counts.rejected
        ),
        EstimatorOptions::Fixed => "nothing learns".into(),
        EstimatorOptions::Auto(_) | EstimatorOptions::Weights(_) | EstimatorOptions::Shift(_) => {
            format!(
                "learned from {} samples, {} within the dead zone or unfinished, {} at rest, {} \
             readings rejected, {} times rolled back",
                counts.learned, counts.waiting, counts.at_rest, counts.rejected, counts.rolled_back
            )
        }
    };
    let target = match refused {
        true => "not written".into(),
        false => args.out.display().to_string(),
    };
    let mut lines = vec![format!("{target}: {learning}"), text::table(&rows)];
    if !adapted.shares.is_empty() {
        let share = |(name, share): &(_, f64)| format!("{name} {:.0} %", 100.0 * share);
        let shares: Vec<String> = adapted.shares.iter().map(share).collect();
        lines.push(format!("the model is a mean of {}", shares.join(", ")));
    }
    if adapted.session {
        let numbers = match adapted.drift.shift == 0.0 {
            true => "offset and gain",
            false => "offset, gain and shift",
        };
        lines.push(format!(
            "the input made one loop at most: the model is no mean of learners, but the one before \
             with another {numbers}, as of another session"
        ));
    }
    if let (true, Some(dependence)) = (adapted.one_load, &model.load) {
        let (low, high) = dependence.range();
        lines.push(format!(
            "the model before was for loads from {} to {}; this one is for the load of the \
             recording alone",
            dependence.quantity.text(low),
            dependence.quantity.text(high)
        ));
    }
    if let Some(found) = &adapted.shift {
        lines.push(shift(found, model));
    } else {
        lines.push(format!(
            "sum of the weights {} before, {} after; offset {}, {}; weights moved by {:.1} % of \
             their sum",
            text::number(moved.weights.0),
            output.text(moved.weights.1),
            text::number(moved.offset.0),
            output.text(moved.offset.1),
            100.0 * moved.moved
        ));
    }
    lines.push(format!("the model moved: {}", drift(adapted)));
    // Where they do not refuse the model, they are told all the same.
    lines.extend(faults.iter().filter(|_| !refused).cloned());
    let start = adapted.start;
    if start != Start::Fitted && !(start == Start::Off && model.fitted().is_none()) {
        let from = start.words();
        lines.push(format!(
            "the recording begins {from}: what that explains was not learned"
        ));
    }
    if adapted.covered < HALF {
        lines.push(format!(
            "the input covered {:.0} % of the model's range: what the model does beyond is a guess, \
             and a stroke over the whole range would tell",
            100.0 * adapted.covered
        ));
    }
    if adapted.probation > 0 {
        lines.push(format!(
            "the last {} samples are not in the model: no later samples confirm them",
            adapted.probation
        ));
    }
    if counts.outside > 0 {
        lines.push(format!("{} inputs outside the plane", counts.outside));
    }
    let shifted = adapted
        .shift
        .as_ref()
        .is_some_and(|found| found.shift != 0.0);
    if moved.moved == 0.0 && moved.offset.0 == moved.offset.1 && !shifted {
        lines.push("nothing was learned: the model is unchanged".into());
    }
    lines.join("\n")
}
