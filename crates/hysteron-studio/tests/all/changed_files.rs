//! A session whose files change, stand elsewhere than they count, or are gone; a path in a file.

use crate::asked::ask;
use hysteron_studio::{Id, Session};
use serde_json::{Value, json};

/// Loops of a play below three lines of a logger, with a spike of the output at some samples. The
/// first sample is on line 5.
fn logger(spikes: &[usize], turn: f64) -> String {
    let mut text = "Logger 4711\nchannel 1\n\ntime [s],T [degC],lift [mm]\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..600 {
        let x = f64::from(n);
        let input = 50.0 - 30.0 * (x * turn).cos() * (1.0 - x / 900.0);
        y = y.clamp(input - 2.0, input + 2.0);
        let spike = if spikes.contains(&(n as usize + 1)) {
            9.0
        } else {
            0.0
        };
        text += &format!("{},{input},{}\n", 0.1 * x, 0.2 * y + spike);
    }
    text
}

/// A file to fit, a file for validation with two spikes, and the fit.
fn tested() -> (Session, [Id; 2], Value) {
    let mut session = Session::new(1 << 28);
    let first = session.open("a.csv", logger(&[], 0.05).into()).unwrap();
    let spoiled = logger(&[124, 301], 0.043);
    let second = session.open("b.csv", spoiled.into()).unwrap();
    let purpose = json!({"request": "use", "file": second, "purpose": "validate"});
    ask(&mut session, purpose).unwrap();
    let fit = fit(&mut session);
    (session, [first, second], fit)
}

fn fit(session: &mut Session) -> Value {
    let options = json!({"levels": "10", "bootstrap": "0"});
    ask(session, json!({"request": "fit", "options": options})).unwrap()
}

fn fits(session: &mut Session) -> Vec<Value> {
    let seen = ask(session, json!({"request": "overview"})).unwrap();
    seen["fits"].as_array().unwrap().clone()
}

fn error(fit: &Value) -> f64 {
    fit["held_out"]["model"]["rmse"].as_f64().unwrap()
}

/// After the file for validation was prepared, the errors are said to be of before, and computed
/// anew they are those of a fit that is made anew.
#[test]
fn errors_of_a_file_that_was_prepared_are_computed_anew() {
    let (mut session, [first, second], fit_id) = tested();
    let before = fits(&mut session).remove(0);
    assert_eq!(before["changed"], json!([]));
    assert!(error(&before) > 0.3, "{before}");
    let prepare = |file| json!({"request": "prepare", "file": file, "steps": {"low_pass": "off"}});
    ask(&mut session, prepare(second)).unwrap();
    let stale = fits(&mut session).remove(0);
    assert_eq!(
        (&stale["changed"], error(&stale)),
        (&json!([second]), error(&before))
    );
    assert_eq!(stale["can_be_judged_anew"], true);
    // A session that is kept knows it, too.
    let taken = ask(&mut session, json!({"request": "take", "what": "session"})).unwrap();
    let bytes: Vec<u8> = serde_json::from_value(taken["bytes"].clone()).unwrap();
    let mut again = Session::from_file(&bytes, 1 << 28).unwrap();
    assert_eq!(fits(&mut again)[0]["changed"], json!([second]));

    let anew = json!({"request": "judge_anew", "fit": fit_id});
    ask(&mut session, anew.clone()).unwrap();
    fit(&mut session);
    let both = fits(&mut session);
    assert_eq!(
        (&both[0]["changed"], &both[1]["changed"]),
        (&json!([]), &json!([]))
    );
    // Two spikes of 9 mm among 600 samples are 0.52 mm; what is left is the model's.
    assert!(
        error(&both[0]) < 0.4 * error(&before),
        "{}",
        error(&both[0])
    );
    assert_eq!(both[0]["held_out"], both[1]["held_out"]);
    assert_eq!(both[0]["verdict"], both[1]["verdict"]);
    // Nothing is left to compute.
    assert_eq!(ask(&mut session, anew.clone()).unwrap_err().code, 102);

    // What was fitted has changed: only another fit helps.
    ask(
        &mut session,
        json!({"request": "prepare", "file": first, "steps": {"low_pass": "0.5"}}),
    )
    .unwrap();
    let stale = fits(&mut session).remove(0);
    assert_eq!(stale["changed"], json!([first]));
    assert_eq!(stale["can_be_judged_anew"], false);
    assert_eq!(ask(&mut session, anew).unwrap_err().code, 102);
    // As it was read, it is the one that was fitted.
    ask(
        &mut session,
        json!({"request": "prepare", "file": first, "steps": null}),
    )
    .unwrap();
    assert_eq!(fits(&mut session)[0]["changed"], json!([]));
}

/// The worst sample is one of the file that the error is told of, and its line is that of the file.
#[test]
fn the_worst_sample_is_of_the_file_for_validation() {
    let (mut session, [first, second], fit_id) = tested();
    let worst = ask(&mut session, json!({"request": "worst", "fit": fit_id})).unwrap();
    assert_eq!(worst["file"], second);
    let number = worst["sample"]["number"].as_u64().unwrap();
    assert!([124, 301].contains(&number), "{worst}");
    assert_eq!(worst["sample"]["place"], format!("line {}", number + 4));
    // Also where that of the file fitted is larger.
    session
        .open("a.csv", logger(&[200, 201, 202], 0.05).into())
        .unwrap();
    let worst = ask(&mut session, json!({"request": "worst", "fit": fit_id})).unwrap();
    assert_eq!(worst["file"], second);
    ask(&mut session, json!({"request": "close", "file": second})).unwrap();
    let worst = json!({"request": "worst", "fit": fit_id});
    assert_eq!(ask(&mut session, worst).unwrap_err().code, 102);
    assert!(
        fits(&mut session)[0]["changed"]
            .as_array()
            .unwrap()
            .contains(&json!(first))
    );
}

/// Rows that a repair dropped, and a second recording, still count in the file.
#[test]
fn a_sample_is_on_its_line_of_the_file() {
    let text = logger(&[], 0.05);
    // The reading on line 10 is missing; from line 305 on the clock begins anew.
    let rows = text.lines().enumerate().map(|(n, row)| match n + 1 {
        10 => "0.5,,1".to_owned(),
        line @ 305.. => {
            let (_, values) = row.split_once(',').unwrap();
            format!("{},{values}", 0.1 * (line - 305) as f64)
        }
        _ => row.to_owned(),
    });
    let text: Vec<String> = rows.collect();
    let mut session = Session::new(1 << 28);
    let file = session
        .open("a.csv", (text.join("\n") + "\n").into())
        .unwrap();
    ask(
        &mut session,
        json!({"request": "mend", "file": file, "on": true}),
    )
    .unwrap();
    let seen = ask(&mut session, json!({"request": "overview"})).unwrap();
    let spans: Vec<[f64; 2]> = serde_json::from_value(seen["files"][0]["spans"].clone()).unwrap();
    assert_eq!(
        (spans.len(), &seen["files"][0]["samples"]),
        (2, &json!(599))
    );
    let mut place = |at: f64| {
        let seen = ask(
            &mut session,
            json!({"request": "sample", "file": file, "at": at}),
        )
        .unwrap();
        (seen["number"].clone(), seen["place"].clone())
    };
    assert_eq!(place(0.4), (json!(5), json!("line 9")));
    assert_eq!(place(0.6), (json!(6), json!("line 11")));
    assert_eq!(place(spans[1][0]), (json!(300), json!("line 305")));
    // In equal steps samples are no rows any more.
    let steps = json!({"resample": "0.05", "spikes": "off", "low_pass": "off", "dead_band": "off"});
    ask(
        &mut session,
        json!({"request": "prepare", "file": file, "steps": steps}),
    )
    .unwrap();
    let seen = ask(
        &mut session,
        json!({"request": "sample", "file": file, "at": 5.0}),
    )
    .unwrap();
    assert_eq!(seen["place"], Value::Null);
}

/// A part of a picture of what was closed meanwhile is no error.
#[test]
fn what_is_gone_is_not_drawn() {
    let (mut session, [_, second], fit_id) = tested();
    ask(&mut session, json!({"request": "close", "file": second})).unwrap();
    let view = json!({"file": second, "fits": [fit_id], "picture": "loop", "pixels": [600, 400]});
    let mut curves = view.clone();
    curves["request"] = json!("curves");
    for request in [
        curves,
        json!({"request": "nearest", "view": view, "at": [50.0, 5.0]}),
        json!({"request": "sample", "file": second, "at": 1.0}),
        json!({"request": "plane", "fit": fit_id, "kind": "states", "at": [second, 1.0]}),
        json!({"request": "switch", "fit": fit_id, "file": second, "operator": [1, 2]}),
    ] {
        assert_eq!(
            ask(&mut session, request).unwrap(),
            json!({"response": "gone"})
        );
    }
    // To do something with it is one.
    let mend = json!({"request": "mend", "file": second, "on": true});
    assert_eq!(ask(&mut session, mend).unwrap_err().code, 100);
}

/// The table that came of the last path.
fn way(session: &mut Session, drive: &Value) -> (String, Vec<Vec<String>>) {
    let taken = ask(
        session,
        json!({"request": "take", "what": "way", "drive": drive}),
    )
    .unwrap();
    let bytes: Vec<u8> = serde_json::from_value(taken["bytes"].clone()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    let rows = rows
        .lines()
        .map(|row| row.split(',').map(str::to_owned).collect());
    (head.to_owned(), rows.collect())
}

/// A column of a file leads where its numbers lead by hand, at the times of the file, and what came
/// of it can be taken home.
#[test]
fn a_drive_follows_a_column_of_a_file() {
    let (mut session, [first, _], fit_id) = tested();
    let stairs = [5.0, 5.0, 9.0, 9.0, 6.0, 30.0, 7.0];
    // Numbers as a German table has them.
    let rows = stairs.iter().enumerate();
    let rows = rows.map(|(n, y)| format!("{};{};x\n", 2 * n, format!("{y:.1}").replace('.', ",")));
    let text = format!("Zeit [s];Weg [mm];note\n{}", rows.collect::<String>());
    let file = session.open("stairs.csv", text.into()).unwrap();
    let purpose = json!({"request": "use", "file": file, "purpose": "path"});
    ask(&mut session, purpose).unwrap();
    let drive = json!({"request": "drive", "fit": fit_id});
    let by_hand = ask(&mut session, drive.clone()).unwrap()["drive"].clone();
    let pull =
        json!({"request": "pull", "drive": by_hand, "outputs": stairs, "policy": "anticipate"});
    let by_hand = ask(&mut session, pull).unwrap();
    let drive = ask(&mut session, drive).unwrap()["drive"].clone();
    let follow = |column: &str, of: &str| {
        json!({"request": "follow", "drive": drive, "file": file, "column": column, "of": of,
            "policy": "anticipate"})
    };
    let seen = ask(&mut session, follow("Weg [mm]", "outputs")).unwrap();
    for name in ["input", "output", "trail", "moves", "followed"] {
        assert_eq!(seen[name], by_hand[name], "{name}");
    }
    let followed = json!({"of": "outputs", "samples": 7, "missed": [["high", 1]]});
    assert_eq!(seen["followed"], followed);
    let (head, rows) = way(&mut session, &drive);
    assert_eq!(
        head,
        "time [s],wanted lift [mm],T [degC],modelled lift [mm],status"
    );
    assert_eq!(rows.len(), 7);
    for (n, (row, wanted)) in rows.iter().zip(stairs).enumerate() {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        assert_eq!((number(0), number(1)), (2.0 * n as f64, wanted));
        let reached = (number(3) - wanted).abs() < 1e-6;
        assert_eq!(
            (reached, row[4].as_str()),
            (n != 5, if n == 5 { "high" } else { "ok" })
        );
    }
    // As the input, and of a recording that is open: what was prepared of it.
    let mut of_input = follow("T [degC]", "inputs");
    of_input["file"] = json!(first);
    ask(&mut session, of_input).unwrap();
    let (head, rows) = way(&mut session, &drive);
    assert_eq!(
        (head.as_str(), rows.len()),
        ("time [s],T [degC],modelled lift [mm]", 600)
    );
    // A text is no path, and moves nothing.
    let before = json!({"request": "pull", "drive": drive, "input": 40.0});
    let before = ask(&mut session, before).unwrap();
    assert_eq!(before["followed"], Value::Null);
    let refused = ask(&mut session, follow("note", "outputs")).unwrap_err();
    assert!(refused.problem.contains("line 2"), "{}", refused.problem);
    let take = json!({"request": "take", "what": "way", "drive": drive});
    assert_eq!(ask(&mut session, take).unwrap_err().code, 102);
    // A path is no recording to be fitted.
    fit(&mut session);
}
