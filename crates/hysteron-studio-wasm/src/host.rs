//! A session and its pages, without memory of JavaScript.

use hysteron_studio::{Fault, Finished, Id, Job, JobView, Request, Session, Told};
use serde::{Deserialize, Serialize};

/// The limit of the memory for all files, in bytes. A browser gives an instance 4 GiB, of which a
/// file that is read, and what is computed from it, take several times its size.
const MEMORY: u64 = 1 << 30;

/// What came of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// The answer is a fault.
    Refused = 0,
    /// The answer is a response.
    Answered = 1,
    /// So it is, and the session is another one.
    Changed = 2,
}

/// A session, and how often it changed.
#[derive(Debug)]
pub(crate) struct Host {
    session: Session,
    changes: u64,
    failed: Option<Fault>,
    /// Jobs that are to be run elsewhere.
    waiting: Vec<Job>,
}

/// How far a job is, as it is told from one worker to another.
#[derive(Serialize, Deserialize)]
struct Progress {
    job: Id,
    stage: String,
    /// `None` where it is not known: JSON has no NaN.
    share: Option<f64>,
}

/// A job that ended from outside.
#[derive(Deserialize)]
struct Ended {
    job: Id,
    /// What went wrong; `None` if it was cancelled.
    problem: Option<String>,
}

impl Host {
    pub(crate) fn new() -> Self {
        Self {
            session: Session::new(MEMORY),
            changes: 0,
            failed: None,
            waiting: Vec::new(),
        }
    }

    /// Whether a file of so many bytes may come.
    pub(crate) fn admits(&self, bytes: u64) -> (Outcome, Vec<u8>) {
        match self.session.admits(bytes) {
            Ok(()) => (Outcome::Answered, Vec::new()),
            Err(fault) => refused(&fault),
        }
    }

    /// Opens a file. Its name stands behind its bytes.
    pub(crate) fn open(&mut self, mut bytes: Vec<u8>, name: usize) -> (Outcome, Vec<u8>) {
        let name = bytes.split_off(bytes.len().saturating_sub(name));
        let opened = self.session.open(&String::from_utf8_lossy(&name), bytes);
        let found = opened.and_then(|_| self.session.handle(Request::Overview));
        match found {
            Ok(answer) => self.changed(&answer.response),
            Err(fault) => refused(&fault),
        }
    }

    /// Answers a request, which is JSON.
    pub(crate) fn request(&mut self, request: &[u8]) -> (Outcome, Vec<u8>) {
        let request = serde_json::from_slice::<Request>(request);
        let Ok(request) = request else {
            let what = "the page asked for what the session does not know";
            return refused(&Fault::defect(what));
        };
        let changes = request.changes();
        match self.session.handle(request) {
            Err(fault) => refused(&fault),
            Ok(answer) => {
                self.waiting.extend(answer.job);
                match changes {
                    true => self.changed(&answer.response),
                    false => (Outcome::Answered, json(&answer.response)),
                }
            }
        }
    }

    /// The number of a job that is to be run elsewhere, and the job as bytes.
    pub(crate) fn job(&mut self) -> Option<(Id, Vec<u8>)> {
        let job = self.waiting.pop()?;
        Some((job.id, job.to_bytes()))
    }

    /// Takes what [`Host::job`] and [`run`] led to.
    pub(crate) fn finish(&mut self, finished: &[u8]) {
        match Finished::from_bytes(finished) {
            Ok(finished) => self.finished(finished),
            Err(fault) => self.failed = Some(fault),
        }
    }

    /// A job has ended from outside.
    pub(crate) fn ended(&mut self, ended: &[u8]) {
        if let Ok(Ended { job, problem }) = serde_json::from_slice(ended) {
            let why = problem.as_deref().unwrap_or("the fit was ended");
            self.finished(Finished::without(job, Fault::defect(why)));
        }
    }

    fn finished(&mut self, finished: Finished) {
        self.failed = self.session.finish(finished).err();
        self.changes += 1;
    }

    /// Takes the progress of a job.
    pub(crate) fn progress(&mut self, told: &[u8]) {
        if let Ok(Progress { job, stage, share }) = serde_json::from_slice(told) {
            self.session.told(job, stage, share.unwrap_or(f64::NAN));
        }
    }

    /// What the pages are told.
    pub(crate) fn told(&self) -> Vec<u8> {
        let jobs: Vec<JobView> = self.session.jobs();
        json(&Told {
            changes: self.changes,
            jobs,
            failed: self.failed.clone(),
            named: 0,
        })
    }

    fn changed(&mut self, response: &impl Serialize) -> (Outcome, Vec<u8>) {
        self.changes += 1;
        (Outcome::Changed, json(response))
    }
}

/// Runs a job of [`Host::job`] and tells its progress, for [`Host::progress`].
pub(crate) fn run(job: &[u8], tell: &(dyn Fn(&[u8]) + Sync)) -> Vec<u8> {
    let job = match Job::from_bytes(job) {
        Ok(job) => job,
        Err(fault) => return Finished::without(0, fault).to_bytes(),
    };
    let id = job.id;
    let told = |stage: &'static str, share: f64| {
        let share = Some(share).filter(|share| share.is_finite());
        let stage = stage.to_owned();
        tell(&json(&Progress {
            job: id,
            stage,
            share,
        }));
    };
    job.run_telling(&told).to_bytes()
}

fn refused(fault: &Fault) -> (Outcome, Vec<u8>) {
    (Outcome::Refused, json(fault))
}

fn json(what: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(what).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::{Value, json};
    use std::sync::Mutex;

    const TABLE: &str = "T,lift\n20,0\n80,14\n20,1\n70,12\n30,3\n80,14\n20,0\n";

    fn open(host: &mut Host, name: &str, text: &str) -> (Outcome, Value) {
        let bytes = [text.as_bytes(), name.as_bytes()].concat();
        let (outcome, answer) = host.open(bytes, name.len());
        (outcome, serde_json::from_slice(&answer).unwrap())
    }

    fn ask(host: &mut Host, request: &Value) -> (Outcome, Value) {
        let (outcome, answer) = host.request(request.to_string().as_bytes());
        (outcome, serde_json::from_slice(&answer).unwrap())
    }

    fn told(host: &Host) -> Value {
        serde_json::from_slice(&host.told()).unwrap()
    }

    #[test]
    fn a_fit_goes_to_another_worker_and_comes_back() {
        let mut host = Host::new();
        let (outcome, seen) = open(&mut host, "röhre.csv", TABLE);
        assert_eq!(outcome, Outcome::Changed);
        assert_eq!(seen["files"][0]["name"], "röhre.csv");
        let options = json!({"levels": "3", "bootstrap": "0"});
        let fit = json!({"request": "fit", "options": options, "hold_out": "nothing"});
        assert_eq!(ask(&mut host, &fit).0, Outcome::Changed);
        let (id, job) = host.job().unwrap();
        assert!(host.job().is_none());
        let steps = Mutex::new(Vec::new());
        let found = run(&job, &|told| steps.lock().unwrap().push(told.to_owned()));
        for step in steps.into_inner().unwrap() {
            host.progress(&step);
            let stage: Value = serde_json::from_slice(&step).unwrap();
            assert_eq!(told(&host)["jobs"][0]["stage"], stage["stage"]);
        }
        let before = told(&host);
        host.finish(&found);
        assert_eq!(
            told(&host)["changes"],
            before["changes"].as_u64().unwrap() + 1
        );
        assert_eq!(told(&host)["jobs"], json!([]));
        let (outcome, seen) = ask(&mut host, &json!({"request": "overview"}));
        assert_eq!(
            (outcome, &seen["fits"][0]["id"]),
            (Outcome::Answered, &json!(id))
        );
    }

    #[test]
    fn a_job_that_is_ended_is_told_with_its_reason() {
        let mut host = Host::new();
        open(&mut host, "a.csv", TABLE);
        let fit = json!({"request": "fit", "hold_out": "nothing"});
        for (cancel, code) in [(true, 103), (false, 104)] {
            ask(&mut host, &fit);
            let (id, _) = host.job().unwrap();
            if cancel {
                ask(&mut host, &json!({"request": "cancel", "job": id}));
            }
            let problem = (!cancel).then_some("no memory");
            host.ended(
                json!({"job": id, "problem": problem})
                    .to_string()
                    .as_bytes(),
            );
            assert_eq!(told(&host)["failed"]["code"], code);
            assert_eq!(told(&host)["jobs"], json!([]));
        }
    }

    #[test]
    fn what_is_no_call_is_refused_and_changes_nothing() {
        let mut host = Host::new();
        open(&mut host, "a.csv", TABLE);
        let before = told(&host);
        for bytes in [
            &b""[..],
            b"{",
            b"null",
            b"{\"request\":\"no such\"}",
            b"\xff\xfe",
        ] {
            assert_eq!(host.request(bytes).0, Outcome::Refused);
            assert_eq!(host.open(bytes.to_vec(), usize::MAX).0, Outcome::Refused);
            host.progress(bytes);
            host.ended(bytes);
            let found: Value = serde_json::from_slice(&run(bytes, &|_| ())).unwrap();
            assert_eq!(found["found"]["Err"]["code"], 104);
        }
        assert_eq!(told(&host), before);
        assert_eq!(host.admits(MEMORY / 2).0, Outcome::Answered);
        // What is open counts, too.
        assert_eq!(host.admits(MEMORY).0, Outcome::Refused);
        assert_eq!(host.admits(u64::MAX).0, Outcome::Refused);
    }
}
