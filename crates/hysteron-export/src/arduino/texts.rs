//! The files of a library that are not C.

use super::Board;
use crate::c::CExport;
use hysteron::Model;
use std::path::PathBuf;

const DEVICE: &str = include_str!("../../arduino/device.ino");
const STANDALONE: &str = include_str!("../../arduino/standalone.ino");

/// Where the sketch that drives alone is.
pub(super) const ALONE: &str = "examples/standalone/standalone.ino";

/// What both sketches have: the parts, how they are read and driven, and their limits.
const PARTS: &str = include_str!("../../arduino/parts.ino");

/// The watchdog of an AVR.
const WATCHDOG: &str = "\
#if defined(__AVR__)
#include <avr/wdt.h>
#else
#define wdt_enable(time) // of the core, if it has one
#define wdt_reset()
#endif
";

/// The linker of a smaller board would say that a section does not fit.
const MEGA: &str = "\
#if defined(RAMEND) && RAMEND < 0x21FF
#error this sketch is for a Mega: export the model again, for this board
#endif
";

/// The parts of a sketch that learns.
const LEARNER_STATES: &str = "\
// ---- What learns: it is used while it predicts better than the model as it was fitted ----
hys_adaptive adaptive;
hys_shadow shadow;
hys_turn turns_learned[@NAME@_TURNS];
hys_real memory[@NAME@_INCREMENTS_NUMBERS];
";
const LEARNER_START: &str = "  \
  is_off |= hys_adapt_start(&adaptive, &@name@, @name@_weights, @name@.offset,
                            &@name@_increments, memory, @NAME@_INCREMENTS_NUMBERS,
                            turns_learned, @NAME@_TURNS) != HYS_OK;
";
const SHADOW_START: &str = "  \
  is_off |= hys_shadow_start(&shadow, &controller, &adaptive) != HYS_OK;
";
const SHADOW_STEP: &str = "  \
  // Not from a drive at its limit, nor from a reading in doubt: it leaves them out.
  if (!is_off && hys_shadow_step(&shadow, mm, &action) != HYS_OK) is_off = true;
";
const SHADOW_PRINT: &str = "    Serial.print(F(\" learned:\")), Serial.print(shadow.learner);\n";

/// What the editor colours.
const TYPES: [&str; 9] = [
    "hys_real",
    "hys_turn",
    "hys_state",
    "hys_actuator_state",
    "hys_control",
    "hys_controller",
    "hys_action",
    "hys_adaptive",
    "hys_shadow",
];
const FUNCTIONS: [&str; 12] = [
    "hys_start",
    "hys_step",
    "hys_inverse_step",
    "hys_actuator_start",
    "hys_actuator_step",
    "hys_actuator_inverse_step",
    "hys_controller_start",
    "hys_controller_go_on_from",
    "hys_controller_step",
    "hys_adapt_start",
    "hys_shadow_start",
    "hys_shadow_step",
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
pub(super) fn files(export: &CExport, standalone: Option<String>) -> Vec<(PathBuf, String)> {
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
    let mut files = vec![
        ("library.properties".into(), properties),
        ("library.json".into(), json),
        ("keywords.txt".into(), keywords),
        ("examples/device/device.ino".into(), shared(DEVICE)),
    ];
    files.extend(standalone.map(|text| (ALONE.into(), text)));
    files
}

/// A sketch with what both have.
fn shared(sketch: &str) -> String {
    let text = sketch.replace("@parts@\n", PARTS);
    text.replace("@watchdog@\n", WATCHDOG)
}

/// The sketch for this model.
pub(super) fn standalone(model: &Model, export: &CExport, follows: bool, board: Board) -> String {
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
    let mut states = format!(
        "{kind} {};\nhys_turn {};\n",
        all.join(", "),
        arrays.join(", ")
    );
    let learns = export.memory.adaptation.is_some();
    if learns {
        states += &LEARNER_STATES.replace("@NAME@", &shout);
    }
    let mut starts = Vec::new();
    let restore = |state: &str| match !staged && model.fitted().is_some() {
        true => format!(
            "  is_off |= hys_restore(&{state}, {name}_start, sizeof {name}_start / sizeof \
             {name}_start[0],\n                        {name}_start_input) != HYS_OK;\n"
        ),
        false => String::new(),
    };
    for state in all {
        starts.push(format!(
            "  is_off |= {start}(&{name}, &{state}, {}, {shout}_TURNS) != HYS_OK;\n",
            turns(state)
        ));
        starts.push(restore(state));
    }
    if learns {
        starts.push(LEARNER_START.into());
        starts.push(restore("adaptive.state"));
    }
    let learner = |text: &'static str| if learns { text } else { "" };
    let (off, on) = model.output_range();
    let (low, high) = (off.min(on), off.max(on));
    shared(STANDALONE)
        .replace("@board@\n", if board == Board::Mega { MEGA } else { "" })
        .replace("@states@\n", &states)
        .replace("@start@\n", &starts.concat())
        .replace("@shadow_start@\n", learner(SHADOW_START))
        .replace("@shadow_step@\n", learner(SHADOW_STEP))
        .replace("@shadow_print@\n", learner(SHADOW_PRINT))
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
