//! `hysteron run`

use crate::terminal::{Result, print, say};
use crate::{args, text};
use hysteron_bench::{Config, End, Error, Options, Seen, Stop, Summary, dry_run, run as bench};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::fmt;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Ends the run that is on.
static STOP: OnceLock<Stop> = OnceLock::new();

/// How often the line on a terminal changes.
const SHOWN: Duration = Duration::from_millis(100);

/// Lets a run end, if one is on: the drive goes safe and the log is closed.
pub(crate) fn stop() -> bool {
    let on = STOP.get();
    on.inspect(|stop| stop.stop());
    on.is_some()
}

/// A run that came to no good end.
#[derive(Debug)]
pub(crate) struct Ended(End);

impl Ended {
    pub(crate) fn code(&self) -> u8 {
        self.0.code()
    }
}

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Ended {}

pub(crate) fn run(args: &args::Run) -> Result<()> {
    let options = Options {
        log: args.out.clone(),
        force: args.force.force,
        resume: args.resume,
    };
    let config = Config::load(&args.config).map_err(plain)?;
    if args.dry_run {
        let lines = dry_run(&config, &options).map_err(plain)?;
        return match args.json.json {
            true => print(&json!({ "dry_run": lines }).to_string()),
            false => print(&lines.join("\n")),
        };
    }
    let stop = STOP.get_or_init(Stop::default);
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{msg}") {
        bar.set_style(style);
    }
    let mut shown = Instant::now();
    let mut observe = |seen: &Seen<'_>| {
        if !bar.is_hidden() && shown.elapsed() >= SHOWN {
            shown = Instant::now();
            bar.set_message(line(seen));
            bar.tick();
        }
    };
    let found = bench(
        &config,
        &options,
        stop,
        &mut |text| say(format_args!("{text}")),
        &mut observe,
    );
    bar.finish_and_clear();
    let found = found.map_err(plain)?;
    let printed = match args.json.json {
        true => print(&to_json(&found).to_string()),
        false => print(&to_text(&found)),
    };
    match found.end {
        End::Done => {
            say(format_args!("{}", found.end));
            printed
        }
        end => Err(Ended(end).into()),
    }
}

/// An error of the library as the rest of the command knows it.
fn plain(error: Error) -> Box<dyn std::error::Error> {
    match error {
        Error::Hysteron(error) => error.into(),
        Error::File(error) => error.into(),
        Error::Stopped => Ended(End::Stopped).into(),
        error => error.into(),
    }
}

fn line(seen: &Seen<'_>) -> String {
    let end = seen.end_s.map_or(String::new(), |end| format!("/{end:.0}"));
    let mut parts = vec![format!("{:.1}{end} s", seen.elapsed_s)];
    if seen.reference.is_finite() {
        parts.push(format!("reference {}", text::number(seen.reference)));
    }
    parts.push(format!("output {}", text::number(seen.output)));
    if seen.reference.is_finite() {
        parts.push(format!(
            "error {}",
            text::number(seen.reference - seen.output)
        ));
    }
    parts.push(format!("drive {}", text::number(seen.drive)));
    if !seen.learner.is_empty() {
        parts.push(format!("learner {}", seen.learner));
    }
    if let Some(jitter) = seen.jitter_s {
        parts.push(format!("jitter {:.2} ms", 1e3 * jitter));
    }
    parts.join("  ")
}

fn to_json(found: &Summary) -> serde_json::Value {
    json!({
        "end": found.end.word(),
        "why": found.end.to_string(),
        "code": found.end.code(),
        "log": found.log,
        "samples": found.samples,
        "lost": found.lost,
        "old": found.old,
        "bad_lines": found.bad,
        "bad_line": found.bad_line,
        "missing": found.missing,
        "rejected": found.rejected,
        "rmse": found.rmse,
        "learned_share": found.learned,
        "jitter_s": found.jitter_s,
        "slowest_answer_s": found.slowest_s,
        "pid": found.tuned.map(|(gains, _)| gains),
        "gain_margin": found.tuned.map(|(_, margin)| margin),
    })
}

fn to_text(found: &Summary) -> String {
    let mut lines = vec![
        format!(
            "{} samples in {}; lost {}, old {}, bad lines {}",
            found.samples,
            found.log.display(),
            found.lost,
            found.old,
            found.bad
        ),
        format!("slowest answer {:.3} ms", 1e3 * found.slowest_s),
    ];
    if let Some(line) = &found.bad_line {
        lines.push(format!("the last bad line: {line:?}"));
    }
    if found.missing + found.rejected > 0 {
        lines.push(format!(
            "readings missing {}, taken for spikes {}",
            found.missing, found.rejected
        ));
    }
    if let Some(jitter) = found.jitter_s {
        lines.push(format!("jitter {:.3} ms (root mean square)", 1e3 * jitter));
    }
    if let Some((gains, margin)) = found.tuned {
        lines.push(format!(
            "PID from the model: gain {}, integral time {} s; on the model it may grow \
             {margin:.0}-fold",
            text::number(gains.gain),
            text::number(gains.integral_s)
        ));
    }
    if let Some(rmse) = found.rmse {
        let rmse = text::number(rmse);
        lines.push(format!(
            "error {rmse} (root mean square, from the first sample on)"
        ));
    }
    if let Some(share) = found.learned {
        lines.push(format!(
            "the learner was used for {:.0} % of the samples",
            100.0 * share
        ));
    }
    lines.join("\n")
}
