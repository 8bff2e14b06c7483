//! `hysteron evaluate`

use crate::columns::{Given, Named};
use crate::made::Typed;
use crate::terminal::{Result, print, say};
use crate::{args, model, prepare, recording, text};
use hysteron::{Errors, Evaluation, Grade, InverseRun, Quantity, Recording, Verdict};
use hysteron_files::AtomicFolder;
use hysteron_report::{Report, Shown};
use serde_json::{Value, json};
use std::path::Path;

pub(crate) fn run(args: &args::Evaluate) -> Result<()> {
    let inputs = [args.model.as_path(), &args.data];
    let folder = args.report.as_ref().map(|report| {
        let folder = AtomicFolder::create(args.force.target(report, &inputs), None)?;
        folder.claim(["index.html"])?;
        Ok::<_, hysteron::Error>(folder)
    });
    let folder = folder.transpose()?;
    let (model, load) = args.load.apply(model::read(&args.model, &args.data)?)?;
    let given = Given::of(&args.columns, load.as_deref());
    let named = Named::of(&args.data, &given, &args.repair)?;
    let columns = named.columns();
    let recordings = recording::segments(&args.data, columns, &args.repair)?;
    let recordings = prepare::each_asked_for(recordings, &args.prepare)?;
    let start = args.start.into();
    let evaluation = match folder {
        Some(_) => hysteron::evaluate_from(&model, &recordings, start)?,
        // The verdict needs the output as well, but no other series.
        None => Evaluation {
            output_model: hysteron::forward(&model, &recordings, start)?.output_model,
            ..hysteron::evaluate_errors(&model, &recordings, start)?
        },
    };
    let mut verdict = Verdict::of_evaluation(&model, &recordings, &evaluation)?;
    // An error may be one of the rows. They are not looked at for nothing.
    if verdict.grade != Grade::Good && !args.prepare.prepare {
        let count = recordings.len();
        let each = recordings.iter().enumerate();
        let doubts = each.map(|(n, one)| prepare::doubts_said(one, &recording::which(n, count)));
        verdict = verdict.doubting(doubts.sum::<Result<usize>>()?);
    }
    if let Some(mut folder) = folder {
        let title = format!("{} on {}", args.model.display(), args.data.display());
        let typed = Typed::now()?;
        let report = Report {
            title: &title,
            shown: Shown::Evaluation {
                model: &model,
                recordings: &recordings,
                evaluation: &evaluation,
                verdict: Some(&verdict),
            },
            made: typed.made(),
        };
        let paths = report.write_into(&mut folder, Path::new(""))?;
        folder.commit()?;
        say(format_args!("the report is {}", paths[0].display()));
    }
    if args.json.json {
        let mut object = to_json(&evaluation);
        object["verdict"] = json!(verdict);
        object["segments"] = json!(recordings.len());
        object["was_fitted"] = json!(evaluation.was_fitted);
        object["seen_for_band"] = json!(evaluation.seen_for_band);
        return print(&object.to_string());
    }
    let mut result = to_text(&evaluation, &recordings);
    if evaluation.was_fitted {
        result += "\nthis is a recording that the model was fitted to: the errors say how well it \
                   fits, not how well it predicts";
    } else if evaluation.seen_for_band {
        result += "\nthe band was widened to this recording: what it holds here says nothing of \
                   other sessions";
    }
    print(&format!("{result}\n\n{}", text::verdict(&verdict)))
}

/// The JSON of an evaluation: `forward` and `inverse` with the same four measures each.
pub(crate) fn to_json(evaluation: &Evaluation) -> Value {
    let mut object = json!({"forward": evaluation.forward, "clipped": evaluation.clipped});
    if let Some(samples) = evaluation.estimated_from {
        object["start_estimated_from"] = json!(samples);
    }
    if evaluation.rests.iter().any(Option::is_some) {
        object["rests"] = json!(evaluation.rests);
    }
    if let Some(band) = &evaluation.band {
        object["band_coverage_percent"] = json!(band.coverage_percent);
    }
    match &evaluation.inverse {
        Ok(inverse) => {
            let parts = |run: &InverseRun| {
                json!({
                    "all": run.all,
                    "moving": run.moving,
                    "dead_band": run.dead_band,
                    "out_of_reach": run.out_of_reach,
                })
            };
            object["inverse"] = json!(inverse.hold.all);
            object["inverse_hold"] = parts(&inverse.hold);
            object["inverse_anticipate"] = parts(&inverse.anticipate);
        }
        Err(reason) => {
            object["inverse"] = Value::Null;
            object["inverse_refused"] = json!(reason);
        }
    }
    object
}

fn to_text(evaluation: &Evaluation, recordings: &[Recording]) -> String {
    let (input, output) = (
        &recordings[0].input_quantity,
        &recordings[0].output_quantity,
    );
    let mut rows = vec![text::row(["", "RMSE", "largest", "% of range", "samples"])];
    let mut line = |name: &str, errors: Option<&Errors>, quantity: &Quantity| {
        if let Some(errors) = errors {
            rows.push(text::errors(name, errors, quantity));
        }
    };
    line("forward", Some(&evaluation.forward), output);
    if let Ok(inverse) = &evaluation.inverse {
        for (name, run) in [("hold", &inverse.hold), ("anticipate", &inverse.anticipate)] {
            line(&format!("inverse, {name}"), Some(&run.all), input);
            line("  while the output moves", run.moving.as_ref(), input);
            line("  in the dead band", run.dead_band.as_ref(), input);
        }
    }
    let mut result = text::table(&rows);
    if let Some(band) = &evaluation.band {
        result += &format!(
            "\n{:.1} % of the samples inside the {}",
            band.coverage_percent,
            band.name()
        );
    }
    if let Some(samples) = evaluation.estimated_from {
        let of = if recordings.len() > 1 {
            " of the recordings"
        } else {
            ""
        };
        result += &format!("\nthe start was estimated from the first {samples} samples{of}");
    }
    let rested = hysteron::rested_words(&evaluation.rests, &recordings[0].input_quantity);
    result.extend(rested.map(|words| format!("\n{words}")));
    if let Err(reason) = &evaluation.inverse {
        result += &format!("\nno inverse: {reason}");
    }
    let samples = evaluation.forward.samples;
    match evaluation.clipped {
        0 => result,
        // These errors are about inputs that the model does not know.
        clipped if 5 * clipped > samples => format!(
            "{clipped} of {samples} inputs are outside the plane: the model was not made for this \
             recording, and the errors say little\n{result}"
        ),
        clipped => {
            let inputs = hysteron::counted(clipped, "input");
            format!("{result}\n{inputs} outside the plane")
        }
    }
}
