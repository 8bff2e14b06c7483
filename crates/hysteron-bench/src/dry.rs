//! What a run would do.

use crate::at::At;
use crate::companion::{Companion, Follows};
use crate::config::{Config, Mode};
use crate::error::Result;
use crate::plan::Sources;
use crate::protocol::ToDevice;
use crate::summary::{Options, log_path};
use crate::sweep::LEAST_S;
use crate::{device, log};

/// What a run would do, as lines for people. Nothing is opened and nothing is sent.
///
/// # Errors
/// As [`crate::run`], for what is known without a device.
pub fn dry_run(config: &Config, options: &Options) -> Result<Vec<String>> {
    let path = log_path(config, options)?;
    let sources = Sources::read(config)?;
    let course_end = sources.course.as_ref().map(|course| course.end_s());
    let end_s = config.duration_s.or(course_end);
    let resumed = match options.resume {
        false => log::claim(&path, options.force).map(|()| None)?,
        true => {
            log::resumable(&path)?;
            let before = Companion::of(&path)?;
            let follows = Follows::of(config, sources.model.as_ref());
            let last = before.refuse(config, &follows, end_s, &log::rows_of(&path))?;
            Some((before.origin_s, last))
        }
    };
    let or = |value: Option<String>, other: &str| value.unwrap_or_else(|| other.to_owned());
    let range = |range: Option<(f64, f64)>| range.map(|(low, high)| format!("{low} to {high}"));
    let seconds = |value: Option<f64>| value.map(|value| format!("{value} s"));
    let mode = match config.mode {
        Mode::Record => "record: plays a profile",
        Mode::Control => "control: follows a reference",
        Mode::Monitor => "monitor: the drive stays safe",
    };
    let mut lines = vec![
        format!("mode      {mode}"),
        format!("device    {}", device::name(config)),
        format!("log       {}", path.display()),
    ];
    if let Some((origin_s, last)) = resumed {
        lines.push(match last {
            Some(At { number, time }) => {
                format!("resumes   after sample {number}, at {} s", time - origin_s)
            }
            None => "resumes   a log without rows".into(),
        });
    }
    if let Some(course) = &sources.course {
        let (low, high) = course.range();
        lines.push(format!(
            "course    {low} to {high}, until {} s",
            course.end_s()
        ));
    }
    lines.push(format!(
        "duration  {}",
        or(seconds(end_s), "until it is stopped")
    ));
    lines.push(format!(
        "drive     {}; slew {}",
        or(range(config.limits.drive), "as the device says"),
        or(
            config.limits.slew.map(|slew| format!("{slew} per s")),
            "not limited"
        ),
    ));
    lines.push(format!(
        "output    {}",
        or(
            range(config.limits.output),
            match (config.mode, &sources.model) {
                (Mode::Control, Some(_)) => "the run ends far beyond what the model reaches",
                _ => "not limited",
            }
        )
    ));
    if let (Some(options), Mode::Control) = (&config.controller, config.mode) {
        let gains = match options.gains().filter(|_| options.kind.has_pid()) {
            Some(crate::Tuning::Model) => "gains from the model".into(),
            Some(crate::Tuning::Numbers(gains)) => format!(
                "gain {}, integral time {} s, derivative time {} s",
                gains.gain, gains.integral_s, gains.derivative_s
            ),
            None => "no PID".to_owned(),
        };
        lines.push(format!("control   {}; {gains}", options.kind.words()));
    }
    let of_noise = format!("{LEAST_S} s of noise");
    lines.push(format!(
        "safety    lost after {}; stuck after {}",
        or(seconds(config.safety.lost_s), "0.5 s, at least 5 samples"),
        or(
            seconds(config.safety.stuck_s),
            match config.mode {
                Mode::Record => &of_noise,
                _ => "1 s, at least 5 samples",
            }
        ),
    ));
    for (what, message) in [
        ("who", ToDevice::Who),
        ("go", ToDevice::Go),
        ("quit", ToDevice::Quit),
    ] {
        lines.push(format!("would send {what}: {}", message.line().trim_end()));
    }
    lines.push("would send a drive for each sample, within these limits; nothing was sent".into());
    Ok(lines)
}
