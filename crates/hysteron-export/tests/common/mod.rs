//! Models exported, compiled and run.
#![allow(clippy::unwrap_used)]

pub mod programs;
pub mod reference;
pub mod staged;
pub mod walks;

use hysteron::Model;
use hysteron_core::{table_len, turn_capacity};
use hysteron_export::{COptions, CReal, CSampling};
use programs::run;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a strict project compiles with.
pub const STRICT: [&str; 8] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Werror",
    "-g",
];

pub const REALS: [CReal; 2] = [CReal::Float, CReal::Double];

pub fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Models in one folder, ready to be compiled into one program.
pub struct Exported {
    pub folder: tempfile::TempDir,
    pub real: CReal,
    sources: Vec<PathBuf>,
}

impl Exported {
    /// Exports `models` as m0, m1, … with a header that lists them.
    pub fn new(models: &[&Model], real: CReal) -> Self {
        Self::with(models, real, false)
    }

    /// The same for models that learn.
    pub fn learning(models: &[&Model], real: CReal) -> Self {
        Self::with(models, real, true)
    }

    fn with(models: &[&Model], real: CReal, adaptation: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let algorithm = ["hysteron_mcu.c", "hysteron_mcu_inverse.c"];
        let mut sources: Vec<PathBuf> = algorithm.map(|name| folder.path().join(name)).into();
        if adaptation {
            sources.push(folder.path().join("hysteron_mcu_adapt.c"));
        }
        let (mut includes, mut list, mut weights) = (String::new(), String::new(), String::new());
        let mut largest = 0;
        for (n, model) in models.iter().enumerate() {
            let name = format!("m{n}");
            let options = COptions {
                real,
                name: Some(&name),
                source: Path::new("some model.json"),
                adaptation,
            };
            hysteron_export::c(model, folder.path(), &options).unwrap();
            sources.push(folder.path().join(format!("{name}.c")));
            writeln!(includes, "#include \"{name}.h\"").unwrap();
            write!(list, "&{name}, ").unwrap();
            write!(weights, "{name}_weights, ").unwrap();
            largest = largest.max(model.plane().levels());
        }
        let mut text = format!(
            "{includes}#define MOST_TURNS {}\n\
             static const hys_model *const models[] = {{{list}}};\n",
            turn_capacity(largest)
        );
        if adaptation {
            let each = |item: &dyn Fn(&str) -> String| -> String {
                let rows = (0..models.len()).map(|n| {
                    let names = ["increments", "least_squares", "drift"];
                    let cells = names.map(|name| item(&format!("m{n}_{name}")));
                    format!("{{{}}}, ", cells.join(", "))
                });
                rows.collect()
            };
            let upper = |name: &str| name.to_uppercase() + "_NUMBERS";
            writeln!(
                text,
                "static const hys_real *const weights[] = {{{weights}}};\n\
                 static const hys_adapt_options *const defaults[][3] = {{{}}};\n\
                 static const size_t needed[][3] = {{{}}};\n\
                 typedef union {{ hys_real {}last; }} most;\n\
                 #define MOST_NUMBERS (sizeof(most) / sizeof(hys_real))",
                each(&|name| format!("&{name}")),
                each(&upper),
                (0..models.len())
                    .map(|n| format!("m{n}[{}], ", upper(&format!("m{n}_least_squares"))))
                    .collect::<String>(),
            )
            .unwrap();
        }
        std::fs::write(folder.path().join("models.h"), text).unwrap();
        Self {
            folder,
            real,
            sources,
        }
    }

    /// Exports models with stages.
    pub fn staged(models: &[(&Model, CSampling)], real: CReal) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut sources: Vec<PathBuf> = Vec::new();
        let (mut includes, mut list) = (String::new(), String::new());
        let mut largest = 0;
        for (n, (model, sampling)) in models.iter().enumerate() {
            let name = format!("m{n}");
            let options = COptions {
                real,
                name: Some(&name),
                source: Path::new("some model.json"),
                adaptation: false,
            };
            let made = hysteron_export::c_sampled(model, folder.path(), &options, sampling);
            let files = made.unwrap().files.into_iter();
            sources.extend(files.filter(|file| file.extension().is_some_and(|end| end == "c")));
            writeln!(includes, "#include \"{name}.h\"").unwrap();
            write!(list, "&{name}, ").unwrap();
            largest = largest.max(model.plane().levels());
        }
        sources.sort();
        sources.dedup();
        let text = format!(
            "{includes}#define MOST_TURNS {}\n#define MOST_TABLE {}\n\
             static const hys_actuator *const models[] = {{{list}}};\n",
            turn_capacity(largest),
            table_len(largest)
        );
        std::fs::write(folder.path().join("models.h"), text).unwrap();
        Self {
            folder,
            real,
            sources,
        }
    }

    /// Models that were exported in another way.
    pub fn of(folder: tempfile::TempDir, real: CReal, sources: Vec<PathBuf>) -> Self {
        Self {
            folder,
            real,
            sources,
        }
    }

    /// Compiles them with `main`, a file of tests/mcu.
    pub fn compile(&self, cc: &str, flags: &[&str], main: &str) -> PathBuf {
        let program = self
            .folder
            .path()
            .join(format!("{main}.{cc}{}", flags.concat()));
        let is_algorithm = |file: &&PathBuf| {
            let name = file.file_name().unwrap().to_string_lossy();
            name.starts_with("hysteron_mcu")
        };
        let (algorithm, models): (Vec<&PathBuf>, _) = self.sources.iter().partition(is_algorithm);
        run(self
            .compiler(cc, flags)
            .arg(here("tests/mcu").join(main))
            .args(algorithm)
            .args(self.compiled(cc, flags, models))
            .arg("-o")
            .arg(&program));
        program
    }

    /// The files of the models hold constants alone, which are the same whatever is optimised: they
    /// are compiled once for each compiler and width of a pointer. A sanitizer watches their edges.
    fn compiled(&self, cc: &str, flags: &[&str], models: Vec<&PathBuf>) -> Vec<PathBuf> {
        if flags.iter().any(|flag| flag.starts_with("-fsanitize")) {
            return models.into_iter().cloned().collect();
        }
        let narrow: Vec<&str> = flags
            .iter()
            .copied()
            .filter(|flag| *flag == "-m32")
            .collect();
        let folder = self.folder.path().join(format!("{cc}{}", narrow.concat()));
        if !folder.exists() {
            std::fs::create_dir(&folder).unwrap();
            let mut compiler = self.compiler(cc, &narrow);
            run(compiler.arg("-c").args(&models).current_dir(&folder));
        }
        let object = |file: &PathBuf| folder.join(file.with_extension("o").file_name().unwrap());
        models.into_iter().map(object).collect()
    }

    fn compiler(&self, cc: &str, flags: &[&str]) -> Command {
        let mut command = Command::new(cc);
        command.args(STRICT).args(flags);
        if self.real == CReal::Float {
            command.arg("-Wdouble-promotion");
        }
        command.arg("-I").arg(self.folder.path());
        command
    }

    /// Makes the algorithm end the program where a loop has more iterations than the header says.
    pub fn count_iterations(&self) {
        self.edit("hysteron_mcu.c", |text| {
            let (travel, step) = (
                "static void travel(hys_state *state, hys_real x)\n{",
                "leave(state, rising, x);",
            );
            let limit = "if (++passed > 2 * state->model->levels + 3) { abort(); }";
            assert_eq!(text.matches(step).count(), 1);
            // The corners that one call of `leave` wipes out count as well.
            let corner = "do { /*";
            assert_eq!(text.matches(corner).count(), 1);
            let counted = format!("static size_t passed; {travel} passed = 0;");
            text.replace(step, &format!("{limit} {step}"))
                .replace(travel, &counted)
                .replace(
                    "static void leave(",
                    "static size_t passed; static void leave(",
                )
                .replace(corner, &format!("passed--; do {{ {limit} /*"))
        });
        self.edit("hysteron_mcu_inverse.c", |mut text| {
            let bisection = "size_t middle = low + (high - low) / 2u;";
            assert_eq!(text.matches(bisection).count(), 3);
            for (at, limit) in [
                (
                    "branch find(const hys_state *state, size_t kind, goal to)\n{",
                    "log2_of(2 * state->model->levels + 1) + 1",
                ),
                (
                    "hys_real min_x, hys_real from, goal to)\n{",
                    "log2_of(model->levels) + 1",
                ),
                (
                    "hys_real max_x, hys_real from, goal to)\n{",
                    "log2_of(model->levels) + 1",
                ),
            ] {
                let (before, after) = text.split_once(at).unwrap();
                let counted = format!("{bisection} if (++halved > {limit}) {{ abort(); }}");
                let after = after.replacen(bisection, &counted, 1);
                text = format!("{before}{at} size_t halved = 0;{after}");
            }
            let log2 = "static size_t log2_of(size_t n)\n\
                        { size_t k = 0; while (n > 1) { n /= 2; k++; } return k; }";
            format!("{log2}\n{text}")
        });
    }

    fn edit(&self, file: &str, change: impl FnOnce(String) -> String) {
        let path = self.folder.path().join(file);
        let text = change(std::fs::read_to_string(&path).unwrap());
        std::fs::write(path, format!("#include <stdlib.h>\n{text}")).unwrap();
    }
}

/// What the program prints for the commands.
pub fn answers(program: &mut Command, commands: &str) -> String {
    let mut child = program
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let commands = commands.to_owned();
    let writer = std::thread::spawn(move || stdin.write_all(commands.as_bytes()));
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success(),
        "{:?}: {}\n{text}",
        program,
        output.status
    );
    writer.join().unwrap().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// Fails at the first line that differs.
pub fn same(commands: &str, expected: &str, found: &str, what: &str) {
    if expected == found {
        return;
    }
    let lines = commands.lines().zip(expected.lines()).zip(found.lines());
    for (n, ((command, expected), found)) in lines.enumerate() {
        assert_eq!(expected, found, "{what}, line {}: {command}", n + 1);
    }
    assert_eq!(
        expected.lines().count(),
        found.lines().count(),
        "{what}: lines"
    );
    assert_eq!(expected, found, "{what}");
}
