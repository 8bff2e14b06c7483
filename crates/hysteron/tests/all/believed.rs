//! What a model file says is refused, or the model behaves as written.

use hysteron::{Model, Quantity, Recording, Sample, evaluate};
use serde_json::{Value, json};

fn file() -> Value {
    json!({
        "format": "hysteron-model", "version": 2, "operator": "mkp",
        "plane": {"min": 1, "max": 2, "levels": 2}, "weights": [1.0, 1.0, 1.0],
        "input": {"unit": "degC"}, "output": {"offset": 2.0, "unit": "mm"},
        "load": {"min": 0, "max": 9,
            "parts": [{"offset": 0.0, "weights": [1.0, 0.5, 1.0]},
                {"offset": 4.0, "weights": [1.0, 1.5, 1.0]}],
            "curves": {"loads": [0.0, 9.0], "shifts": [0.0, 1.0], "scales": [1.0, 1.1],
                "gains": [1.0, 1.5], "offsets": [0.0, 0.1]}},
        "thermal": {"kind": "first-order", "ambient": 0.5, "gain": 2.0, "tau_heating": 1.0,
            "tau_cooling": 2.0},
        "drive": {"min": 0.0, "max": 1.0}, "spacing": [0.0, 1.0, 2.0],
        "creep": [{"coefficient": 0.1, "tau": 3.0}], "lag": 0.1,
    })
}

/// The places of all numbers in a file.
fn places(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at),
        Value::Array(all) => all
            .iter()
            .enumerate()
            .for_each(|(n, value)| places(value, format!("{at}/{n}"), found)),
        Value::Object(all) => all
            .iter()
            .for_each(|(name, value)| places(value, format!("{at}/{name}"), found)),
        _ => {}
    }
}

/// Each number of the file becomes each of these: the file is refused, or every output of its model
/// is finite and its text is read and written without a change.
#[test]
fn a_changed_number_is_refused_or_gives_finite_outputs() {
    let mut found = Vec::new();
    places(&file(), String::new(), &mut found);
    let values = [
        -1.0, 0.0, 1e-320, 1e-300, 1e-12, 1e-7, 0.3, 3.0, 1e5, 1e7, 1e12, 1e139, 1e200, 1e308,
        -1e308,
    ];
    let (mut refused, mut ran) = (0, 0);
    for place in &found {
        for value in values {
            let mut file = file();
            *file.pointer_mut(place).unwrap() = value.into();
            let Ok(model) = Model::from_json(&file.to_string()) else {
                refused += 1;
                continue;
            };
            let what = format!("{place} = {value:e}");
            let text = model.to_json();
            assert_eq!(Model::from_json(&text).unwrap().to_json(), text, "{what}");
            let mut state = model.start();
            for n in 0..40 {
                let sample = Sample {
                    input: f64::from(n % 7) / 6.0,
                    dt: Some([0.0, 1e-4, 0.3, 50.0][n as usize % 4]),
                    load: Some(f64::from(n % 10)),
                };
                if let Ok(step) = model.step(&mut state, sample) {
                    assert!(step.output.is_finite(), "{what}: {}", step.output);
                    ran += 1;
                }
            }
        }
    }
    println!("{refused} refused, {ran} steps");
    assert!(refused > 100 && ran > 2000, "{refused} {ran}");
}

#[test]
fn what_is_said_twice_agrees() {
    let refused = |place: &str, value: Value| {
        let mut file = file();
        *file.pointer_mut(place).unwrap() = value;
        Model::from_json(&file.to_string()).unwrap_err().to_string()
    };
    assert!(Model::from_json(&file().to_string()).is_ok());
    for (place, value, field) in [
        ("/weights", json!([10.0, 10.0, 10.0]), "`weights`"),
        ("/output/offset", json!(2.1), "`output.offset`"),
        ("/thermal", Value::Null, "`drive`"),
        ("/creep/0/coefficient", json!(1e308), "`creep`"),
        ("/thermal/gain", json!(1e200), "`thermal.gain`"),
        (
            "/thermal/tau_cooling",
            json!(1e-30),
            "`thermal.tau_cooling`",
        ),
        ("/lag", json!(1e30), "`lag`"),
    ] {
        let said = refused(place, value);
        assert!(said.contains(field), "{said}");
    }
}

#[test]
fn another_unit_is_named() {
    let text = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 20, "max": 80, "levels": 2}, "weights": [1, 1, 1],
        "input": {"unit": "degC"}, "output": {"unit": "mm"}}"#;
    let model = Model::from_json(text).unwrap();
    let mut recording = Recording::new(vec![20.0, 60.0, 30.0], vec![0.0, 2.0, 1.0]).unwrap();
    let with = |recording: &mut Recording, input: Option<&str>, output: Option<&str>| {
        let of = |name: &str, unit: Option<&str>| Quantity {
            name: name.into(),
            unit: unit.map(str::to_owned),
        };
        recording.input_quantity = of("T", input);
        recording.output_quantity = of("y", output);
        evaluate(&model, recording)
            .map(|_| ())
            .map_err(|error| error.to_string())
    };
    for same in [None, Some("degC"), Some("°C"), Some("[degC]")] {
        assert_eq!(with(&mut recording, same, Some("mm")), Ok(()));
    }
    let said = with(&mut recording, Some("K"), Some("mm")).unwrap_err();
    assert!(said.contains("degC") && said.contains("in K:"), "{said}");
    let said = with(&mut recording, Some("degC"), Some("m")).unwrap_err();
    assert!(said.contains("in mm") && said.contains("in m:"), "{said}");
}
