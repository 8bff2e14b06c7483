//! What is written, and what is refused before anything is.

use hysteron::{Destination, Model, Operator, Plane, Quantity, Sign};
use hysteron_export::{COptions, CReal, c};
use std::path::Path;

fn model(min: f64, max: f64, weights: [f64; 3], offset: f64) -> Model {
    let plane = Plane::new(min, max, 2).unwrap();
    Model::new(
        Operator::Mkp,
        plane,
        weights.to_vec(),
        offset,
        Sign::Positive,
    )
    .unwrap()
}

fn options(real: CReal) -> COptions<'static> {
    COptions {
        real,
        name: None,
        source: Path::new("folder/some spring.json"),
        adaptation: false,
    }
}

fn refused(model: &Model, folder: &Path, options: &COptions<'_>) -> String {
    c(model, folder, options).unwrap_err().to_string()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn the_algorithm_and_two_files_that_name_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("a/b");
    let mut model = model(20.0, 80.0, [1.0, 0.0, 0.5], 0.1);
    model.input = Quantity::with_unit("temperature */ \\", "°C");
    model.output = Quantity::with_unit("torque", "N*m");
    let export = c(&model, &inner, &options(CReal::Float)).unwrap();
    assert_eq!(export.name, "some_spring");
    let expected = [
        "hysteron_mcu.c",
        "hysteron_mcu.h",
        "hysteron_mcu_internal.h",
        "hysteron_mcu_inverse.c",
        "some_spring.c",
        "some_spring.cmake",
        "some_spring.h",
        "some_spring.mk",
    ];
    assert_eq!(names(&inner), expected);
    let header = std::fs::read_to_string(inner.join("some_spring.h")).unwrap();
    for part in [
        "the model of some spring.json",
        "K = 2 levels, 2 of 3 operators",
        "temperature ./ ? [degC]",
        "torque [N.m]",
        "#define SOME_SPRING_LEVELS 2\n",
        "#define SOME_SPRING_TURNS 16\n",
        &format!("{} bytes of constants", export.memory.constants),
    ] {
        assert!(header.contains(part), "{part}: {header}");
    }
    assert!(header.is_ascii());
    // The algorithm is under a licence, the model is not.
    for file in expected {
        let text = std::fs::read_to_string(inner.join(file)).unwrap();
        let ours = file.starts_with("hysteron_mcu");
        assert_eq!(text.contains("SPDX-License-Identifier"), ours, "{file}");
    }
    // Written again, and a second model beside the first.
    c(&model, &inner, &options(CReal::Float)).unwrap();
    let named = COptions {
        name: Some("left"),
        ..options(CReal::Float)
    };
    c(&model, &inner, &named).unwrap();
    assert_eq!(names(&inner).len(), 12);
}

#[test]
fn adaptation_is_an_option() {
    let folder = tempfile::tempdir().unwrap();
    let learns = COptions {
        adaptation: true,
        ..options(CReal::Float)
    };
    let plain = c(
        &model(20.0, 80.0, [1.0; 3], 0.0),
        folder.path(),
        &options(CReal::Float),
    )
    .unwrap();
    assert_eq!((plain.files.len(), plain.memory.adaptation), (8, None));
    let export = c(&model(20.0, 80.0, [1.0; 3], 0.0), folder.path(), &learns).unwrap();
    assert_eq!(export.files.len(), 13);
    assert_eq!(names(folder.path()).len(), 13);
    // The weights join the constants, and six tables with their coefficients.
    assert!(export.memory.constants > plain.memory.constants + (3 + 6 * 6 + 6) * 4);
    let header = std::fs::read_to_string(folder.path().join("some_spring.h")).unwrap();
    for line in [
        "#define SOME_SPRING_OPERATORS 3\n",
        "#define SOME_SPRING_INCREMENTS_NUMBERS 38\n",
        "extern const hys_adapt_options some_spring_drift;\n",
    ] {
        assert!(header.contains(line), "{header}");
    }
    let empty = tempfile::tempdir().unwrap();
    let said = refused(
        &model(20.0, 80.0, [1.0, -1.0, 1.0], 0.0),
        empty.path(),
        &learns,
    );
    assert!(said.contains("below zero"), "{said}");
    assert!(names(empty.path()).is_empty());
}

#[test]
fn what_others_wrote_stays() {
    let folder = tempfile::tempdir().unwrap();
    let model = model(20.0, 80.0, [1.0; 3], 0.0);
    let theirs = folder.path().join("some_spring.c");
    std::fs::write(&theirs, "int x;\n").unwrap();
    let keeping = Destination::keeping_foreign(folder.path(), false);
    let said = c(&model, keeping, &options(CReal::Float)).unwrap_err();
    assert!(said.to_string().contains("some_spring.c"), "{said}");
    assert_eq!(names(folder.path()), ["some_spring.c"]);
    assert_eq!(std::fs::read_to_string(&theirs).unwrap(), "int x;\n");
    // A path alone replaces it; then it is ours, until it is edited.
    c(&model, folder.path(), &options(CReal::Float)).unwrap();
    c(&model, keeping, &options(CReal::Float)).unwrap();
    let edited = std::fs::read_to_string(&theirs).unwrap() + "int x;\n";
    std::fs::write(&theirs, &edited).unwrap();
    assert!(c(&model, keeping, &options(CReal::Float)).is_err());
    assert_eq!(std::fs::read_to_string(&theirs).unwrap(), edited);
}

#[test]
fn a_folder_has_one_number_type() {
    let folder = tempfile::tempdir().unwrap();
    let model = model(20.0, 80.0, [1.0; 3], 0.0);
    c(&model, folder.path(), &options(CReal::Double)).unwrap();
    let before = std::fs::read(folder.path().join("hysteron_mcu.h")).unwrap();
    let other = COptions {
        name: Some("other"),
        ..options(CReal::Float)
    };
    let said = refused(&model, folder.path(), &other);
    assert!(said.contains("`real` double"), "{said}");
    assert_eq!(names(folder.path()).len(), 8);
    assert_eq!(
        std::fs::read(folder.path().join("hysteron_mcu.h")).unwrap(),
        before
    );
}

#[test]
fn what_does_not_fit_float_asks_for_double() {
    let cases = [
        (
            "levels that coincide",
            model(1000.0, 1000.0 + 1e-5, [1.0; 3], 0.0),
        ),
        ("a level that overflows", model(0.0, 1e39, [1.0; 3], 0.0)),
        ("a range that overflows", model(-3e38, 3e38, [1.0; 3], 0.0)),
        ("a level too small", model(1e-40, 1.0, [1.0; 3], 0.0)),
        (
            "a weight that overflows",
            model(0.0, 1.0, [1.0, 1e39, 1.0], 0.0),
        ),
        (
            "a sum that overflows",
            model(0.0, 1.0, [3e38, 3e38, 0.0], 0.0),
        ),
        (
            "an output that overflows",
            model(0.0, 1.0, [1e38, 0.0, 0.0], 3e38),
        ),
        (
            "a weight too small",
            model(0.0, 1.0, [1.0, 1e-40, 1.0], 0.0),
        ),
        (
            "weights with rounding too small",
            model(0.0, 1.0, [1e-35; 3], 0.0),
        ),
        ("an offset too small", model(0.0, 1.0, [1.0; 3], 1e-45)),
    ];
    for (what, model) in cases {
        let folder = tempfile::tempdir().unwrap();
        let said = refused(&model, folder.path(), &options(CReal::Float));
        assert!(said.contains("`real` double"), "{what}: {said}");
        assert!(names(folder.path()).is_empty(), "{what}");
        c(&model, folder.path(), &options(CReal::Double)).unwrap();
    }
}

#[test]
fn a_folder_that_cannot_be_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let model = model(20.0, 80.0, [1.0; 3], 0.0);
    let said = refused(&model, &file, &options(CReal::Float));
    assert!(said.contains("file"), "{said}");
}
