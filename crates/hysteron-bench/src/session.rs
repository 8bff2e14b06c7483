//! The run: from the first question to the safe drive.

use crate::at::At;
use crate::companion::Companion;
use crate::config::{Config, Mode};
use crate::device::{self, Line, Received};
use crate::end::{End, Stop};
use crate::error::{Error, Result};
use crate::handshake::ask;
use crate::jitter::Jitter;
use crate::learner::Beside;
use crate::log::{self, Log};
use crate::plan::{Plan, Sources};
use crate::protocol::{FromDevice, Sample, ToDevice, drive_text, opened};
use crate::row::{Answer, columns, replay};
use crate::summary::{Options, Seen, Summary, log_path};
use hysteron::control::Reading;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long a device may take to its first sample.
const FIRST: Duration = Duration::from_secs(5);
/// How often somebody who stops the run is looked for.
const LOOK: Duration = Duration::from_millis(20);
/// How long a device may take to end after it was told to.
const LEAVE: Duration = Duration::from_secs(1);
/// Characters of a bad line that are shown.
const SHOWN: usize = 60;
/// Drives that the device may name later.
const REMEMBERED: usize = 4096;

/// Runs what a file says until it ends, however that is. `remark` is told what somebody should know
/// before it begins, `observe` each sample.
///
/// ```
/// use hysteron_bench::{Config, End, Options, Stop, run};
/// let folder = tempfile::tempdir()?;
/// let text = "mode = 'record'\nlog = 'run.csv'\n[device]\nsimulated = 'preisach'\n\
///             [profile]\ntable = 'profile.csv'\n";
/// std::fs::write(folder.path().join("profile.csv"), "time,drive\n0,0\n1,100\n2,0\n")?;
/// let config = Config::parse(text, &folder.path().join("run.toml"))?;
/// let found = run(&config, &Options::default(), &Stop::default(), &mut |_| {}, &mut |_| {})?;
/// assert_eq!((found.end, found.samples), (End::Done, 40));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error`] where it cannot begin; the device has been sent nothing then, or was told to quit.
pub fn run(
    config: &Config,
    options: &Options,
    stop: &Stop,
    remark: &mut dyn FnMut(&str),
    observe: &mut dyn FnMut(&Seen<'_>),
) -> Result<Summary> {
    let path = log_path(config, options)?;
    let sources = Sources::read(config)?;
    let before = match options.resume {
        true => {
            log::resumable(&path)?;
            Some(Companion::of(&path)?)
        }
        false => log::claim(&path, options.force).map(|()| None)?,
    };
    let mut line = device::open(config)?;
    let begun = begin(config, sources, line.as_mut(), stop)
        .and_then(|plan| Session::new(config, plan, &path, before));
    let mut session = match begun {
        Ok(session) => session,
        Err(error) => {
            let _ = line.send(&ToDevice::Quit.line());
            line.close(Instant::now() + LEAVE);
            return Err(error);
        }
    };
    session.plan.remarks.iter().for_each(|text| remark(text));
    let end = session.follow(line.as_mut(), stop, observe);
    let end = session.leave(line, end);
    Ok(session.finish(end))
}

/// Asks the device who it is, and plans the run for it.
fn begin(config: &Config, sources: Sources, line: &mut dyn Line, stop: &Stop) -> Result<Plan> {
    let header = ask(line, stop).map_err(|problem| match problem {
        None => Error::Stopped,
        Some(problem) => Error::Device {
            name: device::name(config),
            problem,
        },
    })?;
    Plan::new(config, sources, header)
}

struct Session {
    plan: Plan,
    log: Log,
    path: PathBuf,
    companion: Companion,
    /// Samples of this run, by their numbers on the device.
    last: Option<Sample>,
    /// The last sample of the log.
    logged: Option<At>,
    /// Time of the device at the last valid reading, s.
    valid_s: f64,
    /// Drives by the numbers of their samples on the device.
    sent: VecDeque<(u64, f64)>,
    /// The drive of the last row.
    drive: f64,
    /// Readings beyond the limits in a row.
    beyond: u32,
    /// For how long readings were astray, s, less the time that they were not.
    astray_s: f64,
    jitter: Jitter,
    /// Squared errors of the readings that were believed, and how many these are.
    squares: f64,
    compared: u64,
    learned: u64,
    counts: Counts,
    /// The last line that meant nothing.
    bad_line: Option<String>,
}

#[derive(Default)]
struct Counts {
    samples: u64,
    lost: u64,
    old: u64,
    bad: u64,
    missing: u64,
    rejected: u64,
}

impl Session {
    fn new(
        config: &Config,
        mut plan: Plan,
        path: &Path,
        before: Option<Companion>,
    ) -> Result<Self> {
        let columns = columns(&plan.header);
        let safe = plan.header.safe;
        let mut companion = Companion::new(&plan.header.name, columns.clone());
        let mut logged = None;
        let log = match before {
            None => Log::create(path, &columns)?,
            Some(before) => {
                if (&before.device, &before.columns) != (&companion.device, &companion.columns) {
                    let what = "the log is one of another device: name another log";
                    return Err(config.refused("log", what));
                }
                before.refuse(config, &plan.follows, plan.end_s, &log::rows_of(path))?;
                let log = Log::reopen(path)?;
                logged = replay(&mut plan, log.rows())?;
                companion = before;
                log
            }
        };
        companion.follows = Some(plan.follows.clone());
        companion.learner = plan.learner.map(|learner| learner.name().to_owned());
        companion.bytes = None;
        companion.end = None;
        plan.controller.go_on_from(safe)?;
        Ok(Self {
            log,
            path: path.to_owned(),
            companion,
            last: None,
            logged,
            valid_s: 0.0,
            sent: VecDeque::new(),
            drive: safe,
            beyond: 0,
            astray_s: 0.0,
            jitter: Jitter::default(),
            squares: 0.0,
            compared: 0,
            learned: 0,
            counts: Counts::default(),
            bad_line: None,
            plan,
        })
    }

    /// From the first sample to the end.
    fn follow(
        &mut self,
        line: &mut dyn Line,
        stop: &Stop,
        observe: &mut dyn FnMut(&Seen<'_>),
    ) -> End {
        if let Err(error) = line.send(&ToDevice::Go.line()) {
            return End::Closed(error.to_string());
        }
        let lost = Duration::from_secs_f64(self.plan.lost_s.min(1e6));
        let mut heard = Instant::now();
        let mut patience = FIRST.max(lost);
        loop {
            if stop.is_set() {
                return End::Stopped;
            }
            let silent = heard.elapsed();
            let received = match silent < patience {
                true => line.receive(Instant::now() + LOOK.min(patience - silent)),
                // What has come in time may have waited for the host.
                false => line.receive(Instant::now()),
            };
            let (bytes, came) = match received {
                Received::Line(bytes, came) => (bytes, came),
                Received::Silence if heard.elapsed() >= patience => {
                    return End::Lost(heard.elapsed().as_secs_f64());
                }
                Received::Silence => continue,
                Received::Closed => return End::Closed("it was closed".into()),
            };
            match opened(&bytes).and_then(FromDevice::parse) {
                Some(FromDevice::End(why)) => return End::Device(why),
                Some(FromDevice::Header(_)) => {}
                Some(FromDevice::Sample(sample)) if self.is_whole(&sample) => {
                    match self.take(&sample) {
                        false => self.counts.old += 1,
                        true => {
                            (heard, patience) = (came, lost);
                            match self.sample(sample, came, line, observe) {
                                Ok(None) => {}
                                Ok(Some(end)) => return end,
                                Err(error) => return End::Failed(error.to_string()),
                            }
                        }
                    }
                }
                _ => {
                    self.counts.bad += 1;
                    let line = String::from_utf8_lossy(&bytes);
                    self.bad_line = Some(line.trim_end().chars().take(SHOWN).collect());
                }
            }
            // A flood of what is no sample is silence, too.
            if heard.elapsed() >= patience.max(2 * LOOK) && came > heard + patience {
                return End::Lost(heard.elapsed().as_secs_f64());
            }
        }
    }

    fn is_whole(&self, sample: &Sample) -> bool {
        sample.readings.len() == self.plan.header.columns.len()
    }

    /// Whether a sample is a new one. One that came before is not stepped again.
    fn take(&mut self, sample: &Sample) -> bool {
        match &self.last {
            Some(last) if sample.number <= last.number || sample.time <= last.time => false,
            Some(last) => {
                self.counts.lost += sample.number - last.number - 1;
                true
            }
            None => {
                self.place(sample);
                true
            }
        }
    }

    /// Finds where the first sample is in the run: numbers, times, and what is due.
    fn place(&mut self, first: &Sample) {
        let dt = self.plan.header.dt;
        self.valid_s = first.time - dt;
        let companion = &mut self.companion;
        match self.logged {
            // A clock that begins with the run is the run's. One that runs since the board was
            // started is not.
            None => {
                let begins = first.time.abs() <= 20.0 * dt;
                companion.origin_s = if begins { 0.0 } else { first.time - dt };
            }
            Some(last) => {
                let again = first.number <= last.number || first.time <= last.time;
                companion.shift = match again {
                    true => (
                        last.number.saturating_sub(first.number) + 1,
                        last.time + dt - first.time,
                    ),
                    false => (0, 0.0),
                };
                // The time between the runs is not the run's.
                companion.origin_s += first.time + companion.shift.1 - (last.time + dt);
            }
        }
    }

    fn at(&self, sample: &Sample) -> At {
        let (numbers, times) = self.companion.shift;
        At {
            number: sample.number + numbers,
            // Shorter than any clock counts, and without the digits that a sum leaves.
            time: (1e9 * (sample.time + times)).round() / 1e9,
        }
    }

    /// Answers a sample, and logs it. How the run ends with it, if it does.
    fn sample(
        &mut self,
        sample: Sample,
        came: Instant,
        line: &mut dyn Line,
        observe: &mut dyn FnMut(&Seen<'_>),
    ) -> Result<Option<End>> {
        let at = self.at(&sample);
        let dt = match &self.last {
            Some(last) => sample.time - last.time,
            None => self.plan.header.dt,
        };
        self.drive = self.applied(sample.applied);
        let elapsed = at.time - self.companion.origin_s;
        let output = self
            .plan
            .header
            .column("output")
            .map_or(f64::NAN, |n| sample.readings[n]);
        let answer = self.answer(dt, elapsed, output);
        let (mut end, answer) = match answer {
            Ok(answer) => {
                let done = self.unmoved(at.number, dt, output).or(self.done(elapsed));
                (
                    self.ends((sample.time, dt), output, &answer).or(done),
                    answer,
                )
            }
            Err(error) => (Some(End::Failed(error.to_string())), Answer::nothing()),
        };
        let (drive, word) = match &end {
            Some(_) => (self.plan.header.safe, Some("safe")),
            None => (answer.drive, None),
        };
        let (text, drive) = drive_text(drive, self.plan.header.drive);
        let message = ToDevice::Drive {
            sample: sample.number,
            text: text.clone(),
        };
        if let Err(error) = line.send(&message.line()) {
            end = end.or(Some(End::Closed(error.to_string())));
        }
        self.jitter.push(sample.time, came, Instant::now());
        self.sent.push_back((sample.number, drive));
        if self.sent.len() > REMEMBERED {
            self.sent.pop_front();
        }
        let learner = self.learner();
        let first = self.last.is_none();
        let row = answer.row(
            &self.plan.header,
            &sample,
            at,
            (self.drive, &text),
            (word, learner),
        );
        let written = self.log.row(&row);
        match written {
            Ok(()) => self.counts.samples += 1,
            Err(error) => end = end.or_else(|| Some(End::Log(error.to_string()))),
        }
        self.logged = Some(at);
        self.counts.missing += u64::from(output.is_nan());
        let rejected = self.plan.mode == Mode::Control && answer.status.rejected;
        self.counts.rejected += u64::from(rejected && output.is_finite());
        if answer.learner_used {
            self.learned += 1;
        }
        self.companion.last = (at.number, at.time);
        self.last = Some(sample);
        if first && log::is_file(&self.path) && end.is_none() {
            // After a kill this is what a later run finds.
            if let Err(error) = self.companion.write(&self.path) {
                end = Some(End::Log(error.to_string()));
            }
        }
        observe(&Seen {
            elapsed_s: elapsed,
            end_s: self.plan.end_s,
            reference: answer.reference,
            output,
            drive,
            learner,
            jitter_s: self.jitter.rms_s(),
        });
        Ok(end)
    }

    /// The drive that acted up to a sample, which the device names.
    fn applied(&self, number: u64) -> f64 {
        let found = self.sent.iter().rev().find(|(sent, _)| *sent == number);
        match (found, number) {
            (Some((_, drive)), _) => *drive,
            (None, 0) => self.plan.header.safe,
            // A number that was never sent: what acted before does so still.
            (None, _) => self.drive,
        }
    }

    /// What to do at a sample that is no end.
    fn answer(&mut self, dt: f64, elapsed: f64, output: f64) -> Result<Answer> {
        let plan = &mut self.plan;
        plan.controller.applied(self.drive)?;
        let reading = Reading {
            output,
            input: None,
        };
        if plan.mode == Mode::Monitor {
            return Ok(Answer {
                drive: plan.header.safe,
                ..Answer::nothing()
            });
        }
        let Some(course) = &plan.course else {
            return Ok(Answer::nothing());
        };
        let reference = course.at(elapsed);
        if plan.mode == Mode::Record {
            let action = plan.controller.step_command_after(dt, reference, reading)?;
            return Ok(Answer {
                drive: action.drive,
                limited: action.drive != reference,
                status: hysteron::control::LoopStatus {
                    stuck: false,
                    ..action.status
                },
                ..Answer::nothing()
            });
        }
        if let Some(model) = plan.beside.as_ref().and_then(Beside::take) {
            plan.controller.renew(&model)?;
        }
        let step = plan.header.dt;
        let next: Vec<f64> = (1..=plan.ahead)
            .map(|n| course.at(elapsed + n as f64 * step))
            .collect();
        let due = elapsed + plan.controller.due() as f64 * step;
        let target = hysteron::control::Reference {
            output: course.at(elapsed),
            heading: course.target(due).heading,
        };
        let action = plan.controller.step_after(dt, target, &next, reading)?;
        if let (Some(beside), Some(input)) = (&mut plan.beside, action.filtered.input) {
            let sample = hysteron::Sample {
                input,
                dt: Some(dt),
                load: None,
            };
            beside.push(
                sample,
                Some(action.filtered.output).filter(|output| output.is_finite()),
            );
        }
        let compensator = plan.controller.compensator();
        let learner_used = compensator.is_some_and(|found| found.trusts_learner());
        if output.is_finite() && !action.status.rejected {
            self.squares += (reference - output) * (reference - output);
            self.compared += 1;
        }
        Ok(Answer {
            drive: action.drive,
            reference,
            expected: action.prediction,
            limited: action.status.saturated,
            status: action.status,
            learner_used,
        })
    }

    /// Whether a profile moves nothing.
    fn unmoved(&mut self, number: u64, dt: f64, output: f64) -> Option<End> {
        let sweep = self.plan.sweep.as_mut()?;
        sweep.push(number, dt, self.drive, output).map(End::Unmoved)
    }

    /// Whether all was run.
    fn done(&self, elapsed: f64) -> Option<End> {
        let tolerance = 0.01 * self.plan.header.dt;
        let is_over = |end: f64| elapsed >= end - tolerance;
        self.plan.end_s.is_some_and(is_over).then_some(End::Done)
    }

    /// How the run ends with a sample before all was run.
    fn ends(&mut self, (time, dt): (f64, f64), output: f64, answer: &Answer) -> Option<End> {
        let plan = &self.plan;
        let tolerance = 0.01 * plan.header.dt;
        if output.is_finite() {
            self.valid_s = time;
        }
        // A spike alone is no end; a second reading beyond the limits is.
        let outside = |(low, high): (f64, f64)| output < low || output > high;
        self.beyond = match plan.outputs.is_some_and(outside) {
            true => self.beyond + 1,
            false => 0,
        };
        // Neither is it where it is wanted, nor where the model can be.
        let astray = |(low, high): (f64, f64)| {
            outside((low, high)) && 2.0 * (answer.reference - output).abs() > high - low
        };
        self.astray_s = match plan.reach.is_some_and(astray) {
            true => self.astray_s + dt,
            // No reading says nothing.
            false if output.is_nan() => self.astray_s,
            false => (self.astray_s - dt).max(0.0),
        };
        let stuck = plan
            .controller
            .stuck_s()
            .filter(|_| plan.mode == Mode::Control);
        if self.beyond > u32::from(answer.status.rejected) {
            Some(End::Limit(output))
        } else if self.astray_s >= plan.lost_s - tolerance {
            Some(End::Astray(output))
        } else if time - self.valid_s >= plan.lost_s - tolerance {
            Some(End::Lost(time - self.valid_s))
        } else {
            let is_over = |time: &f64| *time >= plan.stuck_s - tolerance;
            stuck.filter(is_over).map(End::Stuck)
        }
    }

    fn learner(&self) -> &'static str {
        let compensator = self.plan.controller.compensator();
        match (self.plan.learner, compensator) {
            (Some(learner), Some(compensator)) if compensator.trusts_learner() => learner.name(),
            (Some(_), _) => "fixed",
            (None, _) => "",
        }
    }

    /// Leaves the device safe, whatever the end is, and closes the line.
    fn leave(&mut self, mut line: Box<dyn Line>, end: End) -> End {
        let safe = drive_text(self.plan.header.safe, self.plan.header.drive).0;
        if let Some(last) = &self.last {
            let message = ToDevice::Drive {
                sample: last.number,
                text: safe,
            };
            let _ = line.send(&message.line());
        }
        let _ = line.send(&ToDevice::Quit.line());
        let deadline = Instant::now() + LEAVE;
        while let Received::Line(bytes, _) = line.receive(deadline) {
            let said = opened(&bytes).and_then(FromDevice::parse);
            if matches!(said, Some(FromDevice::End(_))) || Instant::now() >= deadline {
                break;
            }
        }
        let how = line.close(Instant::now() + LEAVE);
        match (end, how) {
            (End::Closed(_), Some(how)) => End::Closed(how),
            (end, _) => end,
        }
    }

    /// Closes the log and the file beside it.
    fn finish(mut self, mut end: End) -> Summary {
        self.companion.end = Some(end.word().into());
        let learned = self
            .plan
            .controller
            .compensator()
            .and_then(|found| found.learned());
        let text = learned.map(|model| model.to_json());
        self.companion.model = text.and_then(|text| serde_json::from_str(&text).ok());
        let has_companion = log::is_file(&self.path);
        let closed = self.log.finish().and_then(|bytes| {
            self.companion.bytes = Some(bytes);
            match has_companion {
                true => self.companion.write(&self.path),
                false => Ok(()),
            }
        });
        if let Err(error) = closed
            && end == End::Done
        {
            end = End::Log(error.to_string());
        }
        let Counts {
            samples,
            lost,
            old,
            bad,
            missing,
            rejected,
        } = self.counts;
        let count = samples.max(1) as f64;
        let learner = self.plan.learner;
        Summary {
            end,
            samples,
            lost,
            old,
            bad,
            bad_line: self.bad_line,
            missing,
            rejected,
            rmse: (self.plan.mode == Mode::Control && self.compared > 0)
                .then(|| (self.squares / self.compared as f64).sqrt()),
            learned: learner.map(|_| self.learned as f64 / count),
            jitter_s: self.jitter.rms_s(),
            slowest_s: self.jitter.slowest_s(),
            tuned: self.plan.tuned.map(|tuned| (tuned.gains, tuned.margin)),
            log: self.path,
        }
    }
}
