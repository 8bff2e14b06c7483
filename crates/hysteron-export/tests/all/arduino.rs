//! A library for Arduino: what is written, and what is refused before anything is.

use hysteron::control::{Gains, Safety, Scheme};
use hysteron::{Destination, FirstOrder, Model, Operator, Plane, Sign};
use hysteron_core::operator_count;
use hysteron_export::{Arduino, ArduinoOptions, Board, BoardMemory, CSampling, arduino};
use serde_json::json;
use std::path::Path;

fn model(levels: usize, body: bool) -> Model {
    let plane = Plane::new(0.0, 1.0, levels).unwrap();
    let weights = vec![1.0 / levels as f64; operator_count(levels)];
    let mut model = Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive).unwrap();
    model.thermal = body.then(FirstOrder::default);
    model
}

fn write(model: &Model, folder: &Path, board: Board) -> hysteron::Result<BoardMemory> {
    written(model, folder, board, false)
}

fn written(
    model: &Model,
    folder: &Path,
    board: Board,
    adaptation: bool,
) -> hysteron::Result<BoardMemory> {
    Ok(driven(model, folder, (board, adaptation), (0.0, 1.0))?.memory)
}

fn driven(
    model: &Model,
    folder: &Path,
    (board, adaptation): (Board, bool),
    drives: (f64, f64),
) -> hysteron::Result<Arduino> {
    let gains = Gains {
        gain: 0.05,
        integral_s: 0.5,
        derivative_s: 0.0,
    };
    let scheme = Scheme {
        pid: Some(gains),
        safety: Safety {
            lost_s: Some(0.5),
            stuck_s: Some(1.0),
        },
        ..Scheme::new(0.05, drives)
    };
    let options = ArduinoOptions {
        name: None,
        source: Path::new("my spring.json"),
        board,
        adaptation,
    };
    let sampling = CSampling {
        dt: model.is_timed().then_some(0.05),
        drive: None,
        ..CSampling::default()
    };
    let target = Destination::keeping_foreign(folder, false);
    arduino(model, target, &options, &sampling, &scheme)
}

#[test]
fn the_files_are_those_that_the_ide_looks_for() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("my_spring");
    write(&model(10, false), &library, Board::Uno).unwrap();
    let read = |name: &str| std::fs::read_to_string(library.join(name)).unwrap();
    for file in ["my_spring.c", "hysteron_mcu.c", "hysteron_mcu_control.c"] {
        assert!(library.join("src").join(file).exists(), "{file}");
    }
    // What the specification of Arduino's libraries asks for.
    let properties = read("library.properties");
    for field in [
        "name=my_spring\n",
        "\nversion=",
        "\nauthor=",
        "\nmaintainer=",
        "\nsentence=",
        "\nparagraph=",
        "\ncategory=Device Control\n",
        "\nurl=http",
        "\narchitectures=*\n",
        "\nincludes=my_spring.h\n",
    ] {
        assert!(properties.contains(field), "{field}: {properties}");
    }
    let json: serde_json::Value = serde_json::from_str(&read("library.json")).unwrap();
    assert_eq!(
        (&json["name"], &json["frameworks"]),
        (&"my_spring".into(), &"arduino".into())
    );
    assert!(read("keywords.txt").contains("hys_controller_step\tKEYWORD2\n"));
    for name in ["device", "standalone"] {
        let sketch = read(&format!("examples/{name}/{name}.ino"));
        assert!(!sketch.contains('@'), "{sketch}");
        assert!(sketch.lines().count() <= 150 && sketch.is_ascii());
        assert!(sketch.lines().all(|line| line.len() <= 100), "{name}");
    }
    // The parts of both sketches are one text.
    let [device, standalone] = ["device", "standalone"].map(|name| {
        let text = read(&format!("examples/{name}/{name}.ino"));
        let lines = text.lines().map(str::to_owned);
        let parts = lines.skip_while(|line| !line.starts_with("const uint8_t SENSOR"));
        parts.take(26).collect::<Vec<_>>()
    });
    assert_eq!(device, standalone);
    assert_eq!(device.last().map(String::as_str), Some("}"), "{device:?}");
    // Written again; but a sketch that was edited is kept.
    write(&model(12, false), &library, Board::Uno).unwrap();
    let mine = library.join("examples/device/device.ino");
    std::fs::write(&mine, "mine").unwrap();
    let error = write(&model(14, false), &library, Board::Uno).unwrap_err();
    assert!(error.to_string().contains("device.ino"), "{error}");
    assert_eq!(std::fs::read_to_string(mine).unwrap(), "mine");
    assert!(read("src/my_spring.h").contains("LEVELS 12"));
}

/// A drive beyond 0 to 1 would be full power: the sketch that drives alone is not written.
#[test]
fn what_drives_alone_has_a_share_of_full_power() {
    let folder = tempfile::tempdir().unwrap();
    for (n, (drives, board, alone)) in [
        ((0.0, 0.7), Board::Uno, true),
        ((0.0, 1.0), Board::Mega, true),
        ((20.0, 80.0), Board::Uno, false),
        ((0.0, 1.01), Board::Uno, false),
        ((-0.1, 1.0), Board::Uno, false),
    ]
    .into_iter()
    .enumerate()
    {
        let library = folder.path().join(format!("wire{n}"));
        let made = driven(&model(8, false), &library, (board, false), drives).unwrap();
        assert_eq!(made.standalone, alone, "{drives:?}");
        let sketch = std::fs::read_to_string(library.join("examples/standalone/standalone.ino"));
        assert_eq!(sketch.is_ok(), alone, "{drives:?}");
        // A Mega's sketch says so where it is compiled for another board.
        let told = sketch.is_ok_and(|text| text.contains("#error this sketch is for a Mega"));
        assert_eq!(told, board == Board::Mega);
        assert!(library.join("examples/device/device.ino").exists());
    }
}

/// A sketch for another model would drive this one: beside files of the user, too.
#[test]
fn no_sketch_of_an_earlier_export_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("wire");
    let export = |drives| driven(&model(8, false), &library, (Board::Uno, false), drives);
    let own = library.join("examples/mine/mine.ino");
    let sketch = library.join("examples/standalone/standalone.ino");
    export((0.0, 0.7)).unwrap();
    std::fs::create_dir_all(own.parent().unwrap()).unwrap();
    std::fs::write(&own, "mine").unwrap();
    std::fs::write(&sketch, "edited").unwrap();
    let error = export((20.0, 80.0)).unwrap_err().to_string();
    assert!(error.contains("standalone.ino"), "{error}");
    assert_eq!(std::fs::read_to_string(&sketch).unwrap(), "edited");
    std::fs::remove_file(&sketch).unwrap();
    export((0.0, 0.7)).unwrap();
    assert!(sketch.exists());
    export((20.0, 80.0)).unwrap();
    assert!(!sketch.parent().unwrap().exists());
    assert_eq!(std::fs::read_to_string(&own).unwrap(), "mine");
}

#[test]
fn what_does_not_fit_is_refused_with_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("wire");
    // A second state where there is room, one where there is not, and then no more.
    let follows = |levels| {
        write(&model(levels, false), &library, Board::Uno)
            .unwrap()
            .follows
    };
    assert!(follows(5) && !follows(20));
    // With a body ten levels have it: without it nobody sees a slider that jams.
    assert!(
        write(&model(10, true), &folder.path().join("warm"), Board::Uno)
            .unwrap()
            .follows
    );
    std::fs::remove_dir_all(&library).unwrap();
    let error = write(&model(60, false), &library, Board::Uno).unwrap_err();
    let said = error.to_string();
    for part in [
        "K = 60",
        "of flash",
        "of RAM",
        "ATmega328P",
        "32256 and 2048",
        "levels",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!library.exists());
    // avr-gcc: "size of array is too large".
    let error = write(&model(127, false), &library, Board::Mega).unwrap_err();
    assert!(
        error.to_string().contains("a table of 33024 bytes"),
        "{error}"
    );
    assert!(!library.exists());
    write(&model(126, false), &library, Board::Mega).unwrap();
    std::fs::remove_dir_all(&library).unwrap();
    let mega = write(&model(60, true), &library, Board::Mega).unwrap();
    assert!(mega.follows && mega.ram <= 8192, "{mega:?}");
    write(&model(200, true), &library, Board::Large).unwrap();
}

/// The stages that the bits of a number name, around five levels.
fn of_stages(bits: usize) -> Model {
    let has = |bit: usize| bits >> bit & 1 == 1;
    let mut file: serde_json::Value = serde_json::from_str(&model(5, false).to_json()).unwrap();
    file["version"] = 3.into();
    if has(0) {
        file["thermal"] = json!({
            "kind": "first-order", "ambient": -0.5, "gain": 2.0, "tau_heating": 2.0,
            "tau_cooling": 2.0,
        });
    }
    let mut stages = serde_json::Map::new();
    for (bit, name, numbers) in [
        (1, "latent", vec![0.3]),
        (2, "curve_sums", vec![0.0, 2.0, 3.0]),
        (2, "curve_outputs", vec![1.0, 2.0, 4.0]),
        (3, "ring_frequency", vec![2.0]),
        (3, "ring_damping", vec![0.1]),
        (4, "knots", vec![0.0, 0.6, 1.0]),
        (4, "rising", vec![0.1, 0.7, 1.1]),
    ] {
        if has(bit) {
            stages.insert(name.into(), numbers.into());
        }
    }
    file["stages"] = stages.into();
    if has(5) {
        file["creep"] = json!([{"coefficient": 0.1, "tau": 1.0}]);
    }
    if has(6) {
        file["spacing"] = vec![0.0, 0.1, 0.3, 0.5, 0.8, 1.0].into();
    }
    if has(7) {
        file["lag"] = 0.2.into();
    }
    Model::from_json(&file.to_string()).unwrap()
}

/// Of all combinations of stages: what is written fits, what is refused is not there, and a stage less
/// fits too. `firmware/avr/run` compiles some of them.
#[test]
fn a_model_that_does_not_fit_with_its_stages_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut fits = [None; 256];
    for bits in (0..256).filter(|bits| bits & 3 != 2) {
        let library = folder.path().join(format!("stages_{bits}"));
        let made = write(&of_stages(bits), &library, Board::Uno);
        fits[bits] = Some(made.is_ok());
        match made {
            Ok(memory) => assert!(memory.flash <= 32_256 && memory.ram <= 2048, "{bits}"),
            Err(error) => {
                assert!(
                    error.to_string().contains("bytes of flash"),
                    "{bits}: {error}"
                );
                assert!(!library.exists(), "{bits}");
            }
        }
    }
    for bits in (0..256).filter(|&bits| fits[bits] == Some(true)) {
        let less = (0..8).map(|bit| bits & !(1 << bit));
        assert!(
            less.into_iter().all(|less| fits[less] != Some(false)),
            "{bits}"
        );
    }
    // Both happen.
    assert!(fits.contains(&Some(true)) && fits.contains(&Some(false)));
}

#[test]
fn a_sketch_that_learns_is_written_where_it_fits() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("my_spring");
    let write =
        |levels, body, board| written(&model(levels, body), &library, board, true).map(|_| ());
    let refusals = [
        (
            5,
            false,
            Board::Uno,
            ["with a learner", "ATmega328P", "adaptation"],
        ),
        (20, false, Board::Mega, ["K = 20", "ATmega2560", "levels"]),
        (
            5,
            true,
            Board::Large,
            ["stages", "cannot learn", "adaptation"],
        ),
    ];
    for (levels, body, board, words) in refusals {
        let said = write(levels, body, board).unwrap_err().to_string();
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
        assert!(!library.exists());
    }
    for (levels, board) in [(10, Board::Mega), (20, Board::Large)] {
        write(levels, false, board).unwrap();
        let read = |name: &str| std::fs::read_to_string(library.join(name)).unwrap();
        let sketch = read("examples/standalone/standalone.ino");
        assert!(
            sketch.contains("hys_shadow_step(&shadow, mm, &action)"),
            "{sketch}"
        );
        assert!(
            !sketch.contains('@') && sketch.lines().count() <= 150,
            "{sketch}"
        );
        assert!(sketch.lines().all(|line| line.len() <= 100), "{sketch}");
        assert!(read("src/hysteron_mcu.h").contains("#define HYS_TABLES_IN_RAM\n"));
        assert!(library.join("src/hysteron_mcu_shadow.c").exists());
    }
}
