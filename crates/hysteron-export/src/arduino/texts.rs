//! The files of a library that are not C.

use crate::c::CExport;
use hysteron::Model;
use std::path::PathBuf;

const DEVICE: &str = include_str!("../../arduino/device.ino");
const STANDALONE: &str = include_str!("../../arduino/standalone.ino");

/// What the editor colours.
const TYPES: [&str; 7] = [
    "hys_real",
    "hys_turn",
    "hys_state",
    "hys_actuator_state",
    "hys_control",
    "hys_controller",
    "hys_action",
];
const FUNCTIONS: [&str; 9] = [
    "hys_start",
    "hys_step",
    "hys_inverse_step",
    "hys_actuator_start",
    "hys_actuator_step",
    "hys_actuator_inverse_step",
    "hys_controller_start",
    "hys_controller_go_on_from",
    "hys_controller_step",
];
const LITERALS: [&str; 6] = [
    "HYS_OK",
    "HYS_HOLD",
    "HYS_RISING",
    "HYS_FALLING",
    "HYS_REACHED",
    "HYS_SAFE",
];

/// Names and texts.
pub(super) fn files(model: &Model, export: &CExport, follows: bool) -> Vec<(PathBuf, String)> {
    let name = &export.name;
    let version = env!("CARGO_PKG_VERSION");
    let sentence = format!(
        "A hysteresis model with its inverse and a controller, K = {}.",
        export.levels
    );
    let url = env!("CARGO_PKG_REPOSITORY");
    let properties = format!(
        "name={name}\nversion={version}\nauthor=hysteron\nmaintainer=hysteron\n\
         sentence={sentence}\nparagraph=Written by `hysteron export arduino`.\n\
         category=Device Control\nurl={url}\narchitectures=*\nincludes={name}.h\n"
    );
    let json = format!(
        "{{\n  \"name\": \"{name}\",\n  \"version\": \"{version}\",\n  \"description\": \
         \"{sentence}\",\n  \"keywords\": \"hysteresis, control\",\n  \"repository\": {{\"type\": \
         \"git\", \"url\": \"{url}\"}},\n  \"headers\": \"{name}.h\",\n  \"frameworks\": \
         \"arduino\",\n  \"platforms\": \"*\"\n}}\n"
    );
    let mut keywords = String::new();
    let model_words = [
        format!("{name}\tLITERAL1\n"),
        format!("{name}_control\tLITERAL1\n"),
    ];
    for (words, kind) in [
        (&TYPES[..], "KEYWORD1"),
        (&FUNCTIONS[..], "KEYWORD2"),
        (&LITERALS[..], "LITERAL1"),
    ] {
        keywords.extend(words.iter().map(|word| format!("{word}\t{kind}\n")));
    }
    keywords.extend(model_words);
    let sketch = |name: &str| PathBuf::from(format!("examples/{name}/{name}.ino"));
    vec![
        ("library.properties".into(), properties),
        ("library.json".into(), json),
        ("keywords.txt".into(), keywords),
        (sketch("device"), DEVICE.into()),
        (sketch("standalone"), standalone(model, export, follows)),
    ]
}

/// The sketch for this model.
fn standalone(model: &Model, export: &CExport, follows: bool) -> String {
    let name = &export.name;
    let shout = name.to_uppercase();
    let staged = !export.stages.is_empty();
    let (kind, start, operators) = match staged {
        true => ("hys_actuator_state", "hys_actuator_start", ".operators"),
        false => ("hys_state", "hys_start", ""),
    };
    let all: &[&str] = match follows {
        true => &["wanted", "followed"],
        false => &["wanted"],
    };
    let turns = |state: &str| format!("turns_{state}");
    let arrays: Vec<String> = all
        .iter()
        .map(|state| format!("{}[{shout}_TURNS]", turns(state)))
        .collect();
    let states = format!(
        "{kind} {};\nhys_turn {};",
        all.join(", "),
        arrays.join(", ")
    );
    let mut starts = Vec::new();
    for state in all {
        starts.push(format!(
            "  is_off |= {start}(&{name}, &{state}, {}, {shout}_TURNS) != HYS_OK;",
            turns(state)
        ));
        if !staged && model.fitted().is_some() {
            starts.push(format!(
                "  is_off |= hys_restore(&{state}, {name}_start, sizeof {name}_start / sizeof \
                 {name}_start[0],\n                        {name}_start_input) != HYS_OK;"
            ));
        }
    }
    let (off, on) = model.output_range();
    let (low, high) = (off.min(on), off.max(on));
    STANDALONE
        .replace("@states@", &states)
        .replace("@start@", &starts.join("\n"))
        .replace("@wanted@", &format!("&wanted{operators}"))
        .replace(
            "@followed@",
            &match follows {
                true => format!("&followed{operators}"),
                false => "NULL".into(),
            },
        )
        .replace("@lowest@", &format!("{low:.3}"))
        .replace("@highest@", &format!("{high:.3}"))
        .replace("@NAME@", &shout)
        .replace("@name@", name)
}
