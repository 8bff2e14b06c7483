//! What is fitted and what is predicted: fixed, and the same for every method.

use crate::cycles::cycles;
use crate::genuine;
use crate::result::Result;
use hysteron::{Columns, Recording, Repair, branches, usual_tolerance};
use std::path::Path;

/// Groups of branches that are left out in turn.
const FOLDS: usize = 5;

/// Cycles of decaying amplitude that stand for a demagnetisation.
const DECAY: usize = 20;

/// One task: fit some recordings, predict the output of another one.
pub struct Split {
    /// Name of its files.
    pub name: String,
    pub training: Vec<Recording>,
    /// The whole input of the test, with what is known to have come before.
    pub test: Recording,
    /// For each sample of the test, whether it counts.
    pub scored: Vec<bool>,
}

/// A row of the table: one task, or several that are scored together.
pub struct Set {
    pub name: String,
    pub splits: Vec<Split>,
    /// Whether the errors are also given in the unit of the output.
    pub unit: Option<&'static str>,
}

impl Set {
    fn one(name: &str, training: Vec<Recording>, test: Recording) -> Self {
        let scored = vec![true; test.len()];
        Self::scored(name, training, test, scored)
    }

    fn scored(name: &str, training: Vec<Recording>, test: Recording, scored: Vec<bool>) -> Self {
        let split = Split {
            name: file_name(name),
            training,
            test,
            scored,
        };
        Self {
            name: name.into(),
            splits: vec![split],
            unit: None,
        }
    }

    /// Every group of `group` left out in turn. What is in no group is always fitted.
    fn folds(name: &str, whole: &Recording, group: &[Option<usize>]) -> Self {
        let fold = |f: usize| Split {
            name: format!("{}-{f}", file_name(name)),
            training: whole.only(|n| group[n] != Some(f)).into_iter().collect(),
            test: whole.clone(),
            scored: group.iter().map(|g| *g == Some(f)).collect(),
        };
        Self {
            name: name.into(),
            splits: (0..FOLDS).map(fold).collect(),
            unit: None,
        }
    }
}

fn file_name(name: &str) -> String {
    let word = |c: char| if c.is_ascii_alphanumeric() { c } else { ' ' };
    let words: String = name.chars().map(word).collect();
    words.split_whitespace().collect::<Vec<_>>().join("-")
}

/// Every task, from the recordings in a folder.
pub fn all(folder: &Path) -> Result<Vec<Set>> {
    let mut sets = magnet(folder)?;
    sets.push(reversal_curves(folder)?);
    sets.extend(valve(folder)?);
    sets.extend(loads(folder)?);
    sets.extend(thermal_cycles(folder)?);
    sets.push(first_order_reversal_curves(folder)?);
    sets.extend(symmetric_loops(folder)?);
    Ok(sets)
}

fn read(folder: &Path, name: &str, columns: Columns<'_>) -> Result<Recording> {
    Ok(Recording::read(&folder.join(name), columns, Repair::Refuse)?.0)
}

/// One scan predicts the next.
fn magnet(folder: &Path) -> Result<Vec<Set>> {
    let scan = |n: u32| {
        let name = format!("magnet_lcls2_quad_ru{n}.csv");
        read(folder, &name, Columns::new("current_A", "BL_T"))
    };
    let mut set = Set::one("magnet ru3 to ru4", vec![scan(3)?], scan(4)?);
    set.unit = Some("T");
    Ok(vec![set])
}

/// Reversal curves of a wire, in five groups. The major loop is always fitted. Copies of the major
/// loop are neither fitted nor scored.
fn reversal_curves(folder: &Path) -> Result<Set> {
    let path = folder.join("sma_basaeri_train.csv");
    let (input, output) = ("voltage_V", "output");
    let copied = genuine::column(&path, input, "ascending_copied_from_major")?;
    let curve = genuine::column(&path, input, "reversal_curve")?;
    let whole = genuine::read(&path, Columns::new(input, output))?;
    let genuine = copied
        .iter()
        .zip(curve)
        .filter(|(copied, _)| **copied == 0.0);
    let group = |curve: f64| (curve > 0.0).then_some(curve as usize % FOLDS);
    let group: Vec<Option<usize>> = genuine.map(|(_, curve)| group(curve)).collect();
    Ok(Set::folds("basaeri by curves", &whole, &group))
}

/// One of the recordings of the valve.
pub fn valve_recording(folder: &Path, name: &str) -> Result<Recording> {
    let columns = Columns {
        time: Some("time_s"),
        ..Columns::new("voltage_V", "position")
    };
    read(folder, &format!("valve_{name}.csv"), columns)
}

/// A valve under one drive predicts it under another.
fn valve(folder: &Path) -> Result<Vec<Set>> {
    let file = |name: &str| valve_recording(folder, name);
    let pairs = [
        ("sine50_1", "sine100_1"),
        ("sine100_1", "sine50_1"),
        ("20Hz", "100Hz"),
        ("100Hz", "20Hz"),
    ];
    let set = |(from, to): (&str, &str)| {
        let [a, b] = [from, to].map(|name| name.trim_end_matches("_1"));
        let name = format!("valve {a} to {b}");
        Ok(Set::one(&name, vec![file(from)?], file(to)?))
    };
    pairs.into_iter().map(set).collect()
}

/// One load left out, predicted from the others. The lowest and the highest load stay.
fn loads(folder: &Path) -> Result<Vec<Set>> {
    let materials: [(&str, &str, &str, &[u32]); 3] = [
        ("flexinol", "flexinol", "strain", &[50, 150, 200]),
        ("NiTiCo", "nitico_walgren", "strain", &[7, 50, 200]),
        (
            "NiTiHf",
            "nitihf_bigelow",
            "strain_percent",
            &[7, 50, 100, 200, 400],
        ),
    ];
    let mut sets = Vec::new();
    for (name, file, output, loads) in materials {
        let columns = Columns {
            load: Some("stress_MPa"),
            ..Columns::new("temperature_C", output)
        };
        let at = |load: &u32| read(folder, &format!("sma_{file}_{load}MPa.csv"), columns);
        let all: Vec<Recording> = loads.iter().map(at).collect::<Result<_>>()?;
        let inner = loads.iter().enumerate().skip(1).take(all.len() - 2);
        for (left, load) in inner {
            let mut others = all.clone();
            let unseen = others.remove(left);
            let name = format!("{name} at {load} MPa");
            sets.push(Set::one(&name, others, unseen));
        }
    }
    Ok(sets)
}

/// Each thermal cycle predicted from the one before.
fn thermal_cycles(folder: &Path) -> Result<Vec<Set>> {
    // Its times repeat, because they were rounded.
    let columns = Columns::new("temperature_C", "extension_mm");
    let (_, cycles) = cycles(&read(folder, "sma_isobaric_cycles_1_to_4.csv", columns)?)?;
    let set = |(n, pair): (usize, &[Recording])| {
        let name = format!("isobaric cycle {} to {}", n + 1, n + 2);
        Set::one(&name, vec![pair[0].clone()], pair[1].clone())
    };
    Ok(cycles.windows(2).enumerate().map(set).collect())
}

/// Rising curves of a ferroelectric film from its reversals, in five groups. The turning points at
/// their ends stay, because the falling branches begin and end there.
fn first_order_reversal_curves(folder: &Path) -> Result<Set> {
    let columns = Columns::new("voltage_V", "polarization_uC_cm2");
    let whole = read(folder, "ferro_rtwhiteA_forc5.csv", columns)?;
    let branch = branches(&whole.input, usual_tolerance(&whole.input));
    let mut group = vec![None; whole.len()];
    let mut from = 0;
    for same in branch.chunk_by(|a, b| a == b) {
        let end = from + same.len() - 1;
        let number = same[0];
        if number >= 2 && whole.input[end] > whole.input[from] {
            group[from..end].fill(Some(number / 2 % FOLDS));
        }
        from = end + 1;
    }
    Ok(Set::folds("FORC ferro by curves", &whole, &group))
}

/// The largest of nested symmetric loops predicts the smaller ones. Before each of those, the input
/// decayed from the largest one, as in a demagnetisation.
fn symmetric_loops(folder: &Path) -> Result<Vec<Set>> {
    let mut sets = Vec::new();
    for (name, file, count) in [("MnZn", "MnZn_ferrite", 4), ("M130", "M130_27s", 3)] {
        let read = |n: usize| {
            let name = format!("bh_{file}_loop{n}.csv");
            read(folder, &name, Columns::new("H_A_per_m", "B_T"))
        };
        let largest = read(count)?;
        for n in (1..count).rev() {
            let measured = read(n)?;
            let ((_, from), _) = largest.ranges();
            let ((_, to), _) = measured.ranges();
            let amplitude = |k: usize| from + (to - from) * k as f64 / DECAY as f64;
            let history = (0..=DECAY).flat_map(|k| [amplitude(k), -amplitude(k)]);
            let mut test = measured.clone();
            test.input = history.chain(measured.input).collect();
            let before = test.input.len() - measured.output.len();
            // The outputs before are not known. They are not scored, and no method sees them.
            test.output = vec![0.0; before];
            test.output.extend(&measured.output);
            let scored = (0..test.len()).map(|n| n >= before).collect();
            let name = format!("{name} loop {count} to {n}");
            sets.push(Set::scored(&name, vec![largest.clone()], test, scored));
        }
    }
    Ok(sets)
}
