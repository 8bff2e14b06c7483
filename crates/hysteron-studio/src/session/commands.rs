//! What was clicked, as commands: for the shell, in Python and in Rust.

use super::argument::{option, path};
use super::fitted::Fitted;
use super::fitting::held_part;
use super::id::Id;
use super::opened::Opened;
use super::prepare::Steps;
use super::state::Session;
use super::wish::Wish;
use hysteron::{Operator, Plane};
use hysteron_files::python_literal;

/// The files of a fit that are still open.
fn files<'s>(session: &'s Session, ids: &[Id]) -> Vec<&'s Opened> {
    let open = ids.iter().filter_map(|id| session.file(*id).ok());
    open.collect()
}

/// Roles of a file, as name of the option and column.
fn roles(file: &Opened) -> Vec<(&'static str, &str)> {
    let roles = &file.roles;
    let all = [
        ("input", &roles.input),
        ("output", &roles.output),
        ("time", &roles.time),
        ("load", &roles.load),
    ];
    let named = all.into_iter();
    named
        .filter_map(|(name, column)| Some((name, column.as_deref()?)))
        .collect()
}

/// The part of the files fitted that was held out, in words.
fn held_part_of(fit: &Fitted) -> Option<&str> {
    Some(held_part(&fit.words)).filter(|part| !part.is_empty())
}

pub(super) fn shell(session: &Session, fit: &Fitted) -> String {
    let fitted = files(session, &fit.files);
    let names: Vec<String> = fitted.iter().map(|file| path(&file.name)).collect();
    let mut words = vec![format!("hysteron fit {}", names.join(" "))];
    let columns: Vec<String> = fitted.first().map_or(Vec::new(), |file| {
        let roles = roles(file).into_iter();
        roles.map(|(name, column)| option(name, column)).collect()
    });
    words.extend(columns.iter().cloned());
    words.extend(
        fitted
            .iter()
            .any(|file| file.mend)
            .then(|| "--repair".to_owned()),
    );
    words.extend(
        fitted
            .iter()
            .find_map(|file| file.steps.as_ref())
            .map(Steps::as_options),
    );
    let options = fit.options.iter();
    words.extend(options.map(|(name, text)| option(&name.replace('_', "-"), text)));
    words.extend(held_part_of(fit).map(|part| option("hold-out", part)));
    let others = files(session, &fit.validated);
    words.extend(
        others
            .iter()
            .map(|file| format!("--hold-out {}", path(&file.name))),
    );
    words.push("-o model.json".into());
    let mut text = words.join(" \\\n    ") + "\n";
    let test = files(session, &fit.validated);
    if let Some(file) = test.first().or(fitted.first()) {
        text += &format!(
            "hysteron evaluate model.json {} \\\n    {} --report report\n",
            path(&file.name),
            columns.join(" "),
        );
    }
    text += "hysteron export c model.json -o model-c\n";
    text
}

/// The command for a profile.
pub(super) fn design(session: &Session, fit: &Fitted, plane: &Plane, wish: &Wish) -> String {
    let mut words = vec![
        "hysteron design".to_owned(),
        format!("--range={},{}", plane.min(), plane.max()),
        format!("--levels {}", plane.levels()),
        format!("--heating-rate {}", wish.heating),
        format!("--cooling-rate {}", wish.cooling),
    ];
    words.extend(wish.budget.map(|minutes| format!("--budget {minutes}")));
    match fit.model.operator() {
        Operator::Mkp => {}
        Operator::Kp => words.push("--operator kp".into()),
        Operator::Relay => words.push("--operator relay".into()),
    }
    let recorded = files(session, &fit.files);
    if let (false, Some(file)) = (wish.whole, recorded.first()) {
        words.extend(
            recorded
                .iter()
                .map(|file| format!("--from {}", path(&file.name))),
        );
        let input = file.roles.input.as_deref().unwrap_or_default();
        words.push(option("input", input));
    }
    words.push("-o profile.csv".into());
    words.join(" \\\n    ") + "\n"
}

/// A string literal of Rust.
fn literal(text: &str) -> String {
    format!("{text:?}")
}

pub(super) fn python(session: &Session, fit: &Fitted) -> String {
    let read = |file: &&Opened| {
        let roles = roles(file).into_iter();
        let mut words: Vec<String> = roles
            .map(|(name, column)| format!("{name}={}", python_literal(column)))
            .collect();
        words.extend(file.mend.then(|| "repair=True".to_owned()));
        let several = file.has_several();
        let read = format!(
            "pyhysteron.{}({}, {})",
            if several { "read_segments" } else { "read" },
            python_literal(&file.name),
            words.join(", ")
        );
        match (&file.steps, several) {
            (Some(steps), true) => format!(
                "*[pyhysteron.prepare(part{})[0] for part in {read}]",
                steps.as_python()
            ),
            (Some(steps), false) => format!("pyhysteron.prepare({read}{})[0]", steps.as_python()),
            (None, true) => format!("*{read}"),
            (None, false) => read,
        }
    };
    let list = |files: Vec<&Opened>| {
        let each: Vec<String> = files.iter().map(read).collect();
        format!("[\n    {},\n]", each.join(",\n    "))
    };
    let mut words = vec!["recordings".to_owned()];
    for (name, text) in &fit.options {
        words.push(format!("{name}={}", python_value(name, text)));
    }
    let mut text = format!(
        "import pyhysteron\n\nrecordings = {}\n",
        list(files(session, &fit.files))
    );
    let tests = files(session, &fit.validated);
    if !tests.is_empty() {
        text += &format!("tests = {}\n", list(tests.clone()));
    }
    let part = held_part_of(fit).map(python_literal);
    words.extend(match (part, tests.is_empty()) {
        (None, true) => None,
        (None, false) => Some("hold_out=tests".into()),
        (Some(part), true) => Some(format!("hold_out={part}")),
        (Some(part), false) => Some(format!("hold_out=[{part}, *tests]")),
    });
    text += &format!("model = pyhysteron.fit({})\n", words.join(", "));
    text + "print(model.fit.nrmse_percent)\nmodel.save(\"model.json\")\n"
}

/// A number as Python writes it: without zeros before it, and finite.
fn number(text: &str) -> Option<String> {
    if let Ok(whole) = text.parse::<u64>() {
        return Some(whole.to_string());
    }
    let number = text.parse::<f64>().ok()?;
    number.is_finite().then(|| format!("{number:?}"))
}

fn python_value(name: &str, text: &str) -> String {
    match (name, text) {
        ("robust", "auto") => "True".into(),
        ("robust", "off") => "False".into(),
        ("sign", "positive") => "1".into(),
        ("sign", "negative") => "-1".into(),
        ("smooth", "off") => "0.0".into(),
        _ => {
            let parts = text.split(',').map(|part| number(part.trim()));
            match parts.collect::<Option<Vec<_>>>().as_deref() {
                Some([one]) => one.clone(),
                Some(several) => format!("({})", several.join(", ")),
                None => python_literal(text),
            }
        }
    }
}

pub(super) fn rust(session: &Session, fit: &Fitted) -> String {
    let read = |file: &&Opened, in_several: bool| {
        let roles = roles(file);
        let of = |name: &str| {
            let found = roles.iter().find(|(role, _)| *role == name);
            found.map(|(_, column)| literal(column))
        };
        let option = |name| of(name).map_or("None".into(), |column| format!("Some({column})"));
        let read = |function| {
            format!(
                "Recording::{function}({}.as_ref(), Columns {{ input: {}, output: {}, time: {}, \
                 load: {} }}, Repair::{})?.0",
                literal(&file.name),
                of("input").unwrap_or_default(),
                of("output").unwrap_or_default(),
                option("time"),
                option("load"),
                if file.mend { "Mend" } else { "Refuse" },
            )
        };
        let prepared = |recording: &str| match &file.steps {
            Some(steps) => format!(
                "prepare(&{recording}, &{}, Progress::NONE)?.0",
                steps.as_rust()
            ),
            None => recording.to_owned(),
        };
        match (file.has_several(), in_several) {
            (true, _) => format!(
                "    {}\n        .into_iter()\n        .map(|part| Ok({}))\n        \
                 .collect::<hysteron::Result<Vec<_>>>()?,\n",
                read("read_segments"),
                prepared("part.recording")
            ),
            (false, true) => format!("    vec![{}],\n", prepared(&read("read"))),
            (false, false) => format!("    {},\n", prepared(&read("read"))),
        }
    };
    let list = |ids: &[Id]| {
        let files = files(session, ids);
        let several = files.iter().any(|file| file.has_several());
        let each: String = files.iter().map(|file| read(file, several)).collect();
        match several {
            true => format!("[\n{each}]\n.concat()"),
            false => format!("vec![\n{each}]"),
        }
    };
    let mut text =
        "use hysteron::{Columns, Fit, HoldOut, Recording, Repair, fit_holding_out};\n".to_owned();
    let all = files(session, &fit.files);
    if all.iter().any(|file| file.steps.is_some()) {
        text += "use hysteron::{PrepareOptions, Progress, Step, prepare};\n";
    }
    text += "\n";
    text += &format!("let recordings = {};\n", list(&fit.files));
    text += "let fit = Fit::new()";
    for (name, word) in &fit.options {
        text += &format!("\n    .with({}, {})?", literal(name), literal(word));
    }
    text += ";\n";
    let part = held_part_of(fit).map(literal);
    let others = (!fit.validated.is_empty()).then(|| list(&fit.validated));
    text += &match (part, others) {
        (None, None) => "let model = fit.run(&recordings)?;\n".to_owned(),
        (None, Some(others)) => {
            format!("let hold_out = HoldOut::Recordings({others});\n{HELD}")
        }
        (Some(part), None) => format!("let hold_out: HoldOut = {part}.parse()?;\n{HELD}"),
        (Some(part), Some(others)) => {
            format!("let hold_out = HoldOut::Both(Box::new({part}.parse()?), {others});\n{HELD}")
        }
    };
    text + "model.write(\"model.json\")?;\n"
}

const HELD: &str = "let (model, held_out) = fit_holding_out(&fit, &recordings, &hold_out)?;\n\
                    println!(\"{:?}\", held_out.model);\n";
