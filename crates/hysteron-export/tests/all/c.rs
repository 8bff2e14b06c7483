//! The exported C gives the core's digits, bit for bit, whatever the compiler and its optimisation.

use crate::common::programs::{has, links, run, skip};
use crate::common::reference::{Call, Number, script};
use crate::common::{Exported, REALS, answers, same, walks};
use hysteron::{Model, Operator, Plane, Sign};
use hysteron_core::operator_count;
use hysteron_export::CReal;
use std::process::Command;

/// Runs calls on each of the models in C, in one program, and in the core.
fn compare(exported: &Exported, program: &mut Command, cases: &[(&Model, Vec<Call>)], what: &str) {
    let (mut commands, mut expected) = (String::new(), String::new());
    for (n, (model, calls)) in cases.iter().enumerate() {
        let (lines, answers) = match exported.real {
            CReal::Float => script::<f32>(n, model, calls),
            CReal::Double => script::<f64>(n, model, calls),
        };
        commands += &lines;
        expected += &answers;
    }
    let found = answers(program, &commands);
    same(&commands, &expected, &found, what);
}

/// Compilers that are there, with flags under which the header promises the digits.
fn compilers() -> Vec<(&'static str, Vec<&'static str>)> {
    let mut found = Vec::new();
    // What a compiler may be told of fused products without other digits: the source forbids them.
    // GCC heeds that under every flag, Clang under all but `fast`, which the header excludes.
    for (cc, most) in [("gcc", "-ffp-contract=fast"), ("clang", "-ffp-contract=on")] {
        if !has(cc) {
            continue;
        }
        for level in ["-O0", "-O2", "-Os", "-O3"] {
            found.push((cc, vec![level, "-ffp-contract=off"]));
        }
        found.push((cc, vec!["-O2", "-march=native"]));
        found.push((cc, vec!["-O2", "-march=native", most]));
        // Only x86 has two kinds of arithmetic to choose from.
        let narrow = ["-m32", "-msse2", "-mfpmath=sse", "-O2"];
        if cfg!(target_arch = "x86_64")
            && (links(cc, &narrow) || skip("there is no C library of 32 bits (gcc-multilib)"))
        {
            found.push((cc, narrow.to_vec()));
        }
    }
    found
}

/// Models from small to large, of each operator.
fn zoo(seed: u64) -> Vec<Model> {
    let mut rng = walks::rng(seed);
    let levels = [2, 2, 3, 4, 5, 8, 13, 20, 33, 60];
    let each = levels
        .iter()
        .flat_map(|&k| walks::OPERATORS.map(|operator| (k, operator)));
    each.map(|(k, operator)| walks::model(&mut rng, operator, k))
        .collect()
}

fn fuzz(models: &[Model], seed: u64, count: usize) -> Vec<(&Model, Vec<Call>)> {
    let mut rng = walks::rng(seed);
    let each = models.iter();
    each.map(|model| (model, walks::calls(&mut rng, model, count)))
        .collect()
}

#[test]
fn random_and_adversarial_calls_have_the_same_digits() {
    if !has("cc") {
        return;
    }
    for seed in 0..4 {
        let models = zoo(seed);
        let cases = fuzz(&models, 100 + seed, 4000);
        for real in REALS {
            let exported = Exported::new(&models.iter().collect::<Vec<_>>(), real);
            // No loop has more iterations than the header says.
            exported.count_iterations();
            let program = exported.compile("cc", &["-O2"], "driver.c");
            compare(
                &exported,
                &mut Command::new(program),
                &cases,
                &format!("seed {seed}, {}", real.name()),
            );
        }
    }
}

#[test]
fn compilers_and_optimisation_change_no_digit() {
    let models = zoo(9);
    let cases = fuzz(&models, 9, 600);
    for real in REALS {
        let exported = Exported::new(&models.iter().collect::<Vec<_>>(), real);
        for (cc, flags) in compilers() {
            let program = exported.compile(cc, &flags, "driver.c");
            let what = format!("{cc} {flags:?}, {}", real.name());
            compare(&exported, &mut Command::new(program), &cases, &what);
        }
    }
}

/// Two models, the second with weights below zero.
fn pair() -> [Model; 2] {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    let weights = vec![1.0; operator_count(5)];
    let model =
        |weights: Vec<f64>| Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive).unwrap();
    [
        model(weights.clone()),
        model(weights.iter().map(|mu| -mu).collect()),
    ]
}

#[test]
fn misuse_is_refused() {
    if !has("cc") {
        return;
    }
    let [one, other] = pair();
    for real in REALS {
        let exported = Exported::new(&[&one, &other], real);
        run(&mut Command::new(exported.compile(
            "cc",
            &["-O2"],
            "misuse.c",
        )));
    }
}

#[test]
fn sanitizers_find_nothing() {
    const SANITIZE: [&str; 4] = [
        "-O1",
        "-fsanitize=address,undefined",
        "-fno-sanitize-recover=all",
        "-fno-omit-frame-pointer",
    ];
    let extra = ["-fsanitize=float-cast-overflow"];
    if !has("cc") || !(links("cc", &SANITIZE) || skip("`cc` has no sanitizers")) {
        return;
    }
    let flags: Vec<&str> = SANITIZE.into_iter().chain(extra).collect();
    let models = zoo(5);
    let cases = fuzz(&models, 5, 600);
    let [one, other] = pair();
    for real in REALS {
        let exported = Exported::new(&models.iter().collect::<Vec<_>>(), real);
        let program = exported.compile("cc", &flags, "driver.c");
        compare(&exported, &mut Command::new(program), &cases, "sanitized");
        let exported = Exported::new(&[&one, &other], real);
        run(&mut Command::new(
            exported.compile("cc", &flags, "misuse.c"),
        ));
    }
}

#[test]
fn valgrind_finds_nothing() {
    if !has("cc") || !has("valgrind") {
        return;
    }
    let models = zoo(6);
    let cases = fuzz(&models, 6, 60);
    let [one, other] = pair();
    let valgrind = |program| {
        let mut command = Command::new("valgrind");
        command
            .args(["--quiet", "--error-exitcode=9", "--leak-check=full"])
            .arg(program);
        command
    };
    for real in REALS {
        let exported = Exported::new(&models.iter().collect::<Vec<_>>(), real);
        let program = exported.compile("cc", &["-O2"], "driver.c");
        compare(&exported, &mut valgrind(program), &cases, "valgrind");
        let exported = Exported::new(&[&one, &other], real);
        run(&mut valgrind(exported.compile("cc", &["-O2"], "misuse.c")));
    }
}

/// What the compiler tells of arithmetic that gives other digits ends the compilation.
#[test]
fn other_arithmetic_is_refused() {
    if !has("gcc") {
        return;
    }
    let [one, _] = pair();
    let exported = Exported::new(&[&one], CReal::Float);
    for flag in ["-ffast-math", "-ffinite-math-only", "-mfpmath=387"] {
        let done = Command::new("gcc")
            .args(["-std=c99", flag, "-c", "hysteron_mcu.c"])
            .current_dir(exported.folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        // The last one is known to x86 alone.
        assert!(
            !done.status.success()
                && (said.contains("hysteron_mcu: ") || flag.starts_with("-mfpmath")),
            "{flag}: {said}"
        );
    }
}

/// Nothing but the C is asked of a target.
#[test]
fn the_algorithm_needs_no_library() {
    if !has("cc") || !has("nm") {
        return;
    }
    let [one, _] = pair();
    for real in REALS {
        let exported = Exported::learning(&[&one], real);
        for level in ["-O0", "-O2", "-Os", "-O3"] {
            let objects = [
                "hysteron_mcu.o",
                "hysteron_mcu_inverse.o",
                "hysteron_mcu_adapt.o",
                "m0.o",
            ];
            for object in objects {
                run(Command::new("cc")
                    .args(["-std=c99", "-ffreestanding", level, "-c"])
                    .arg(object.replace(".o", ".c"))
                    .current_dir(exported.folder.path()));
            }
            run(Command::new("ld")
                .args(["-r", "-o", "all.o"])
                .args(objects)
                .current_dir(exported.folder.path()));
            let symbols = Command::new("nm")
                .args(["-u", "all.o"])
                .current_dir(exported.folder.path())
                .output()
                .unwrap();
            let symbols = String::from_utf8(symbols.stdout).unwrap();
            let wanted: Vec<&str> = symbols
                .lines()
                .filter(|line| line.contains(" U "))
                .collect();
            assert!(wanted.is_empty(), "{level}: {wanted:?}");
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
    for real in REALS {
        let folder = tempfile::tempdir().unwrap();
        let [one, _] = pair();
        let options = hysteron_export::COptions {
            real,
            name: Some("one"),
            source: std::path::Path::new("one.json"),
            adaptation: true,
        };
        let memory = hysteron_export::c(&one, folder.path(), &options)
            .unwrap()
            .memory;
        let text = format!(
            "#include \"one.c\"\n#include \"hysteron_mcu_adapt.h\"\n\
             typedef char constants[sizeof(hys_model) + sizeof table + sizeof one_weights + \
             sizeof drift_tables + sizeof drift_coefficients + sizeof(hys_adapt_basis) + \
             3 * sizeof(hys_adapt_options) == {} ? 1 : -1];\n\
             typedef char adapt[sizeof(hys_adaptive) + ONE_INCREMENTS_NUMBERS * sizeof(hys_real) == {} \
             ? 1 : -1];\n\
             typedef char state[sizeof(hys_state) == {} ? 1 : -1];\n\
             typedef char turns[ONE_TURNS * sizeof(hys_turn) == {} ? 1 : -1];\n",
            memory.constants,
            memory.adaptation.unwrap() + memory.state,
            memory.state,
            memory.turns
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

/// The test of the tests: a digit that differs is noticed.
#[test]
fn another_digit_is_noticed() {
    let [one, _] = pair();
    let calls = [Call::Step(50.0), Call::Step(31.0)];
    let (commands, expected) = script::<f32>(0, &one, &calls);
    let moved = expected.replacen('4', "5", 1);
    let noticed = std::panic::catch_unwind(|| same(&commands, &expected, &moved, "moved"));
    assert!(noticed.is_err());
    assert_eq!(1.0f32.hex(), "3f800000");
}
