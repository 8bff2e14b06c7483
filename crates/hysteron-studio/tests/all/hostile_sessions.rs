//! Session files of strangers: read or refused with words, and nothing of them is run by the
//! commands that the studio writes.

use hysteron_studio::{Request, Response, Session};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::process::Command;
use std::sync::LazyLock;

fn ask(session: &mut Session, request: Value) -> Option<Response> {
    let request = serde_json::from_value(request).unwrap();
    session.handle(request).ok().map(|answer| answer.response)
}

/// A session with a fit of three levels, as a file.
static SAVED: LazyLock<Value> = LazyLock::new(|| {
    let row = |n: u32| {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.2).cos();
        format!("{},{t},{}\n", f64::from(n), 0.1 * t)
    };
    let rows: String = (0..120).map(row).collect();
    let mut session = Session::new(1 << 26);
    let table = format!("time [s],T,lift\n{rows}");
    session.open("run.csv", table.into()).unwrap();
    let options = json!({"levels": "3", "bootstrap": "0", "smooth": "1e-6,1e-8"});
    let fit = json!({"request": "fit", "options": options, "hold_out": {"words": "rows:1-20"}});
    let fit = serde_json::from_value::<Request>(fit).unwrap();
    let job = session.handle(fit).unwrap().job.unwrap();
    session.finish(job.run()).unwrap();
    let saved = json!({"request": "take", "what": "session"});
    match ask(&mut session, saved).unwrap() {
        Response::Taken(file) => serde_json::from_slice(&file.bytes).unwrap(),
        other => panic!("{other:?}"),
    }
});

/// Opens a session file. What it leads to is answered, and its texts of commands are returned.
fn texts(file: &Value) -> Result<Vec<(&'static str, String)>, String> {
    // The first name decides that it is a session.
    let text = file.to_string();
    let format = "\"format\":\"hysteron-studio\"";
    let text = text
        .replace(&format!(",{format}"), "")
        .replace(&format!("{format},"), "");
    let text = format!("{{{format},{}", &text[1..]);
    let mut session = Session::new(1 << 24);
    let opened = session.open("s.json", text.into_bytes());
    opened.map_err(|fault| fault.problem)?;
    let seen = session.overview();
    let mut found = Vec::new();
    for fit in &seen.fits {
        for what in ["command", "python", "rust"] {
            let take = json!({"request": "take", "what": what, "fit": fit.id});
            if let Some(Response::Taken(file)) = ask(&mut session, take) {
                found.push((what, String::from_utf8(file.bytes).unwrap()));
            }
        }
        let drive = ask(&mut session, json!({"request": "drive", "fit": fit.id}));
        assert!(matches!(drive, None | Some(Response::Driven(_))));
    }
    // A number more is given, or refused with words.
    if let Err(fault) = session.open("more.csv", b"a,b\n1,2\n2,3\n".to_vec()) {
        assert!(fault.problem.contains("all its numbers"), "{fault}");
    }
    assert!(session.room() <= 1 << 24);
    Ok(found)
}

/// The words that the shell makes of a script whose programs are all replaced by one that prints.
fn words(script: &str) -> Vec<Vec<String>> {
    let print = "hysteron() { printf '%s\\0' \"$@\"; printf '\\1\\0'; }\n";
    let mut shell = Command::new("/bin/sh");
    let done = shell.arg("-c").arg(format!("PATH=\n{print}{script}"));
    let done = done.output().unwrap();
    assert!(
        done.status.success() && done.stderr.is_empty(),
        "{script}\n{done:?}"
    );
    let text = String::from_utf8(done.stdout).unwrap();
    let calls = text.split("\u{1}\0").filter(|call| !call.is_empty());
    let call = |call: &str| call.split_terminator('\0').map(str::to_owned).collect();
    calls.map(call).collect()
}

fn is_quoted(texts: &[(&str, String)], name: Option<&str>) {
    for (what, text) in texts {
        if *what != "command" {
            continue;
        }
        let calls = words(text);
        let heads: Vec<&str> = calls.iter().map(|call| call[0].as_str()).collect();
        assert_eq!(heads, ["fit", "evaluate", "export"], "{text}");
        let Some(name) = name else { continue };
        // As one word, beside its option or behind it.
        let name = name.replace('\0', "");
        let whole = |word: &String| *word == name || *word == format!("--input={name}");
        assert!(calls[0].iter().any(whole), "{name:?} in {text}");
    }
    // Python reads its text as calls of this module and literals, and nothing else.
    let python = texts.iter().filter(|(what, _)| *what == "python");
    for (_, text) in python {
        let Some(found) = literals(text) else { return };
        if let Some(name) = name {
            assert!(found.contains(&name.to_owned()), "{name:?} in {text}");
        }
    }
}

/// The strings in a text of Python; `None` without Python.
fn literals(text: &str) -> Option<Vec<String>> {
    const READ: &str = "
import ast, json, sys
tree = ast.parse(sys.stdin.read())
known = {'pyhysteron', 'recordings', 'tests', 'model', 'print'}
for node in ast.walk(tree):
    if isinstance(node, ast.Name): assert node.id in known, node.id
    if isinstance(node, ast.Import): assert [a.name for a in node.names] == ['pyhysteron']
    if isinstance(node, ast.Attribute):
        assert node.attr in {'read', 'prepare', 'fit', 'nrmse_percent', 'save'}, node.attr
strings = [n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
print(json.dumps(strings))
";
    use std::io::Write;
    use std::process::Stdio;
    let mut python = Command::new("python3");
    let python = python
        .args(["-X", "utf8", "-c", READ])
        .stdin(Stdio::piped());
    let mut python = python.stdout(Stdio::piped()).spawn().ok()?;
    python.stdin.take()?.write_all(text.as_bytes()).unwrap();
    let done = python.wait_with_output().unwrap();
    assert!(done.status.success(), "{text}");
    Some(serde_json::from_slice(&done.stdout).unwrap())
}

#[test]
fn a_payload_is_refused_or_stays_a_word() {
    let payload = "rows:1-9; touch X #";
    let mut file = SAVED.clone();
    file["fits"][0]["hold_out"] = json!(payload);
    assert!(texts(&file).unwrap_err().contains("cannot be held out"));
    let mut file = SAVED.clone();
    file["fits"][0]["hold_out"] = json!("rows:1-9,\n20 - 30");
    is_quoted(&texts(&file).unwrap(), None);
    for (name, value) in [
        ("levels", "3; touch X"),
        ("levels", "1000000"),
        ("bootstrap", "99999999"),
        ("x; touch X", "3"),
        ("ridge", "__import__('os')"),
    ] {
        let mut file = SAVED.clone();
        file["fits"][0]["options"] = json!({name: value});
        assert!(texts(&file).is_err(), "{name} {value}");
    }
    let mut file = SAVED.clone();
    let step = json!({"spikes": "4; touch X", "resample": "auto", "low_pass": "auto",
        "lag": "off", "dead_band": "auto"});
    file["files"][0]["steps"] = step;
    assert!(texts(&file).unwrap_err().contains("neither auto nor off"));
    for id in [u64::MAX, 1 << 53] {
        let mut file = SAVED.clone();
        file["files"][0]["id"] = json!(id);
        assert!(texts(&file).unwrap_err().contains("too large"));
    }
    let mut file = SAVED.clone();
    file["files"][0]["id"] = json!((1_u64 << 53) - 1);
    texts(&file).unwrap();
}

#[test]
fn absurd_requests_are_refused_before_they_start() {
    let mut session = Session::new(1 << 26);
    let rows: String = (0..40)
        .map(|n| format!("{n},{},{}\n", n % 9, n % 7))
        .collect();
    let file = session
        .open("a.csv", format!("time [s],T,lift\n{rows}").into())
        .unwrap();
    for (name, value) in [
        ("bootstrap", "99999999"),
        ("levels", "1000000"),
        ("levels", "1000"),
    ] {
        let fit = json!({"request": "fit", "options": {name: value}});
        let refused = session.handle(serde_json::from_value(fit).unwrap());
        assert!(refused.is_err(), "{name} {value}");
        assert!(session.jobs().is_empty());
    }
    let mut steps = json!({"spikes": "off", "resample": "1e-6", "low_pass": "off", "lag": "off",
        "dead_band": "off"});
    let prepare = |steps: &Value| json!({"request": "prepare", "file": file, "steps": steps});
    let fault = session
        .handle(serde_json::from_value(prepare(&steps)).unwrap())
        .unwrap_err();
    assert_eq!(fault.code, 101, "{fault}");
    steps["resample"] = json!("0.5");
    session
        .handle(serde_json::from_value(prepare(&steps)).unwrap())
        .unwrap();
}

/// What a stranger may write where the session has a text.
fn hostile() -> impl Strategy<Value = String> {
    prop_oneof![
        "[ -~]{0,12}",
        "\\PC{0,8}",
        Just("'; touch X; '".to_owned()),
        Just("$(touch X)`touch X`".to_owned()),
        Just("\"); import os; os.system('touch X') #".to_owned()),
        Just("a\n touch X\r\t\u{0}\\\"'\u{202e}\u{7f}\u{85}".to_owned()),
        Just("-o\\".to_owned()),
        Just("rows:1-9\n,20-30".to_owned()),
        Just("branches: 20 %".to_owned()),
        Just("007".to_owned()),
        Just("inf".to_owned()),
    ]
}

/// All places of a value that hold something.
fn places(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (name, inner) in fields {
                let name = name.replace('~', "~0").replace('/', "~1");
                places(inner, format!("{at}/{name}"), found);
            }
        }
        Value::Array(all) => {
            for (n, inner) in all.iter().enumerate().take(3) {
                places(inner, format!("{at}/{n}"), found);
            }
        }
        _ => {}
    }
    found.push(at);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 96,
        failure_persistence: None,
        rng_seed: prop::test_runner::RngSeed::Fixed(7),
        ..Default::default()
    })]

    /// Every name comes back as one word, from the shell and from Python.
    #[test]
    fn names_stay_names(name in hostile()) {
        let mut file = SAVED.clone();
        // The recording need not have such a column: the command has it all the same.
        file["files"][0]["roles"]["input"] = json!(name);
        is_quoted(&texts(&file).unwrap(), Some(&name));
    }

    /// Any value of a session replaced, removed or taken twice.
    #[test]
    fn any_session_is_read_or_refused(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, hostile()), 1..4),
    ) {
        let mut file = SAVED.clone();
        for (place, how, text) in changes {
            let mut found = Vec::new();
            places(&file, String::new(), &mut found);
            let place = &found[place.index(found.len())];
            if place.is_empty() {
                continue;
            }
            let Some(value) = file.pointer_mut(place) else { continue };
            *value = match how {
                0 | 1 => json!(text),
                2 => [json!(1e308), json!(u64::MAX), json!(-1)][text.len() % 3].clone(),
                3 => Value::Null,
                4 => json!([value.clone(), value.clone()]),
                _ => json!({text: value.clone()}),
            };
        }
        match texts(&file) {
            Ok(found) => is_quoted(&found, None),
            Err(problem) => prop_assert!(!problem.trim().is_empty()),
        }
    }

    /// A file that is cut off or has other bytes.
    #[test]
    fn any_bytes_are_read_or_refused(at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let mut bytes = SAVED.to_string().into_bytes();
        let at = at.index(bytes.len());
        if byte.is_multiple_of(2) {
            bytes.truncate(at);
        } else {
            bytes[at] = byte;
        }
        let _ = Session::from_file(&bytes, 1 << 24);
    }
}
