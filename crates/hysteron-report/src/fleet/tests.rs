#![allow(clippy::unwrap_used)]

use crate::made::Made;
use crate::report::{Report, Shown};
use hysteron::{FleetRow, Model, Norm, Operator, Plane, Sign, operators};

/// A loop with the weight around one operator; `n` varies it a little.
fn row(n: usize, width: f64) -> FleetRow {
    let plane = Plane::new(20.0, 80.0, 10).unwrap();
    let off = (n as f64 * 0.7).sin();
    let weight = |(i, j): (usize, usize)| {
        let (gap, middle) = ((j - i) as f64, 0.5 * (i + j) as f64);
        let near = (gap - width - 0.1 * off).powi(2) + (middle - 5.5 - 0.2 * off.cos()).powi(2);
        (-0.5 * near).exp() * (1.0 + 0.01 * (n as f64).cos())
    };
    let weights = operators(10).map(weight).collect();
    let model = Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive).unwrap();
    let fit = hysteron::Recording::new(vec![0.0, 100.0, 0.0], vec![0.0, 1.0 + off, 0.1]).unwrap();
    let fitted = hysteron::Fit::new()
        .levels(2)
        .bootstrap(0)
        .smooth(0.0)
        .run(&fit)
        .unwrap();
    let mut model = model;
    model.fit = fitted.fit.map(|mut fit| {
        fit.nrmse_percent = 0.5 + 0.1 * (n as f64 * 1.3).sin();
        fit
    });
    FleetRow::of_model(&format!("<{n}>"), model)
}

#[test]
fn the_strangest_come_first_and_have_their_loops() {
    let mut rows: Vec<FleetRow> = (0..60).map(|n| row(n, 3.0)).collect();
    rows[17] = row(17, 6.0);
    let norm = Norm::from_rows(&rows).unwrap();
    let report = Report {
        title: "line",
        shown: Shown::Fleet {
            rows: &rows,
            norm: &norm,
        },
        made: Made::default(),
    };
    let folder = tempfile::tempdir().unwrap();
    let written = report.write(folder.path()).unwrap();
    // A page, and three figures as SVG and PNG.
    assert_eq!(written.len(), 7);
    let page = std::fs::read_to_string(&written[0]).unwrap();
    let table = page.split("<tbody>").nth(1).unwrap();
    let first = table.split("</tr>").next().unwrap();
    assert!(
        first.contains("&lt;17&gt;") && first.contains("width"),
        "{first}"
    );
    assert!(page.matches("deviations").count() >= 10);
    let none = Report {
        shown: Shown::Fleet {
            rows: &[],
            norm: &norm,
        },
        ..report
    };
    assert!(none.write(folder.path().join("none").as_path()).is_err());
    assert!(!folder.path().join("none").exists());
}
