//! What is written beside the C builds it: with make and with CMake, for other processors too, on
//! which the digits are those of this machine.

use crate::common::here;
use crate::common::programs::{has, run};
use hysteron::control::{Gains, Scheme};
use hysteron::{Delay, FirstOrder, Model, Operator, Plane, Sign};
use hysteron_core::operator_count;
use hysteron_export::{COptions, CReal, CSampling, c, c_controlled};
use std::path::Path;
use std::process::{Command, Output};

/// A target of `NAME.mk`: its compiler, its flags, and what runs its programs here.
struct Target {
    name: &'static str,
    prefix: &'static str,
    flags: &'static [&'static str],
    emulator: &'static str,
}

const TARGETS: [Target; 4] = [
    Target {
        name: "cortex-m0plus",
        prefix: "arm-none-eabi-",
        flags: &["-mcpu=cortex-m0plus", "-mthumb"],
        emulator: "qemu-arm-static",
    },
    Target {
        name: "cortex-m4f",
        prefix: "arm-none-eabi-",
        flags: &[
            "-mcpu=cortex-m4",
            "-mthumb",
            "-mfpu=fpv4-sp-d16",
            "-mfloat-abi=hard",
        ],
        emulator: "qemu-arm-static",
    },
    Target {
        name: "rv32imac",
        prefix: "riscv64-unknown-elf-",
        flags: &["-march=rv32imac", "-mabi=ilp32"],
        emulator: "qemu-riscv32-static",
    },
    Target {
        name: "rv32imafc",
        prefix: "riscv64-unknown-elf-",
        flags: &["-march=rv32imafc", "-mabi=ilp32f"],
        emulator: "qemu-riscv32-static",
    },
];

/// One model that learns and has a dead time, and one with a body and a controller: all files there
/// are.
fn export(folder: &Path, real: CReal) {
    let plane = Plane::new(0.0, 1.0, 12).unwrap();
    let count = operator_count(12);
    let weights = (0..count).map(|n| 16.0 / count as f64 * ((n * 7) % 11) as f64 / 11.0);
    let plain = Model::new(Operator::Mkp, plane, weights.collect(), 1.0, Sign::Positive).unwrap();
    let mut body = plain.clone();
    body.thermal = Some(FirstOrder {
        tau_heating: 2.0,
        tau_cooling: 4.0,
        ..FirstOrder::default()
    });
    let late = plain.with_delay(Delay::new(3, 0.05).unwrap());
    let named = |name, adaptation| COptions {
        real,
        name: Some(name),
        source: Path::new("some.json"),
        adaptation,
    };
    let sampling = CSampling {
        dt: Some(0.05),
        drive: Some((0.0, 1.0)),
        ..CSampling::default()
    };
    let gains = Gains {
        gain: 0.05,
        integral_s: 0.5,
        derivative_s: 0.0,
    };
    let scheme = Scheme {
        pid: Some(gains),
        ..Scheme::new(0.05, (0.0, 1.0))
    };
    c(&late, folder, &named("learns", true)).unwrap();
    c_controlled(&body, folder, &named("holds", false), &sampling, &scheme).unwrap();
}

const MODELS: [&str; 2] = ["learns", "holds"];

fn output(command: &mut Command) -> Output {
    command.output().unwrap()
}

/// The program `bare.c` with a model's library, and nothing else.
fn link(folder: &Path, prefix: &str, flags: &[&str], (name, target): (&str, &str)) {
    let mut command = Command::new(format!("{prefix}gcc"));
    command.args([
        "-std=gnu99",
        "-O2",
        "-ffreestanding",
        "-nostdlib",
        "-static",
        "-Wall",
        "-Werror",
    ]);
    if name == "holds" {
        command.arg("-DSTAGED");
    }
    command
        .args(flags)
        .arg(format!("-DMODEL_HEADER=\"{name}.h\""))
        .args([&format!("-DMODEL={name}"), "-DTURNS=56", "-I."])
        .arg(here("tests/mcu/bare.c"))
        .arg(format!("build/{target}/libhysteron_{name}.a"))
        .args(["-lgcc", "-o", &format!("{name}-{target}")])
        .current_dir(folder);
    run(&mut command);
}

fn make(folder: &Path, name: &str, more: &[&str]) -> Command {
    let mut command = Command::new("make");
    command
        .args(["-s", "-f", &format!("{name}.mk")])
        .args(more)
        .current_dir(folder);
    command
}

#[test]
fn other_processors_give_the_digits_of_this_machine() {
    if !has("make") || !has("gcc") {
        return;
    }
    for real in [CReal::Float, CReal::Double] {
        let folder = tempfile::tempdir().unwrap();
        export(folder.path(), real);
        for name in MODELS {
            run(&mut make(folder.path(), name, &[]));
        }
        let host = |name| {
            link(folder.path(), "", &[], (name, "host"));
            output(&mut Command::new(
                folder.path().join(format!("{name}-host")),
            ))
            .stdout
        };
        let here = MODELS.map(|name| (name, host(name)));
        assert!(here.iter().all(|(_, digits)| digits.len() == 9), "{here:?}");
        assert_ne!(here[0].1, here[1].1);
        for target in &TARGETS {
            if !has(&format!("{}gcc", target.prefix)) {
                continue;
            }
            for name in MODELS {
                let wanted = format!("HYS_TARGET={}", target.name);
                run(&mut make(folder.path(), name, &[&wanted]));
            }
            for (name, digits) in &here {
                link(
                    folder.path(),
                    target.prefix,
                    target.flags,
                    (name, target.name),
                );
                if !has(target.emulator) {
                    continue;
                }
                let program = folder.path().join(format!("{name}-{}", target.name));
                let there = output(Command::new(target.emulator).arg(program));
                assert_eq!(&there.stdout, digits, "{name}, {}: {there:?}", target.name);
            }
        }
    }
}

#[test]
fn make_takes_other_processors_and_says_what_it_knows() {
    if !has("make") || !has("gcc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), CReal::Float);
    let done = output(&mut make(
        folder.path(),
        "learns",
        &["HYS_TARGET=cortex-m99"],
    ));
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(
        !done.status.success() && said.contains("cortex-m4f") && said.contains("HYS_CPU"),
        "{said}"
    );
    let mine = ["HYS_TARGET=mine", "HYS_PREFIX=", "HYS_CPU=-O1"];
    run(&mut make(folder.path(), "learns", &mine));
    assert!(
        folder
            .path()
            .join("build/mine/libhysteron_learns.a")
            .exists()
    );
    // From another folder, two models in one Makefile.
    let outer = tempfile::tempdir().unwrap();
    let mcu = folder.path().display();
    let text = format!(
        "all: libraries\ninclude {mcu}/learns.mk\ninclude {mcu}/holds.mk\n\
         libraries: $(learns_library) $(holds_library)\n\t@echo $^\n"
    );
    std::fs::write(outer.path().join("Makefile"), text).unwrap();
    let done = output(Command::new("make").current_dir(outer.path()));
    assert!(done.status.success() && done.stderr.is_empty(), "{done:?}");
    let said = String::from_utf8(done.stdout).unwrap();
    let wanted = "build/host/libhysteron_learns.a build/host/libhysteron_holds.a";
    assert_eq!(said.lines().last(), Some(wanted));
}

/// The project of the page that builds for Zephyr, with its package in place of Zephyr's.
#[test]
fn cmake_builds_it_for_a_project() {
    if !has("cmake") || !has("make") || !has("gcc") {
        return;
    }
    let page = std::fs::read_to_string(here("../../docs/microcontroller.md")).unwrap();
    let project = page.split("```cmake\n").nth(1).unwrap();
    let project = project.split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    export(&path.join("mcu"), CReal::Float);
    let write = |name: &str, text: &str| {
        std::fs::create_dir_all(path.join(name).parent().unwrap()).unwrap();
        std::fs::write(path.join(name), text).unwrap();
    };
    write("CMakeLists.txt", &project.replace("wire", "holds"));
    let zephyr = "enable_language(C)\nadd_library(zephyr_interface INTERFACE)\n\
                  target_compile_definitions(zephyr_interface INTERFACE FROM_ZEPHYR)\n\
                  add_library(app STATIC)\n";
    write("zephyr/ZephyrConfig.cmake", zephyr);
    write(
        "src/main.c",
        "#include <holds.h>\nconst void *model(void) { return &holds; }\n",
    );
    let mut compilers = vec![("host", "", vec![])];
    for target in &TARGETS {
        let flags = format!("-DCMAKE_C_FLAGS={} -ffreestanding", target.flags.join(" "));
        let more = ["-DCMAKE_SYSTEM_NAME=Generic".into(), flags];
        compilers.push((target.name, target.prefix, more.to_vec()));
    }
    for (name, prefix, more) in compilers {
        let gcc = format!("{prefix}gcc");
        if !has(&gcc) {
            continue;
        }
        let build = format!("out-{name}");
        let words = "-S . -DZephyr_DIR=zephyr -DCMAKE_BUILD_TYPE=Release \
                     -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY -DCMAKE_EXPORT_COMPILE_COMMANDS=ON";
        run(Command::new("cmake")
            .args(words.split_whitespace())
            .args(["-B", &build])
            .arg(format!("-DCMAKE_C_COMPILER={gcc}"))
            .args(more)
            .current_dir(path));
        run(Command::new("cmake")
            .args(["--build", &build])
            .current_dir(path));
        let commands = std::fs::read_to_string(path.join(&build).join("compile_commands.json"));
        let commands: serde_json::Value = serde_json::from_str(&commands.unwrap()).unwrap();
        let ours = commands.as_array().unwrap().iter();
        let ours: Vec<&str> = ours
            .filter(|one| one["file"].as_str().unwrap().contains("hysteron_mcu"))
            .map(|one| one["command"].as_str().unwrap())
            .collect();
        // Zephyr's flags come to them, and theirs do not go to the rest.
        assert!(ours.len() >= 4, "{ours:?}");
        for flag in ["-ffp-contract=off", "-DFROM_ZEPHYR"] {
            assert!(
                ours.iter().all(|command| command.contains(flag)),
                "{flag}: {ours:?}"
            );
        }
    }
}
