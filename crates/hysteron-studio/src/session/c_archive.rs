//! What stands beside the exported C in its archive: a program that shows its use, how to build it,
//! and what the files are.

use hysteron::{Model, Quantity};
use hysteron_export::CExport;
use std::fmt::Write;

/// The files to put beside those of an export, as names and texts.
pub(super) fn beside(
    model: &Model,
    made: &CExport,
    files: &[(String, String)],
) -> [(String, String); 3] {
    [
        ("README.txt".into(), readme(model, made, files)),
        ("main.c".into(), program(made, files)),
        ("Makefile".into(), makefile(files)),
    ]
}

/// A name from a file, as plain text in C and on one line.
fn plain(quantity: &Quantity) -> String {
    let text = quantity.to_column();
    let safe = |c: char| {
        if c.is_ascii_graphic() && c != '\\' {
            c
        } else {
            ' '
        }
    };
    text.chars()
        .map(safe)
        .collect::<String>()
        .replace("*/", "* /")
}

fn makefile(files: &[(String, String)]) -> String {
    let sources = files.iter().filter_map(|(name, _)| name.strip_suffix(".c"));
    let objects: String = sources.map(|name| format!(" {name}.o")).collect();
    format!(
        "CFLAGS ?= -O2 -Wall -Wextra\nCFLAGS += -std=c99 -ffp-contract=off\n\n\
         demo: main.o{objects}\n\t$(CC) $(LDFLAGS) -o $@ $^\n\n\
         clean:\n\trm -f demo *.o\n\n.PHONY: clean\n"
    )
}

fn readme(model: &Model, made: &CExport, files: &[(String, String)]) -> String {
    let CExport { name, memory, .. } = made;
    let mut text = format!(
        "The model in C99, for a microcontroller: no heap, no library, no global variables.\n\n\
         \x20   make && printf '20\\n60\\n20\\n' | ./demo\n\n\
         reads inputs from standard input, one a line, and prints each with the output of the\n\
         model{}.\n\
         On a target, compile all files but main.c, and do what main.c does.\n\n\
         Input: {}\nOutput: {}\n",
        match made.inverse {
            true => ", and with the input that its inverse finds for that output",
            false => "",
        },
        plain(&model.input),
        plain(&model.output),
    );
    if let Some(dt) = made.dt {
        let _ = writeln!(text, "Sample time: {dt} s. Each call is one such step.");
    }
    if let Some(load) = &model.load {
        let _ = writeln!(
            text,
            "Load: {}, the second number of a line.",
            plain(&load.quantity)
        );
    }
    let _ = write!(
        text,
        "Memory on a 32-bit target: {} bytes of constants, {} bytes for each state.\n\nFiles:\n",
        memory.constants,
        memory.state + memory.turns
    );
    for (file, _) in files {
        let what = match file.strip_prefix(name.as_str()) {
            Some(".c" | ".h") => "the model",
            _ => "the algorithm, the same for every model",
        };
        let _ = writeln!(text, "  {file}: {what}");
    }
    text + "  main.c, Makefile: a program that shows the use\n\n\
            Compile without -ffast-math: sums have to keep their order.\n"
}

/// The program: forward, and the way back where there is an inverse.
fn program(made: &CExport, files: &[(String, String)]) -> String {
    let name = &made.name;
    let shout = name.to_uppercase();
    let header = files.iter().find(|(file, _)| *file == format!("{name}.h"));
    let has = |what: &str| header.is_some_and(|(_, text)| text.contains(what));
    let is_staged = !made.stages.is_empty() || has("hys_actuator");
    let mixed = has(&format!("{shout}_TABLE"));
    let (state, step, back) = match is_staged {
        true => (
            "hys_actuator_state",
            "hys_actuator_step",
            "hys_actuator_inverse_step",
        ),
        false => ("hys_state", "hys_step", "hys_inverse_step"),
    };
    let load = if is_staged { "load, " } else { "" };
    let memory = |n: usize| match mixed {
        true => format!(", &mixed[{n}], table[{n}], {shout}_TABLE"),
        false => String::new(),
    };
    let start = |which: &str, n: usize| {
        let function = match (is_staged, mixed) {
            (false, _) => "hys_start",
            (true, false) => "hys_actuator_start",
            (true, true) => "hys_actuator_start_mixed",
        };
        let more = memory(n);
        let begun =
            format!("    check({function}(&{name}, &{which}, turns[{n}], {shout}_TURNS{more}));\n");
        match has(&format!("{name}_start_input")) {
            true => {
                let count = format!("sizeof {name}_start / sizeof {name}_start[0]");
                let restore = format!(
                    "    check(hys_restore(&{which}, {name}_start, {count}, {name}_start_input));\n"
                );
                begun + &restore
            }
            false => begun,
        }
    };
    let mut text = format!(
        "/* Inputs from standard input, one a line{}; the output of the model for each{}. */\n\
         #include \"{name}.h\"\n\n#include <stdio.h>\n#include <stdlib.h>\n\n\
         static void check(int code) {{\n    if (code != HYS_OK) {{\n        \
         fprintf(stderr, \"error %d, see hysteron_mcu.h\\n\", code);\n        \
         exit(EXIT_FAILURE);\n    }}\n}}\n\nint main(void) {{\n",
        if is_staged {
            ", each with a load behind it if it has one"
        } else {
            ""
        },
        if made.inverse {
            ", and the input that gives it"
        } else {
            ""
        },
    );
    let states = if made.inverse { 2 } else { 1 };
    let backward = if made.inverse { ", backward" } else { "" };
    let _ = writeln!(text, "    static hys_turn turns[{states}][{shout}_TURNS];");
    if mixed {
        let _ = writeln!(text, "    static hys_mixed mixed[{states}];");
        let _ = writeln!(text, "    static hys_real table[{states}][{shout}_TABLE];");
    }
    let _ = write!(
        text,
        "    {state} forward{backward};\n    char line[128];\n{}",
        start("forward", 0)
    );
    if made.inverse {
        text += &start("backward", 1);
    }
    text += "    while (fgets(line, sizeof line, stdin)) {\n        char *end;\n        \
             const hys_real input = (hys_real)strtod(line, &end);\n        hys_real output;\n";
    if made.inverse {
        text += "        hys_real found;\n        int status;\n";
    }
    if is_staged {
        text += "        const hys_real load = (hys_real)strtod(end, NULL);\n";
    }
    text += "        if (end == line) {\n            continue;\n        }\n";
    let _ = writeln!(
        text,
        "        check({step}(&forward, input, {load}&output));"
    );
    text += &match made.inverse {
        true => format!(
            "        /* HYS_HOLD: the input stands still while the output does. */\n        \
             check({back}(&backward, output, HYS_HOLD, 0, {load}&found, &status));\n        \
             printf(\"%g %g %g\\n\", (double)input, (double)output, (double)found);\n"
        ),
        false => "        printf(\"%g %g\\n\", (double)input, (double)output);\n".to_owned(),
    };
    text + "    }\n    return 0;\n}\n"
}
