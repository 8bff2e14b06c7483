//! The exported controller gives the drives of the library's, bit for bit.

use crate::common::programs::{has, links, skip};
use crate::common::reference::Number;
use crate::common::staged::{Case, bare, case};
use crate::common::{Exported, answers, same, walks};
use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Safety, Scheme};
use hysteron::{Direction, Model, Policy, Sample};
use hysteron_export::{COptions, CReal, CSampling, c_controlled};
use rand::RngExt;
use rand::rngs::StdRng;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// A model and its loop.
struct Loop {
    model: Model,
    sampling: CSampling,
    scheme: Scheme,
}

/// What a loop may have beside the feedback.
#[derive(Clone, Copy, Debug)]
struct Parts {
    gate: bool,
    filter: bool,
    time: bool,
}

impl Parts {
    const ALL: Self = Self::of(7);

    const fn of(bits: u64) -> Self {
        Self {
            gate: bits & 1 > 0,
            filter: bits & 2 > 0,
            time: bits & 4 > 0,
        }
    }
}

fn rings(model: &Model) -> bool {
    !model.constants().get("ring_frequency").is_empty()
}

/// Loops around models with random stages, without loads. Each has some of the parts, and the last
/// one all of them: the code in a folder is that of the last one.
fn loops(seed: u64, parts: Parts) -> Vec<Loop> {
    let mut rng = walks::rng(seed);
    let mut loops = Vec::new();
    let sizes = [2, 3, 5, 8, 20];
    for levels in sizes {
        for operator in walks::OPERATORS {
            for staged in [false, true] {
                let found = std::iter::repeat_with(|| {
                    let mut case = match staged {
                        true => case(&mut rng, operator, levels, false),
                        false => bare(&mut rng, operator, levels),
                    };
                    case.sampling.drive = None;
                    case
                });
                let last = loops.len() + 1 == 2 * sizes.len() * walks::OPERATORS.len();
                let fits = |case: &Case| {
                    !(last && rings(&case.model))
                        && case.model.load.is_none()
                        && case.model.inverse().is_ok()
                        && case.model.is_plain() != staged
                        && case.is_kept(CReal::Float)
                };
                let case = found.filter(fits).take(1).next().unwrap();
                loops.push(around(&mut rng, case, parts));
            }
        }
    }
    // As if they were of folders of their own.
    let count = loops.len();
    for each in &mut loops[..count - 1] {
        if rng.random_bool(0.2) {
            each.scheme.gate = None;
        }
        if rng.random_bool(0.2) {
            each.scheme.filter_s = 0.0;
        }
        each.sampling.measured &= !rng.random_bool(0.2);
    }
    loops
}

fn around(rng: &mut StdRng, case: Case, parts: Parts) -> Loop {
    let dt = case.sampling.dt.unwrap_or(0.01);
    let (off, on) = case.model.output_range();
    let (low, high) = case.drives;
    let slope = (high - low) / if on == off { 1.0 } else { on - off };
    let coin = |rng: &mut StdRng| rng.random_bool(0.6);
    let gains = Gains {
        gain: slope * rng.random_range(0.0..2.0),
        integral_s: if coin(rng) {
            dt * rng.random_range(1.0..50.0)
        } else {
            0.0
        },
        derivative_s: if coin(rng) {
            dt * rng.random_range(0.1..10.0)
        } else {
            0.0
        },
    };
    let some = |rng: &mut StdRng, value: f64| coin(rng).then_some(value);
    let slew = (high - low) / dt * rng.random_range(0.01..0.5);
    let scheme = Scheme {
        tolerance: 0.01 * (on - off).abs(),
        pid: coin(rng).then_some(gains),
        slew: some(rng, slew),
        stuck_s: some(rng, 4.0 * dt),
        gate: parts.gate.then_some(0.02 * (on - off).abs()),
        filter_s: match parts.filter {
            true => dt * rng.random_range(0.2..20.0),
            false => 0.0,
        },
        safety: Safety {
            lost_s: rng.random_bool(0.3).then_some(6.0 * dt),
            stuck_s: rng.random_bool(0.3).then_some(5.0 * dt),
        },
        delay: rng.random_bool(0.7).then(|| rng.random_range(0..6)),
        ..Scheme::new(dt, case.drives)
    };
    let measured = parts.time && !rings(&case.model);
    Loop {
        model: case.model,
        sampling: CSampling {
            measured,
            ..case.sampling
        },
        scheme,
    }
}

fn export(loops: &[Loop], real: CReal) -> Exported {
    let folder = tempfile::tempdir().unwrap();
    let (mut includes, mut list, mut sources) = (String::new(), String::new(), Vec::new());
    for (n, each) in loops.iter().enumerate() {
        let name = format!("m{n}");
        let options = COptions {
            real,
            name: Some(&name),
            source: Path::new("some model.json"),
            adaptation: false,
        };
        let Loop {
            model,
            sampling,
            scheme,
        } = each;
        let made = c_controlled(model, folder.path(), &options, sampling, scheme).unwrap();
        let bare = made.stages.is_empty();
        sources.extend(
            made.files
                .into_iter()
                .filter(|file| file.extension().unwrap() == "c"),
        );
        writeln!(includes, "#include \"{name}.h\"").unwrap();
        let starts = match bare && model.fitted().is_some() {
            true => {
                format!("{name}_start, sizeof {name}_start / sizeof(hys_real), &{name}_start_input")
            }
            false => "NULL, 0, NULL".into(),
        };
        let (plain, staged) = match bare {
            true => (format!("&{name}"), "NULL".into()),
            false => ("NULL".into(), format!("&{name}")),
        };
        writeln!(list, "{{{plain}, {staged}, &{name}_control, {starts}}},").unwrap();
    }
    sources.sort();
    sources.dedup();
    let text = format!(
        "{includes}#define MOST_TURNS 88\n#define MOST_LATE 1010\n\
         static const loop loops[] = {{{list}}};\n"
    );
    std::fs::write(folder.path().join("models.h"), text).unwrap();
    Exported::of(folder, real, sources)
}

/// What happens at a sample.
#[derive(Clone, Copy)]
enum Event {
    GoOnFrom(f64),
    Sample {
        reference: f64,
        ahead: f64,
        heading: i32,
        noise: f64,
        reading: Read,
        /// The measured time.
        dt: Option<f64>,
    },
}

#[derive(Clone, Copy, PartialEq)]
enum Read {
    Plant,
    Missing,
    Stuck,
    Jammed,
}

/// References that wander, jump and rest, with readings that are missing or stand still.
fn events(rng: &mut StdRng, each: &Loop, count: usize) -> Vec<Event> {
    let (a, b) = each.model.output_range();
    let (low, high) = (
        a.min(b) - 0.1 * (b - a).abs(),
        a.max(b) + 0.1 * (b - a).abs() + 1e-9,
    );
    let (bottom, top) = each.scheme.drives;
    let mut events = Vec::new();
    let spikes = rng.random_bool(0.5);
    let mut reference = rng.random_range(low..high);
    while events.len() < count {
        if rng.random_bool(0.1) {
            events.push(Event::GoOnFrom(rng.random_range(bottom..top)));
        }
        if rng.random_bool(0.3) {
            reference = rng.random_range(low..high);
        }
        let slope = rng.random_range(-0.05..0.05) * (high - low);
        let heading = [0, 0, 0, 1, -1][rng.random_range(0..5)];
        let reading = [
            Read::Plant,
            Read::Plant,
            Read::Plant,
            Read::Missing,
            Read::Stuck,
            Read::Jammed,
        ][rng.random_range(0..6)];
        let noise = [0.0, 0.001][rng.random_range(0..2)] * (high - low);
        for _ in 0..rng.random_range(1..25) {
            let ahead = if rng.random_bool(0.8) {
                reference + slope
            } else {
                reference
            };
            let noise = match rng.random_range(0..20) {
                0 if spikes => rng.random_range(-2.0..2.0) * (high - low),
                _ if noise > 0.0 => rng.random_range(-noise..noise),
                _ => 0.0,
            };
            let dt = each.sampling.measured.then(|| {
                let times = match rng.random_range(0..4) {
                    0 => 1.0,
                    1 => rng.random_range(0.01..30.0),
                    _ => rng.random_range(0.5..2.0),
                };
                times * each.scheme.interval_s
            });
            events.push(Event::Sample {
                reference,
                ahead,
                heading,
                noise,
                reading,
                dt,
            });
            reference += slope;
        }
    }
    events
}

fn hex(x: f64) -> String {
    match x {
        x if x.is_nan() => "nan".into(),
        0.0 => 0f64.hex(),
        x => x.hex(),
    }
}

/// Commands, and what the library's controller answers.
fn script(n: usize, each: &Loop, events: &[Event]) -> (String, String) {
    let Loop { model, scheme, .. } = each;
    let compensator = Some(Compensator::fixed(model).unwrap());
    let policy = Policy::Anticipate; // a heading of none is *hold*
    let scheme = Scheme {
        compensator,
        policy,
        ..scheme.clone()
    };
    let mut controller = Controller::new(scheme).unwrap();
    // The plant is another one than the model: it drifts and has another gain.
    let (mut state, interval) = (model.start(), each.scheme.interval_s);
    let (mut output, mut shown, mut held) = (model.output_range().0, 0.0, 0.0);
    let mut drive = None;
    let (mut commands, mut expected) = (format!("m {n} 1\n"), String::from("m 0\n"));
    for event in events {
        match *event {
            Event::GoOnFrom(from) => {
                controller.go_on_from(from).unwrap();
                drive = Some(from);
                writeln!(commands, "g {}", from.hex()).unwrap();
                expected += "g 0\n";
            }
            Event::Sample {
                reference,
                ahead,
                heading,
                noise,
                reading,
                dt,
            } => {
                let told = dt.unwrap_or(f64::NAN).hex();
                let dt = dt.unwrap_or(interval);
                if let Some(input) = drive {
                    let sample = Sample {
                        input,
                        dt: Some(dt),
                        load: None,
                    };
                    output = model.step(&mut state, sample).unwrap().output;
                }
                shown = match reading {
                    Read::Plant => 0.9 * output + 0.3 + noise,
                    Read::Missing => f64::NAN,
                    Read::Stuck => shown,
                    Read::Jammed => held + noise,
                };
                if reading != Read::Jammed {
                    held = shown;
                }
                let due = controller.due();
                let ahead = if due == 0 { reference } else { ahead };
                writeln!(
                    commands,
                    "s {} {} {heading} {} {told}",
                    reference.hex(),
                    ahead.hex(),
                    shown.hex()
                )
                .unwrap();
                let target = Reference {
                    output: reference,
                    heading: match heading {
                        -1 => Some(Direction::Falling),
                        1 => Some(Direction::Rising),
                        _ => None,
                    },
                };
                let reading = Reading {
                    output: shown,
                    input: None,
                };
                let action = controller
                    .step_after(dt, target, &vec![ahead; due], reading)
                    .unwrap();
                drive = Some(action.drive);
                let flags = [
                    action.status.saturated,
                    action.status.out_of_reach,
                    action.status.sensor_fault,
                    action.status.stuck,
                    action.status.safe,
                    false,
                    action.status.rejected,
                ];
                let status: u32 = (0..7).map(|n| u32::from(flags[n]) << n).sum();
                let (drive, prediction) = (hex(action.drive), hex(action.prediction));
                writeln!(expected, "s 0 {drive} {prediction} {status}").unwrap();
            }
        }
    }
    (commands, expected)
}

fn compare(program: &mut Command, loops: &[Loop], seed: u64, count: usize, what: &str) {
    let mut rng = walks::rng(seed);
    let mut all = [const { String::new() }; 2];
    for (n, each) in loops.iter().enumerate() {
        let events = events(&mut rng, each, count);
        let (commands, expected) = script(n, each, &events);
        all[0] += &commands;
        all[1] += &expected;
    }
    let [commands, expected] = all;
    same(&commands, &expected, &answers(program, &commands), what);
    // Every flag is among the answers.
    let gated = loops.iter().any(|each| each.scheme.gate.is_some());
    for flag in [1, 2, 4, 8, 16].into_iter().chain(gated.then_some(64)) {
        let has = |line: &str| {
            let status = line
                .strip_prefix("s 0 ")
                .and_then(|line| line.rsplit(' ').next());
            status.is_some_and(|status| status.parse::<u32>().unwrap() & flag != 0)
        };
        assert!(expected.lines().any(has), "{what}: no flag {flag}");
    }
}

#[test]
fn random_loops_have_the_same_drives() {
    if !has("cc") {
        return;
    }
    for seed in 0..8 {
        let loops = loops(seed, Parts::of(seed));
        let exported = export(&loops, CReal::Double);
        let program = exported.compile("cc", &["-O2"], "control.c");
        compare(
            &mut Command::new(program),
            &loops,
            seed,
            800,
            &format!("seed {seed}"),
        );
    }
}

#[test]
fn compilers_and_sanitizers_change_no_drive() {
    const SANITIZE: [&str; 3] = [
        "-O1",
        "-fsanitize=address,undefined,float-cast-overflow",
        "-fno-sanitize-recover=all",
    ];
    let loops = loops(9, Parts::ALL);
    let exported = export(&loops, CReal::Double);
    let plain = ["-O0", "-Os", "-O3"].map(|level| vec![level]);
    for flags in plain.into_iter().chain([SANITIZE.to_vec()]) {
        for cc in ["gcc", "clang"] {
            if has(cc) && (links(cc, &flags) || skip("a compiler has no sanitizers")) {
                let program = exported.compile(cc, &flags, "control.c");
                compare(
                    &mut Command::new(program),
                    &loops,
                    9,
                    600,
                    &format!("{cc} {flags:?}"),
                );
            }
        }
    }
}
