//! What the views of the session show: parts of the loop, samples, preparations, paths, profiles.

use crate::asked::ask;
use hysteron_studio::{Id, Session};
use serde_json::{Value, json};

/// A play of 4 degC with loops that shrink, a spike, and noise.
fn table(noise: f64) -> String {
    let mut text = "time [s],temperature [degC],displacement [mm]\n".to_owned();
    let (mut y, mut seed) = (20.0_f64, 1_u64);
    for n in 0..600 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let random = (seed >> 40) as f64 / f64::from(1 << 24) - 0.5;
        let t = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 900.0);
        y = y.clamp(t - 2.0, t + 2.0);
        let read = if noise > 0.0 && n == 300 {
            400.0
        } else {
            t + noise * random
        };
        text += &format!(
            "{},{read},{}\n",
            f64::from(n) * 0.1,
            0.2 * y + 0.1 * noise * random
        );
    }
    text
}

fn fitted(noise: f64) -> (Session, Id, Id) {
    let mut session = Session::new(1 << 28);
    let file = session.open("run.csv", table(noise).into()).unwrap();
    let options = json!({"levels": "12", "bootstrap": "0", "smooth": "off"});
    let fit = ask(&mut session, json!({"request": "fit", "options": options})).unwrap();
    let fit = fit.as_u64().unwrap();
    (session, file, fit)
}

#[test]
fn a_part_of_the_loop_is_the_same_samples_in_every_picture() {
    let (mut session, file, fit) = fitted(0.0);
    let view = |picture: &str| {
        json!({"request": "curves", "file": file, "fits": [fit], "picture": picture,
            "area": {"input": [30.0, 45.0], "output": [5.0, 8.0]}, "pixels": [600, 400]})
    };
    let mut counts = Vec::new();
    for picture in [
        "input",
        "output",
        "loop",
        "residuals",
        "residuals_over_input",
        "histogram",
    ] {
        let seen = ask(&mut session, view(picture)).unwrap();
        counts.push(seen["samples"].as_u64().unwrap());
        assert!(seen["span"][0].as_f64().unwrap() > 0.0, "{picture}");
    }
    assert!(counts[0] > 20 && counts[0] < 400 && counts.iter().all(|n| *n == counts[0]));
    // Over time there are gaps, and what is shown is inside but for the ends of lines.
    let seen = ask(&mut session, view("input")).unwrap();
    let inputs = seen["lines"][0]["y"].as_array().unwrap();
    assert!(inputs.iter().any(Value::is_null));
    // The input moves by at most 1.5 from sample to sample.
    let inside = |u: &Value| u.as_f64().is_none_or(|u| (28.4..46.6).contains(&u));
    assert!(inputs.iter().all(inside));
    // Whole samples, as a table: none beside the part.
    let mut take = view("output");
    (take["request"], take["what"]) = (json!("take"), json!("table"));
    let bytes = ask(&mut session, take.clone()).unwrap();
    let bytes: Vec<u8> = serde_json::from_value(bytes["bytes"].clone()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!(rows.len() > 20 && rows.len() as u64 <= counts[0]);
    for row in &rows {
        assert!((30.0..=45.0).contains(&row[1]) && (5.0..=8.0).contains(&row[2]));
        assert_eq!(row[2] - row[3], row[4]);
    }
    take["what"] = json!("parquet");
    let bytes = ask(&mut session, take).unwrap();
    let bytes: Vec<u8> = serde_json::from_value(bytes["bytes"].clone()).unwrap();
    let mut again = Session::new(1 << 28);
    let file = again.open("samples.parquet", bytes).unwrap();
    let roles = json!({"input": "temperature [degC]", "output": "displacement [mm]"});
    let seen = ask(
        &mut again,
        json!({"request": "columns", "file": file, "roles": roles}),
    );
    assert_eq!(seen.unwrap()["files"][0]["samples"], rows.len());
}

/// Points are thinned at the scale that is drawn: a few samples far from all others make no pixel
/// larger, so that every sample on the scale is within a pixel of what is drawn.
#[test]
fn a_spike_thins_no_other_samples() {
    let (mut session, file, fit) = fitted(0.3);
    let mut drawn = |picture: &str, pixels: [u32; 2]| {
        let view = json!({"request": "curves", "file": file, "fits": [fit], "picture": picture,
            "pixels": pixels});
        let seen = ask(&mut session, view).unwrap();
        let line = seen["lines"].as_array().unwrap().last().unwrap().clone();
        let values = |axis: &str| serde_json::from_value::<Vec<Option<f64>>>(line[axis].clone());
        let (x, y) = (values("x").unwrap(), values("y").unwrap());
        let points = x.into_iter().zip(y).filter_map(|(x, y)| Some([x?, y?]));
        (points.collect::<Vec<[f64; 2]>>(), seen["ends"].clone())
    };
    for (picture, is_line) in [("loop", true), ("residuals_over_input", false)] {
        let (all, _) = drawn(picture, [8192, 8192]);
        let (some, ends) = drawn(picture, [400, 200]);
        assert!(
            ends[0]["beyond"] == true && some.len() < all.len(),
            "{picture}"
        );
        let end = |axis: usize, name: &str| ends[axis][name].as_f64().unwrap();
        let pixel = [(0, 400.0), (1, 200.0)]
            .map(|(axis, pixels)| (end(axis, "high") - end(axis, "low")) / pixels);
        let on_scale = |p: &&[f64; 2]| {
            (0..2).all(|axis| (end(axis, "low")..=end(axis, "high")).contains(&p[axis]))
        };
        let segments: Vec<[[f64; 2]; 2]> = match is_line {
            true => some.windows(2).map(|pair| [pair[0], pair[1]]).collect(),
            false => some.iter().map(|point| [*point; 2]).collect(),
        };
        // From a point to a segment, in pixels.
        let away = |p: &[f64; 2], [a, b]: [[f64; 2]; 2]| {
            let from = |q: [f64; 2]| [0, 1].map(|axis| (q[axis] - a[axis]) / pixel[axis]);
            let (way, to) = (from(b), from(*p));
            let along = way[0] * to[0] + way[1] * to[1];
            let share = along / way[0].hypot(way[1]).powi(2).max(f64::MIN_POSITIVE);
            let share = share.clamp(0.0, 1.0);
            (to[0] - share * way[0]).hypot(to[1] - share * way[1])
        };
        let farthest = all.iter().filter(on_scale).map(|point| {
            let each = segments.iter().map(|segment| away(point, *segment));
            each.fold(f64::INFINITY, f64::min)
        });
        // The diagonal of a pixel.
        let farthest = farthest.fold(0.0, f64::max);
        assert!(farthest <= 2_f64.sqrt(), "{picture}: {farthest} pixels");
    }
}

/// A fit that needs a time is left out of the pictures of a file without one, by name; others are
/// drawn.
#[test]
fn a_fit_that_cannot_be_drawn_is_named_and_hides_no_other() {
    let (mut session, file, fit) = fitted(0.0);
    let timed = json!({"levels": "6", "bootstrap": "0", "smooth": "off", "creep": "auto",
        "thermal": "first-order"});
    let timed = ask(
        &mut session,
        json!({"request": "fit", "options": timed, "hold_out": "nothing"}),
    )
    .unwrap();
    let other = session.open("static.csv", table(0.0).into()).unwrap();
    let roles = json!({"input": "temperature [degC]", "output": "displacement [mm]"});
    let columns = json!({"request": "columns", "file": other, "roles": roles});
    ask(&mut session, columns).unwrap();
    for picture in ["output", "loop", "residuals", "histogram"] {
        let view = json!({"request": "curves", "file": other, "fits": [fit, timed], "of": timed,
            "band": true, "picture": picture, "pixels": [600, 400]});
        let seen = ask(&mut session, view).unwrap();
        let drawn: Vec<_> = seen["lines"]
            .as_array()
            .unwrap()
            .iter()
            .map(|line| line["fit"].clone())
            .collect();
        assert!(
            drawn.contains(&json!(fit)) && !drawn.contains(&timed),
            "{picture}: {drawn:?}"
        );
        assert_eq!(seen["left_out"][0]["fit"], timed);
        assert!(
            seen["left_out"][0]["why"]["problem"]
                .as_str()
                .unwrap()
                .contains("time")
        );
    }
    let sample = json!({"request": "sample", "file": other, "fits": [fit, timed], "at": 100.0});
    assert_eq!(
        ask(&mut session, sample).unwrap()["modelled"]
            .as_array()
            .unwrap()
            .len(),
        1
    );
    // Its plane has no states at a sample there, and says why.
    for (kind, shown) in [("weights", "weights"), ("states", "weights")] {
        let plane = |fit: &Value| json!({"request": "plane", "fit": fit, "kind": kind, "at": [other, 100.0]});
        let seen = ask(&mut session, plane(&timed)).unwrap();
        assert_eq!(
            (&seen["kind"], &seen["sample"], &seen["staircase"]),
            (&json!(shown), &Value::Null, &json!([]))
        );
        let why = seen["left_out"]["problem"].as_str().unwrap();
        assert!(why.contains("time"), "{why}");
        let seen = ask(&mut session, plane(&json!(fit))).unwrap();
        assert_eq!(
            (&seen["kind"], &seen["left_out"]),
            (&json!(kind), &Value::Null)
        );
    }
    // One that is not there at all may have been removed on another page: that is no error.
    let view = json!({"request": "curves", "file": file, "fits": [fit + 99], "picture": "loop",
        "pixels": [600, 400]});
    assert_eq!(ask(&mut session, view).unwrap()["response"], "gone");
}

/// Errors on other data are not compared: the newest test counts.
#[test]
fn the_best_fit_is_one_of_those_with_the_same_test() {
    let mut session = Session::new(1 << 28);
    let file = session.open("run.csv", table(0.3).into()).unwrap();
    let fit = |session: &mut Session, levels: &str| {
        let options =
            json!({"levels": levels, "bootstrap": "0", "smooth": "off", "dynamics": "off"});
        let request = json!({"request": "fit", "options": options});
        ask(session, request).unwrap()
    };
    let raw = fit(&mut session, "12");
    let best = |session: &mut Session| {
        ask(session, json!({"request": "overview"})).unwrap()["best"].clone()
    };
    assert_eq!(best(&mut session), raw);
    let steps = json!({"spikes": "auto", "low_pass": "auto"});
    let _ = ask(
        &mut session,
        json!({"request": "prepare", "file": file, "steps": steps}),
    )
    .unwrap();
    let prepared = fit(&mut session, "2");
    assert_eq!(best(&mut session), prepared, "a test of its own");
    let better = fit(&mut session, "12");
    assert_eq!(best(&mut session), better);
}

/// A file for validation tests whatever was fitted: such fits are compared, though what they were
/// fitted to differs.
#[test]
fn fits_of_other_data_with_one_test_are_compared() {
    let mut session = Session::new(1 << 28);
    let own = session.open("one.csv", table(0.3).into()).unwrap();
    let test = session.open("test.csv", table(0.1).into()).unwrap();
    let mut ask = |request| ask(&mut session, request).unwrap();
    let purpose =
        |file: Id, purpose: &str| json!({"request": "use", "file": file, "purpose": purpose});
    let fit = |levels: &str| {
        let options =
            json!({"levels": levels, "bootstrap": "0", "smooth": "off", "dynamics": "off"});
        json!({"request": "fit", "options": options})
    };
    ask(purpose(test, "validate"));
    let better = ask(fit("12"));
    // Other samples are fitted, with the same test.
    ask(
        json!({"request": "prepare", "file": own, "steps": {"spikes": "auto", "low_pass": "auto"}}),
    );
    ask(fit("2"));
    assert_eq!(ask(json!({"request": "overview"}))["best"], better);
}

/// A click in the plane goes from one switch of the operator to the next: its state there is on the
/// other side of one half than at the sample before.
#[test]
fn a_cell_leads_to_the_samples_at_which_it_switches() {
    let (mut session, file, fit) = fitted(0.0);
    let mut ask = |request| ask(&mut session, request);
    let seen = ask(json!({"request": "plane", "fit": fit, "kind": "weights"})).unwrap();
    let count = seen["levels"].as_array().unwrap().len();
    let mut walked = 0;
    for (i, j) in [(1, 1), (1, count), (2, count / 2), (count, count)] {
        let mut after = serde_json::Value::Null;
        for _ in 0..4 {
            let switch = json!({"request": "switch", "fit": fit, "file": file, "operator": [i, j],
                "after": after});
            let Ok(found) = ask(switch) else { break };
            let row = found["number"].as_u64().unwrap();
            let mut is_on = |row: u64| {
                let time = found["time"].as_f64().unwrap()
                    - 0.1 * (found["number"].as_f64().unwrap() - row as f64);
                let at =
                    json!({"request": "plane", "fit": fit, "kind": "states", "at": [file, time]});
                let seen = ask(at).unwrap();
                assert_eq!(seen["sample"]["number"], row);
                seen["values"][j - 1][i - 1].as_f64().unwrap() >= 0.5
            };
            assert_ne!(is_on(row - 1), is_on(row), "operator {i}, {j} at row {row}");
            after = found["time"].clone();
            walked += 1;
        }
    }
    assert!(walked >= 8, "{walked}");
    for operator in [[0, 1], [2, 1], [1, count + 1]] {
        let switch = json!({"request": "switch", "fit": fit, "file": file, "operator": operator});
        assert!(ask(switch).is_err(), "{operator:?}");
    }
}

#[test]
fn a_play_through_the_time_shows_what_a_jump_shows() {
    let (mut session, file, fit) = fitted(0.0);
    let plane =
        |at: f64| json!({"request": "plane", "fit": fit, "kind": "states", "at": [file, at]});
    for at in [3.0, 3.1, 20.0, 59.9, 7.0] {
        let gone_on = ask(&mut session, plane(at)).unwrap();
        ask(&mut session, plane(0.0)).unwrap();
        let jumped = ask(&mut session, plane(at)).unwrap();
        assert_eq!(gone_on, jumped, "at {at}");
        let stairs: Vec<[f64; 2]> = serde_json::from_value(gone_on["staircase"].clone()).unwrap();
        // From the edge to the diagonal, never left nor up.
        assert_eq!(stairs[0][0], 0.0);
        let [a, b] = *stairs.last().unwrap();
        assert_eq!(a, b);
        for step in stairs.windows(2) {
            assert!(
                step[1][0] >= step[0][0] && step[1][1] <= step[0][1],
                "{stairs:?}"
            );
        }
        // Cells wholly below the line are on, and cells wholly above it are off.
        let height = |alpha: f64| {
            let beyond = stairs.iter().filter(|point| point[0] <= alpha);
            beyond.map(|point| point[1]).fold(f64::INFINITY, f64::min)
        };
        let rows = gone_on["values"].as_array().unwrap();
        for (j, row) in rows.iter().enumerate() {
            for (i, state) in row.as_array().unwrap().iter().enumerate() {
                let Some(state) = state.as_f64() else {
                    continue;
                };
                let (left, top) = (i as f64, (j + 1) as f64);
                if height(left + 1.0) >= top && left + 1.0 <= a {
                    assert_eq!(state, 1.0, "cell {i} {j} of {stairs:?}");
                }
                if height(left) <= top - 1.0 {
                    assert_eq!(state, 0.0, "cell {i} {j} of {stairs:?}");
                }
            }
        }
        let sample = json!({"request": "sample", "file": file, "fits": [fit], "at": at});
        let sample = ask(&mut session, sample).unwrap();
        assert_eq!(sample["number"], gone_on["sample"]["number"]);
    }
}

#[test]
fn a_prepared_file_is_fitted_and_its_raw_line_stays() {
    let (mut session, file, _) = fitted(0.6);
    let view = json!({"request": "curves", "file": file, "picture": "input", "raw": true,
        "pixels": [600, 400]});
    let seen = ask(&mut session, view.clone()).unwrap();
    assert_eq!(seen["lines"].as_array().unwrap().len(), 1);
    let refused = json!({"request": "prepare", "file": file, "steps": {"spikes": "many"}});
    assert_eq!(ask(&mut session, refused).unwrap_err().code, 102);
    let steps = json!({"request": "prepare", "file": file, "steps": {"resample": "off"}});
    let done = ask(&mut session, steps).unwrap();
    let report = &done["files"][0]["preparation"][0];
    assert_eq!(report["spikes"]["input"]["first"], json!([301]));
    // Noise of 0.6 evenly over an interval of 1 has this deviation; a quarter is for its estimate.
    let noise = report["input_noise"].as_f64().unwrap();
    assert!(
        (noise / (0.6 / 12.0_f64.sqrt()) - 1.0).abs() < 0.25,
        "{noise}"
    );
    let seen = ask(&mut session, view).unwrap();
    let most = |line: &Value| {
        let values = line["y"].as_array().unwrap().iter();
        values.filter_map(Value::as_f64).fold(0.0, f64::max)
    };
    assert_eq!(seen["lines"][0]["raw"], true);
    assert!(most(&seen["lines"][0]) == 400.0 && most(&seen["lines"][1]) < 100.0);
    let options = json!({"levels": "8", "bootstrap": "0"});
    let fit = ask(&mut session, json!({"request": "fit", "options": options})).unwrap();
    for (what, part) in [
        ("command", "--prepare --resample off"),
        ("python", "pyhysteron.prepare(pyhysteron.read(\"run.csv\""),
        (
            "rust",
            "PrepareOptions { resample: Step::Off, ..PrepareOptions::default() }",
        ),
    ] {
        let taken = json!({"request": "take", "what": what, "fit": fit});
        let bytes = ask(&mut session, taken).unwrap()["bytes"].clone();
        let text = String::from_utf8(serde_json::from_value(bytes).unwrap()).unwrap();
        assert!(text.contains(part), "{text}");
    }
    let saved = ask(&mut session, json!({"request": "take", "what": "session"})).unwrap();
    let mut again = Session::new(1 << 28);
    again
        .open(
            "s.json",
            serde_json::from_value(saved["bytes"].clone()).unwrap(),
        )
        .unwrap();
    let same = ask(&mut again, json!({"request": "overview"})).unwrap();
    assert_eq!(same["files"][0]["preparation"], json!([report]));
    let raw = json!({"request": "prepare", "file": file});
    assert!(ask(&mut session, raw).unwrap()["files"][0]["preparation"] == json!([]));
}

#[test]
fn a_repair_is_told_before_it_is_made() {
    let mut session = Session::new(1 << 24);
    session
        .open("gaps.csv", "u,y\n1,2\n2,x\n3,4\n2,3\n".into())
        .unwrap();
    let seen = ask(&mut session, json!({"request": "overview"})).unwrap();
    let repair = &seen["files"][0]["repair"];
    assert_eq!(repair["samples"], 3);
    assert!(
        repair["notes"][0].as_str().unwrap().contains("line 3"),
        "{repair}"
    );
}

#[test]
fn a_path_leads_where_its_samples_lead_and_policies_go_side_by_side() {
    let (mut session, ..) = fitted(0.0);
    // Levels as far apart as the play is wide, so that there is a dead band.
    let options = json!({"levels": "15", "bootstrap": "0"});
    let fit = ask(&mut session, json!({"request": "fit", "options": options})).unwrap();
    let mut start = || ask(&mut session, json!({"request": "drive", "fit": fit})).unwrap();
    let (one, two) = (start(), start());
    let path = [35.0, 60.0, 41.0, 52.0, 30.0];
    let whole = json!({"request": "pull", "drive": one["drive"], "inputs": path});
    let whole = ask(&mut session, whole).unwrap();
    let mut last = Value::Null;
    for input in path {
        let pull = json!({"request": "pull", "drive": two["drive"], "input": input});
        last = ask(&mut session, pull).unwrap();
    }
    assert_eq!(whole["trail"], last["trail"]);
    // A rest at the turn, and down: both policies give the outputs.
    let up = json!({"request": "pull", "drive": one["drive"], "input": 60.0});
    let top = ask(&mut session, up).unwrap()["output"].as_f64().unwrap();
    let outputs: Vec<f64> = (-2..10_i32)
        .map(|n| top - 0.2 * f64::from(n.max(0)))
        .collect();
    let pull = json!({"request": "pull", "drive": one["drive"], "outputs": outputs});
    let seen = ask(&mut session, pull).unwrap();
    assert_eq!(
        (&seen["status"], &seen["rival"]["status"]),
        (&json!("ok"), &json!("ok"))
    );
    assert_eq!(seen["rival"]["policy"], "anticipate");
    for end in [&seen["output"], &seen["rival"]["output"]] {
        // The inverse is exact up to rounding.
        assert!((end.as_f64().unwrap() - outputs.last().unwrap()).abs() < 1e-9);
    }
    let moves: Vec<[f64; 3]> = serde_json::from_value(seen["moves"].clone()).unwrap();
    assert_eq!(moves.iter().map(|m| m[0]).collect::<Vec<_>>(), outputs);
    // While the target rests one holds its input; the other has crossed the dead band.
    let [_, hold, anticipate] = moves[1];
    assert!(
        (hold - 60.0).abs() < 1e-9 && anticipate < hold - 1.0,
        "{moves:?}"
    );
    for [_, hold, anticipate] in moves.iter().skip(3) {
        assert!((hold - anticipate).abs() < 1e-6, "{moves:?}");
    }
    // A path that is refused at its middle moves nothing.
    let bad = json!({"request": "pull", "drive": one["drive"], "inputs": []});
    assert_eq!(ask(&mut session, bad).unwrap_err().code, 102);
    let back = json!({"request": "pull", "drive": one["drive"], "input": 30.0});
    let back = ask(&mut session, back).unwrap();
    assert!(back["rival"].is_null() && back["moves"] == json!([]));
}

#[test]
fn a_profile_determines_what_the_recordings_do_not() {
    let (mut session, _, fit) = fitted(0.0);
    let wish = json!({"request": "design", "fit": fit, "heating": 2.0, "cooling": 1.0});
    let seen = ask(&mut session, wish.clone()).unwrap();
    let counts = |of: &str| serde_json::from_value::<[u64; 4]>(seen[of].clone()).unwrap();
    let (before, after) = (counts("counts_before"), counts("counts_after"));
    assert!(before[3] < 78, "{before:?}");
    assert_eq!(after, [0, 0, 0, 78]);
    let take = json!({"request": "take", "what": "profile", "fit": fit, "heating": 2.0,
        "cooling": 1.0});
    let taken = ask(&mut session, take).unwrap()["bytes"].clone();
    let text = String::from_utf8(serde_json::from_value(taken).unwrap()).unwrap();
    assert!(text.starts_with("time [s],input\n"));
    assert_eq!(
        text.lines().count() as u64 - 1,
        seen["samples"].as_u64().unwrap()
    );
    let command = seen["command"].as_str().unwrap();
    for part in [
        "--levels 12",
        "--heating-rate 2",
        "--from run.csv",
        "--input 'temperature [degC]'",
    ] {
        assert!(command.contains(part), "{command}");
    }
    let mut wrong = wish;
    wrong["heating"] = json!(-1.0);
    assert!(ask(&mut session, wrong).is_err());
}

/// Two columns may be the output: the page asks, names both, and asks no more once one is chosen.
#[test]
fn a_role_in_doubt_is_asked_for() {
    let mut session = Session::new(1 << 28);
    let rows = table(0.0);
    let mut rows = rows.lines().skip(1);
    let mut text = "temperature [degC],displacement [mm],position [mm]\n".to_owned();
    for row in rows.by_ref() {
        let cells: Vec<&str> = row.split(',').collect();
        text += &format!("{},{},{}\n", cells[1], cells[2], cells[2]);
    }
    let file = session.open("two.csv", text.into()).unwrap();
    let seen = ask(&mut session, json!({"request": "overview"})).unwrap();
    let doubts = &seen["files"][0]["doubts"];
    assert_eq!(doubts[0]["role"], "output");
    let names = doubts[0]["candidates"].as_array().unwrap().iter();
    let names: Vec<&Value> = names.map(|candidate| &candidate[0]).collect();
    assert_eq!(names, ["displacement [mm]", "position [mm]"]);
    let roles = json!({"input": "temperature [degC]", "output": "position [mm]"});
    let chosen = json!({"request": "columns", "file": file, "roles": roles});
    let seen = ask(&mut session, chosen).unwrap();
    assert_eq!(seen["files"][0]["doubts"], json!([]));
    assert_eq!(seen["files"][0]["problem"], Value::Null);
}

/// A clock that goes back begins a recording: no line goes from one to the next.
#[test]
fn a_line_ends_with_its_recording() {
    let mut session = Session::new(1 << 28);
    let once = table(0.0);
    // Other rows: the same ones would be there twice.
    let again = table(0.01);
    let again: String = again
        .lines()
        .skip(1)
        .map(|row| format!("{row}\n"))
        .collect();
    let file = session.open("twice.csv", (once + &again).into()).unwrap();
    let mend = json!({"request": "mend", "file": file, "on": true});
    ask(&mut session, mend).unwrap();
    for picture in ["input", "output", "loop"] {
        let view = json!({"request": "curves", "file": file, "picture": picture,
            "pixels": [600, 400]});
        let seen = ask(&mut session, view).unwrap();
        let line = seen["lines"][0]["y"].as_array().unwrap();
        let gaps = line.iter().filter(|y| y.is_null()).count();
        assert_eq!(gaps, 1, "{picture}");
    }
}
