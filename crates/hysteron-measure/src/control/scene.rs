//! A scenario, its errors, and its table.

use super::bound::bound;
use crate::result::Result;
use hysteron::Progress;
use hysteron_sim::joint::Tuned;
use hysteron_sim::track::{Comparison, Kind, Scenario, Tuning, Window, track};

const KINDS: [(&str, Kind); 5] = [
    ("PID", Kind::Pid),
    ("inverse", Kind::InverseAnticipate),
    ("adaptive inverse", Kind::AdaptiveAnticipate),
    ("inverse + PID", Kind::InversePidAnticipate),
    ("adaptive inverse + PID", Kind::AdaptivePidAnticipate),
];

/// Those that get gains by simulation on the model too.
const JOINT: [&str; 2] = ["inverse + PID", "adaptive inverse + PID"];

/// How many times faster than the test asks the closed loop of PI/RLS is made. The best is shown.
const SPEEDS: [f64; 5] = [1.0, 2.0, 4.0, 10.0, 20.0];

/// The errors of each controller, a median over the runs for each window.
type Row = (String, Vec<f64>);

pub(super) struct Scene {
    pub(super) name: &'static str,
    title: String,
    unit: String,
    windows: Vec<Window>,
    rows: Vec<Row>,
    /// The gains of the joint tuning, and their margins.
    margins: String,
}

impl Scene {
    /// Runs the built-in scenario `name`.
    pub(super) fn run(name: &'static str, seeds: u32) -> Result<Self> {
        let mut scenario = Scenario::load(name)?;
        scenario.seeds = seeds;
        scenario.controllers = KINDS.map(|(_, kind)| kind).to_vec();
        let found = track(&scenario, Progress::NONE)?;
        let shown = shown(&found.windows);
        let windows: Vec<Window> = shown.iter().map(|w| found.windows[*w].clone()).collect();
        let named = KINDS.iter().enumerate();
        let mut rows: Vec<Row> = named
            .map(|(k, (name, _))| ((*name).into(), medians(&found, k, &shown)))
            .collect();
        rows[0].0 += by(scenario.shared.tuning);
        let other = with_the_other_test(&scenario);
        let pid = row(&other, Kind::Pid, &shown);
        rows.splice(
            1..1,
            [pid, pi_rls(&scenario, &shown), pi_rls(&other, &shown)]
                .into_iter()
                .flatten(),
        );
        let (tuned, margins) = by_model(&scenario, &shown)?;
        rows.extend(tuned);
        let bound = bound(&scenario, &windows)?;
        rows.extend(bound.map(|errors| ("bound".into(), errors)));
        let [_, _, output] = scenario.plant.quantities();
        Ok(Self {
            name,
            title: scenario.title,
            unit: output.unit.unwrap_or_default(),
            windows,
            rows,
            margins,
        })
    }

    pub(super) fn print(&self) {
        println!("\n## `{}`: {}, {}\n", self.name, self.title, self.unit);
        let heads = self.windows.iter().map(words);
        println!("| | {} |", heads.collect::<Vec<_>>().join(" | "));
        println!("| --- |{}", " ---: |".repeat(self.windows.len()));
        for (name, errors) in &self.rows {
            let cells = errors.iter().map(|error| format!("{error:.3}"));
            println!("| {name} | {} |", cells.collect::<Vec<_>>().join(" | "));
        }
        if !self.margins.is_empty() {
            println!("\n{}.", self.margins);
        }
    }

    /// Where an adaptive inverse has more than `most` times the error of the fixed one.
    pub(super) fn lost_to_fixed(&self, most: f64) -> Vec<String> {
        let [fixed, adaptive] = JOINT;
        let (fixed_jointly, adaptive_jointly) = (jointly(fixed), jointly(adaptive));
        let pairs = [
            ("alone", "adaptive inverse", "inverse"),
            ("with PID", adaptive, fixed),
            ("with joint tuning", &adaptive_jointly, &fixed_jointly),
        ];
        let each = pairs.into_iter().flat_map(|(how, learns, stays)| {
            let lost = self.lost(learns, &[stays], most).into_iter();
            lost.map(move |(w, ratio)| (w, how, ratio))
        });
        each.map(|(w, how, ratio)| format!("{}, {how}, {ratio:.2}", words(&self.windows[w])))
            .collect()
    }

    /// Where an adaptive inverse and PID has more than `most` times the error of the PID alone.
    pub(super) fn lost_to_pid(&self, most: f64) -> Vec<String> {
        let pids = self.rows.iter().map(|(name, _)| name.as_str());
        let pids: Vec<&str> = pids.filter(|name| name.starts_with("PID")).collect();
        let lost = self.lost("adaptive inverse + PID", &pids, most);
        lost.into_iter()
            .map(|(w, ratio)| format!("{}, {ratio:.2}", words(&self.windows[w])))
            .collect()
    }

    /// Where the better PI/RLS has a smaller error than the best one of those with an inverse and
    /// PID, by more than a factor of `most`.
    pub(super) fn won_by_pi_rls(&self, most: f64) -> Vec<String> {
        let rows = self
            .rows
            .iter()
            .filter(|(name, _)| name.starts_with("PI/RLS"));
        let won = rows.flat_map(|(name, _)| {
            let joint = JOINT.map(jointly);
            let all = JOINT.into_iter().chain(joint.iter().map(String::as_str));
            self.lost(name, &all.collect::<Vec<_>>(), 0.0).into_iter()
        });
        let mut best = vec![f64::INFINITY; self.windows.len()];
        won.for_each(|(w, ratio)| best[w] = best[w].min(ratio));
        let won = best.iter().zip(&self.windows);
        won.filter(|(ratio, _)| **ratio * most < 1.0)
            .map(|(ratio, window)| format!("{}, {ratio:.2}", words(window)))
            .collect()
    }

    fn lost(&self, one: &str, others: &[&str], most: f64) -> Vec<(usize, f64)> {
        let of = |name: &str| {
            let row = self.rows.iter().find(|(row, _)| row == name);
            row.map_or(&[][..], |(_, errors)| errors)
        };
        let ratio = |w: usize| {
            let best = others.iter().map(|other| of(other)[w]);
            of(one)[w] / best.fold(f64::INFINITY, f64::min)
        };
        let each = (0..self.windows.len()).map(|w| (w, ratio(w)));
        each.filter(|(_, ratio)| *ratio > most).collect()
    }
}

/// The row of a controller whose gains come from the model.
fn jointly(name: &str) -> String {
    format!("{name}{}", by(Tuning::Model))
}

fn by(tuning: Tuning) -> &'static str {
    match tuning {
        Tuning::Relay => ", relay test",
        Tuning::Step => ", step test",
        Tuning::Model => ", joint tuning",
    }
}

fn with_the_other_test(scenario: &Scenario) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.shared.tuning = match scenario.shared.tuning {
        Tuning::Relay => Tuning::Step,
        // Of gains from the model, both are another one.
        Tuning::Step | Tuning::Model => Tuning::Relay,
    };
    scenario
}

/// A single controller. None where the plant does not answer the test of the scenario.
fn row(scenario: &Scenario, kind: Kind, windows: &[usize]) -> Option<Row> {
    let mut scenario = scenario.clone();
    scenario.controllers = vec![kind];
    let found = track(&scenario, Progress::NONE).ok()?;
    let name = format!("{}{}", kind.words(), by(scenario.shared.tuning));
    Some((name, medians(&found, 0, windows)))
}

/// Inverse and PID with the gains of the joint tuning, and what these are.
fn by_model(scenario: &Scenario, windows: &[usize]) -> Result<(Vec<Row>, String)> {
    let mut scenario = scenario.clone();
    scenario.shared.tuning = Tuning::Model;
    let kinds = KINDS.iter().filter(|(name, _)| JOINT.contains(name));
    let (names, kinds): (Vec<&str>, Vec<Kind>) = kinds.copied().unzip();
    scenario.controllers = kinds;
    let found = track(&scenario, Progress::NONE)?;
    let row = |(k, name): (usize, &&str)| (jointly(name), medians(&found, k, windows));
    let rows = names.iter().enumerate().map(row).collect();
    // Fixed or adaptive, the gains are those of the fixed model.
    let first = found.tuned.first().and_then(|runs| *runs.first()?);
    let said = first.map_or(String::new(), |Tuned { gains, margin }| {
        let (gain, integral_s) = (gains.gain, gains.integral_s);
        format!(
            "Joint tuning: gain {gain:.2e}, integral time {integral_s:.2e} s, margin {margin:.1}"
        )
    });
    Ok((rows, said))
}

/// PI/RLS with the speed of the smallest geometric mean of its errors: no window decides alone.
fn pi_rls(scenario: &Scenario, windows: &[usize]) -> Option<Row> {
    let each = SPEEDS.iter().filter_map(|speed| {
        let mut scenario = scenario.clone();
        scenario.shared.speed = Some(*speed);
        let (name, errors) = row(&scenario, Kind::PiRls, windows)?;
        Some((format!("{name}, x {speed}"), errors))
    });
    let mean = |(_, errors): &Row| errors.iter().map(|error| error.ln()).sum::<f64>();
    each.min_by(|a, b| mean(a).total_cmp(&mean(b)))
}

/// The places of settled windows, and of those that are over before anything settles.
fn shown(windows: &[Window]) -> Vec<usize> {
    let settles = |w: usize| {
        let next = windows.get(w + 1);
        next.is_some_and(|next| next.name == format!("{}, settled", windows[w].name))
    };
    (0..windows.len()).filter(|w| !settles(*w)).collect()
}

fn words(window: &Window) -> String {
    let name = window.name.trim_end_matches(", settled");
    name.trim_start_matches("after ").into()
}

/// The medians of the errors of the `k`-th controller in these windows.
fn medians(found: &Comparison, k: usize, windows: &[usize]) -> Vec<f64> {
    let of = |w: &usize| median(found.scores[k].iter().map(|run| run[*w].rmse).collect());
    windows.iter().map(of).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
