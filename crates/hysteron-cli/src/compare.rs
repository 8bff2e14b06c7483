//! `hysteron compare`

use crate::columns::{Given, Named};
use crate::made::Typed;
use crate::terminal::{Result, print, say};
use crate::{args, prepare, recording, remedy, text};
use hysteron::{Forward, Model, Recording, Verdict, one_after_the_other};
use hysteron_files::AtomicFolder;
use hysteron_report::{NamedForward, Report, Shown};
use serde_json::json;
use std::path::{Path, PathBuf};

/// The models' errors on one recording.
struct Compared<'a> {
    data: &'a Path,
    recordings: Vec<Recording>,
    /// One for each model.
    runs: Vec<Forward>,
    /// One for each model.
    verdicts: Vec<Verdict>,
}

pub(crate) fn run(args: &args::Compare) -> Result<()> {
    let is_model = |file: &&PathBuf| file.extension().is_some_and(|e| e == "json");
    let (files, data): (Vec<&PathBuf>, Vec<&PathBuf>) = args.files.iter().partition(is_model);
    if files.is_empty() || data.is_empty() {
        let missing = if files.is_empty() {
            "models"
        } else {
            "recordings"
        };
        return Err(format!(
            "compare needs models (*.json) and recordings: there are no {missing} among the files"
        )
        .into());
    }
    let inputs: Vec<&Path> = args.files.iter().map(PathBuf::as_path).collect();
    let folder = args.report.as_ref().map(|report| {
        let folder = AtomicFolder::create(args.force.target(report, &inputs), None)?;
        folder.claim(["index.html"])?;
        Ok::<_, hysteron::Error>(folder)
    });
    let folder = folder.transpose()?;
    let mut load = None;
    let mut models = Vec::new();
    for file in &files {
        let (model, column) = args.load.apply(Model::read(file)?)?;
        load = column;
        models.push(model);
    }
    let given = Given::of(&args.columns, load.as_deref());
    let mut compared = Vec::new();
    for data in data {
        let named = Named::of(data, &given, &args.repair)?;
        let recordings = recording::segments(data, named.columns(), &args.repair)?;
        let recordings = prepare::each_asked_for(recordings, &args.prepare)?;
        let (mut runs, mut verdicts) = (Vec::new(), Vec::new());
        for (file, model) in files.iter().zip(&models) {
            let run = hysteron::forward(model, &recordings, args.start.into());
            let named = |error| format!("{}: {}", file.display(), remedy::text_of(&error));
            let run = run.map_err(named)?;
            verdicts.push(Verdict::of_forward(model, &recordings, &run)?);
            runs.push(run);
        }
        compared.push(Compared {
            data,
            recordings,
            runs,
            verdicts,
        });
    }
    let names: Vec<String> = files
        .iter()
        .map(|file| file.display().to_string())
        .collect();
    if let Some(folder) = folder {
        let page = report(folder, &compared, &names)?;
        say(format_args!("the report is {}", page.display()));
    }
    match args.json.json {
        true => print(&to_json(&compared, &names).to_string()),
        false => print(&to_text(&compared, &names)),
    }
}

impl Compared<'_> {
    /// The models with their runs and verdicts, the one of least error first.
    fn best_first<'a>(
        &'a self,
        names: &'a [String],
    ) -> Vec<(&'a String, &'a Forward, &'a Verdict)> {
        let runs = names.iter().zip(&self.runs).zip(&self.verdicts);
        let mut runs: Vec<_> = runs
            .map(|((name, run), verdict)| (name, run, verdict))
            .collect();
        runs.sort_by(|a, b| a.1.errors.rmse.total_cmp(&b.1.errors.rmse));
        runs
    }
}

/// Writes a page for each recording; returns the first one.
fn report(mut folder: AtomicFolder, all: &[Compared<'_>], names: &[String]) -> Result<PathBuf> {
    let typed = Typed::now()?;
    let mut pages = Vec::new();
    for (n, compared) in all.iter().enumerate() {
        let models = compared.best_first(names).into_iter();
        let models: Vec<NamedForward<'_>> = models
            .map(|(name, forward, verdict)| NamedForward {
                name,
                forward,
                verdict: Some(verdict),
            })
            .collect();
        let title = format!("Models on {}", compared.data.display());
        let shown = one_after_the_other(&compared.recordings).ok_or("there is no recording")?;
        let report = Report {
            title: &title,
            shown: Shown::Models {
                recording: &shown,
                models: &models,
            },
            made: typed.made(),
        };
        // A single recording has its page at the top.
        let within = match all.len() {
            1 => PathBuf::new(),
            _ => PathBuf::from(format!("recording-{}", n + 1)),
        };
        pages.push(report.write_into(&mut folder, &within)?.remove(0));
    }
    folder.commit()?;
    Ok(pages.remove(0))
}

fn to_json(all: &[Compared<'_>], names: &[String]) -> serde_json::Value {
    let recordings = all.iter().map(|compared| {
        let runs = compared.runs.iter().zip(&compared.verdicts);
        let models = names.iter().zip(runs).map(|(name, (run, verdict))| {
            let mut object = json!(run.errors);
            object["model"] = json!(name);
            object["verdict"] = json!(verdict);
            object["was_fitted"] = json!(run.was_fitted);
            object["seen_for_band"] = json!(run.seen_for_band);
            object
        });
        json!({"recording": compared.data, "models": models.collect::<Vec<_>>()})
    });
    json!({"recordings": recordings.collect::<Vec<_>>()})
}

/// A table for each recording, the best model first, and the verdict on that one.
fn to_text(all: &[Compared<'_>], names: &[String]) -> String {
    let table = |compared: &Compared<'_>| {
        let data = compared.data.display().to_string();
        let mut rows = vec![text::row([
            &data,
            "RMSE",
            "largest",
            "% of range",
            "samples",
        ])];
        let runs = compared.best_first(names);
        let best = runs.first().map(|(name, _, verdict)| {
            format!("\n\nthe best is {name}\n{}", text::verdict(verdict))
        });
        for (name, run, _) in runs {
            let quantity = &compared.recordings[0].output_quantity;
            let mut row = text::errors(name, &run.errors, quantity);
            let seen = match (run.was_fitted, run.seen_for_band) {
                (true, _) => Some("fitted to this recording"),
                (_, true) => Some("band widened to this recording"),
                _ => None,
            };
            row.extend(seen.map(str::to_owned));
            rows.push(row);
        }
        text::table(&rows) + &best.unwrap_or_default()
    };
    all.iter().map(table).collect::<Vec<_>>().join("\n\n")
}
