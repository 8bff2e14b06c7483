//! The exported C of a model with stages gives the core's digits, bit for bit.

use crate::common::programs::{has, links, run, skip};
use crate::common::reference::Number;
use crate::common::staged::{Call, Case, calls, case, script};
use crate::common::{Exported, REALS, answers, same, walks};
use hysteron::{FirstOrder, Model, Operator, Plane, Sample, Sign, Target, Wanted};
use hysteron_core::operator_count;
use hysteron_export::{COptions, CReal, CSampling, c, c_sampled};
use rand::RngExt;
use std::path::Path;
use std::process::Command;

/// Models of each operator with random stages.
fn zoo(seed: u64) -> Vec<Case> {
    let mut rng = walks::rng(seed);
    let levels = [2, 3, 5, 8, 13, 20, 33];
    let mut cases: Vec<Case> = Vec::new();
    for (n, &k) in levels.iter().enumerate() {
        for operator in walks::OPERATORS {
            let found = std::iter::repeat_with(|| case(&mut rng, operator, k, n % 2 == 0));
            // One that needs the C of the stages, and that float keeps.
            let fits = |case: &Case| staged(&case.model) && case.is_kept(CReal::Float);
            cases.extend(found.filter(fits).take(1));
        }
    }
    cases
}

fn staged(model: &Model) -> bool {
    let stages = model.stages();
    let axis = stages.axis;
    let moved = !axis.load.loads.is_empty() || !axis.registration.knots.is_empty();
    model.is_timed() || moved || !axis.spacing.is_empty()
}

fn compare(exported: &Exported, program: &mut Command, cases: &[(&Case, Vec<Call>)], what: &str) {
    let (mut commands, mut expected) = (String::new(), String::new());
    for (n, (case, calls)) in cases.iter().enumerate() {
        let (lines, answers) = match exported.real {
            CReal::Float => script::<f32>(n, case, calls),
            CReal::Double => script::<f64>(n, case, calls),
        };
        commands += &lines;
        expected += &answers;
    }
    let found = answers(program, &commands);
    same(&commands, &expected, &found, what);
    // Every status is among the answers.
    for status in ["0", "1", "-1", "2", "3"] {
        let such = |line: &str| line.starts_with("i 0 ") && line.ends_with(&format!(" {status}"));
        assert!(expected.lines().any(such), "{what}: no status {status}");
    }
}

fn fuzz(zoo: &[Case], seed: u64, count: usize) -> Vec<(&Case, Vec<Call>)> {
    let mut rng = walks::rng(seed);
    zoo.iter()
        .map(|case| (case, calls(&mut rng, case, count)))
        .collect()
}

fn exported(zoo: &[Case], real: CReal) -> Exported {
    let models: Vec<_> = zoo
        .iter()
        .map(|case| (&case.model, case.sampling))
        .collect();
    Exported::staged(&models, real)
}

#[test]
fn random_stages_have_the_same_digits() {
    if !has("cc") {
        return;
    }
    for seed in 0..6 {
        let zoo = zoo(seed);
        let parts = |case: &&Case| {
            case.model
                .load
                .as_ref()
                .is_some_and(|l| l.parts().len() > 1)
        };
        assert!(
            zoo.iter().filter(parts).count() >= 3,
            "weights over the load"
        );
        let cases = fuzz(&zoo, 100 + seed, 3000);
        for real in REALS {
            let exported = exported(&zoo, real);
            exported.count_iterations();
            let program = exported.compile("cc", &["-O2"], "staged.c");
            let what = format!("seed {seed}, {}", real.name());
            compare(&exported, &mut Command::new(program), &cases, &what);
        }
    }
}

#[test]
fn compilers_and_sanitizers_change_no_digit() {
    const SANITIZE: [&str; 4] = [
        "-O1",
        "-fsanitize=address,undefined,float-cast-overflow",
        "-fno-sanitize-recover=all",
        "-fno-omit-frame-pointer",
    ];
    let zoo = zoo(9);
    let cases = fuzz(&zoo, 9, 1000);
    let sanitizes = has("cc") && (links("cc", &SANITIZE) || skip("`cc` has no sanitizers"));
    for real in REALS {
        let exported = exported(&zoo, real);
        for (cc, most) in [("gcc", "-ffp-contract=fast"), ("clang", "-ffp-contract=on")] {
            let plain = ["-O0", "-Os", "-O3"].map(|level| vec![level, "-ffp-contract=off"]);
            for flags in plain
                .into_iter()
                .chain([vec!["-O2", "-march=native", most]])
            {
                if has(cc) {
                    let program = exported.compile(cc, &flags, "staged.c");
                    let what = format!("{cc} {flags:?}, {}", real.name());
                    compare(&exported, &mut Command::new(program), &cases, &what);
                }
            }
        }
        if sanitizes {
            let program = exported.compile("cc", &SANITIZE, "staged.c");
            compare(&exported, &mut Command::new(program), &cases, "sanitized");
        }
    }
}

/// The model with every stage.
fn every() -> Case {
    let mut rng = walks::rng(1);
    let mut cases = std::iter::repeat_with(|| case(&mut rng, Operator::Mkp, 5, true));
    let kept = |case: &Case| case.is_kept(CReal::Float) && case.model.latent() > 0.0;
    cases.find(kept).unwrap()
}

#[test]
fn the_stages_need_no_library() {
    if !has("cc") || !has("nm") {
        return;
    }
    let case = weighted();
    for real in REALS {
        let exported = exported(std::slice::from_ref(&case), real);
        for level in ["-O0", "-O2", "-Os", "-O3"] {
            let objects = [
                "hysteron_mcu.o",
                "hysteron_mcu_inverse.o",
                "hysteron_mcu_stages.o",
                "hysteron_mcu_stages_inverse.o",
                "m0.o",
            ];
            let folder = exported.folder.path();
            for object in objects {
                run(Command::new("cc")
                    .args(["-std=c99", "-ffreestanding", level, "-c"])
                    .arg(object.replace(".o", ".c"))
                    .current_dir(folder));
            }
            run(Command::new("ld")
                .args(["-r", "-o", "all.o"])
                .args(objects)
                .current_dir(folder));
            let symbols = Command::new("nm")
                .args(["-u", "all.o"])
                .current_dir(folder)
                .output();
            let symbols = String::from_utf8(symbols.unwrap().stdout).unwrap();
            assert!(!symbols.contains(" U "), "{level}: {symbols}");
        }
    }
}

/// The memory figures are those of a Cortex-M.
#[test]
fn memory_is_what_is_told() {
    const ARM: &str = "arm-none-eabi-gcc";
    if !has(ARM) {
        return;
    }
    for (case, real) in [every(), weighted()]
        .iter()
        .flat_map(|case| REALS.map(|real| (case, real)))
    {
        let folder = tempfile::tempdir().unwrap();
        let made = c_sampled(&case.model, folder.path(), &named(real), &case.sampling).unwrap();
        let text = std::fs::read_to_string(folder.path().join("one.c")).unwrap();
        // Whatever the model has, so that no stage to come is left out.
        let arrays: Vec<&str> = text
            .lines()
            .filter_map(|line| line.strip_prefix("static const hys_real "))
            .map(|line| line.split_once('[').unwrap().0)
            .filter(|array| *array != "table")
            .collect();
        assert!(arrays.len() > 3, "{arrays:?}");
        let arrays: String = arrays
            .iter()
            .map(|array| format!(" + sizeof {array}"))
            .collect();
        let (parts, mixed) = match text.contains("hys_parts parts") {
            true => (
                " + sizeof parts",
                " + sizeof(hys_mixed) + ONE_TABLE * sizeof(hys_real)",
            ),
            false => ("", ""),
        };
        let text = format!(
            "#include \"one.c\"\n\
             typedef char constants[sizeof table + sizeof operators + sizeof one{arrays}{parts} == {} ? 1 : -1];\n\
             typedef char state[sizeof(hys_actuator_state){mixed} == {} ? 1 : -1];\n",
            made.memory.constants, made.memory.state,
        );
        std::fs::write(folder.path().join("sizes.c"), text).unwrap();
        run(Command::new(ARM)
            .args([
                "-std=c99",
                "-ffreestanding",
                "-mcpu=cortex-m4",
                "-c",
                "sizes.c",
            ])
            .current_dir(folder.path()));
    }
}

/// A model with every stage whose weights depend on the load too.
fn weighted() -> Case {
    let mut rng = walks::rng(3);
    let found = std::iter::repeat_with(|| case(&mut rng, Operator::Mkp, 5, true));
    let of = |case: &Case| {
        let load = case.model.load.as_ref();
        load.is_some_and(|load| load.parts().len() == 4)
            && case.model.inverse().is_ok()
            && case.is_kept(CReal::Float)
    };
    found.into_iter().find(of).unwrap()
}

/// Weights that depend on the load: the C has the digits of the library itself, the memory that is
/// told, and refuses to start without it (`staged.c`).
#[test]
fn weights_over_the_load_are_those_of_the_library() {
    if !has("cc") {
        return;
    }
    let case = weighted();
    let model = &case.model;
    let (low, high) = model.load.as_ref().unwrap().range();
    let (a, b) = model.output_range();
    let mut rng = walks::rng(4);
    let mut state = model.start();
    let (mut commands, mut expected) = (String::from("m 0\n"), String::from("m 0\n"));
    let mut load = low;
    let (from, to) = case.sampling.drive.unwrap_or_else(|| model.drive_range());
    let inverse = model.inverse().unwrap().drive_range(from, to).unwrap();
    for n in 0..2000 {
        if n % 3 == 0 {
            load = rng.random_range(low..=high);
        }
        let (dt, given) = (case.sampling.dt, Some(load));
        if n % 2 == 0 {
            let input = rng.random_range(case.drives.0..case.drives.1);
            let sample = Sample {
                input,
                dt,
                load: given,
            };
            let output = model.step(&mut state, sample).unwrap().output;
            commands += &format!("s {} {}\n", input.hex(), load.hex());
            expected += &format!("s 0 {}\n", output.hex());
        } else {
            let target = rng.random_range(a.min(b)..a.max(b));
            let wanted = Wanted {
                dt,
                load: given,
                ..Target::new(target).into()
            };
            let found = inverse.step(&mut state, wanted).unwrap();
            commands += &format!("i {} 0 {} {}\n", target.hex(), 0.0f64.hex(), load.hex());
            expected += &format!("i 0 {} {}\n", found.input.hex(), found.status.number());
        }
    }
    let exported = exported(std::slice::from_ref(&case), CReal::Double);
    let program = exported.compile("cc", &["-O2"], "staged.c");
    let found = answers(&mut Command::new(program), &commands);
    same(&commands, &expected, &found, "the library");
}

fn named(real: CReal) -> COptions<'static> {
    COptions {
        real,
        name: Some("one"),
        source: Path::new("one.json"),
        adaptation: false,
    }
}

fn plain() -> Model {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    let weights = vec![1.0; operator_count(5)];
    Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive).unwrap()
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let mut timed = plain();
    timed.thermal = Some(FirstOrder::default());
    let at = |dt: f64| CSampling {
        dt: Some(dt),
        drive: None,
        ..CSampling::default()
    };
    let driven = |low: f64, high: f64| CSampling {
        dt: None,
        drive: Some((low, high)),
        ..CSampling::default()
    };
    let spaced = plain()
        .with_spacing(vec![0.0, 1.0, 2.0, 4.0, 8.0, 9.0])
        .unwrap();
    let cases = [
        (&timed, CSampling::default(), "`dt`"),
        (&timed, at(0.0), "above zero"),
        (&timed, at(f64::NAN), "above zero"),
        (&spaced, at(0.1), "does not depend on time"),
        (&plain(), at(0.1), "does not depend on time"),
        (&plain(), driven(0.0, 1.0), "no stages"),
        (&spaced, driven(1.0, 0.0), "in order"),
        (&spaced, driven(0.0, f64::INFINITY), "finite"),
    ];
    for (model, sampling, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let refused = c_sampled(model, folder.path(), &named(CReal::Float), &sampling);
        let said = refused.unwrap_err().to_string();
        assert!(said.contains(expected), "{sampling:?}: {said}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
    let learns = COptions {
        adaptation: true,
        ..named(CReal::Float)
    };
    let folder = tempfile::tempdir().unwrap();
    let said = c(&spaced, folder.path(), &learns).unwrap_err().to_string();
    assert!(said.contains("`adaptation`"), "{said}");
}

/// A plain model beside one with stages: the files that they share are the same.
#[test]
fn a_plain_model_does_without_the_stages() {
    let folder = tempfile::tempdir().unwrap();
    let options = named(CReal::Float);
    let files = c(&plain(), folder.path(), &options).unwrap().files;
    let before: Vec<Vec<u8>> = files
        .iter()
        .map(|file| std::fs::read(file).unwrap())
        .collect();
    let case = every();
    let other = COptions {
        name: Some("other"),
        ..options
    };
    let made = c_sampled(&case.model, folder.path(), &other, &case.sampling).unwrap();
    let stages = [
        "body",
        "latent",
        "load",
        "registration",
        "spacing",
        "curve",
        "creep",
        "lag",
        "ring",
    ];
    assert_eq!(made.stages, stages);
    let after: Vec<Vec<u8>> = files
        .iter()
        .map(|file| std::fs::read(file).unwrap())
        .collect();
    assert!(before == after);
    assert_eq!(made.files.len(), 14);
}

/// A plain model that starts where its fit found it carries its turning points.
#[test]
fn a_plain_model_has_its_start_beside() {
    let model = plain();
    let mut state = model.start();
    model
        .run(&mut state, &[75.0, 33.0, 61.0], &mut [0.0; 3])
        .unwrap();
    let mut file: serde_json::Value = serde_json::from_str(&model.to_json()).unwrap();
    let points: Vec<f64> = state.turning_points().collect();
    file["version"] = 2.into();
    file["start"] = serde_json::json!({"turning_points": points, "input": state.input()});
    let started = Model::from_json(&file.to_string()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    c(&started, folder.path(), &named(CReal::Double)).unwrap();
    let text = std::fs::read_to_string(folder.path().join("one.c")).unwrap();
    let literals: Vec<String> = points.iter().map(|x| format!("{x:?}")).collect();
    let array = format!("one_start[] = {{\n    {}\n}};", literals.join(", "));
    assert!(text.contains(&array), "{text}");
    assert!(text.contains("one_start_input = 61.0;"), "{text}");
}

/// The test of the tests: a digit that differs is noticed.
#[test]
fn another_digit_is_noticed() {
    let case = every();
    let (commands, expected) = script::<f64>(0, &case, &[Call::Step(1.0, 1.0), Call::Save]);
    let moved = expected.replacen("v 0", "v 1", 1);
    let noticed = std::panic::catch_unwind(|| same(&commands, &expected, &moved, "moved"));
    assert!(noticed.is_err());
    assert_eq!(1.0f32.hex(), "3f800000");
}
