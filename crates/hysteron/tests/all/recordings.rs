//! Fits of real recordings. Those that are absent are skipped, and named.

use crate::common::shared;
use hysteron::{Columns, Fit, FitOptions, Operator, Recording, Repair, Solver};

/// RMSE over all rows at the optimum, from SciPy 1.17 on the dense matrix with a free offset
/// (`scipy.optimize.nnls`, `numpy.linalg.lstsq`), plane 0 to 3.5, all off at the start.
const SCIPY: [(usize, f64, f64); 4] = [
    (10, 0.201233, 0.194431),
    (20, 0.082333, 0.068069),
    (30, 0.055303, 0.031761),
    (40, 0.046621, 0.000000),
];

#[test]
fn the_optimum_is_scipys() {
    let [Some(path)] = shared(["sma_basaeri_train.csv"]) else {
        return;
    };
    let columns = Columns::new("voltage_V", "output");
    let recording = Recording::read(&path, columns, Repair::Refuse).unwrap().0;
    for (levels, nnls, ols) in SCIPY {
        for (solver, expected) in [(Solver::Nnls, nnls), (Solver::Ols, ols)] {
            let options = FitOptions {
                levels,
                range: Some((0.0, 3.5)),
                solver,
                ridge: 0.0,
                ..FitOptions::plain()
            };
            let model = Fit::from(&options).run(&recording).unwrap();
            let rmse = model.fit.unwrap().rmse;
            println!("K = {levels}, {solver:?}: {rmse:.6}, SciPy {expected:.6}");
            // The reference is given to six decimals.
            assert!(
                (rmse - expected).abs() <= 0.5e-6 + 1e-9,
                "K = {levels}, {solver:?}: {rmse}"
            );
        }
    }
}

#[test]
fn with_a_free_offset_kp_fits_as_mkp_does() {
    let [Some(path)] = shared(["sma_basaeri_train.csv"]) else {
        return;
    };
    let columns = Columns::new("voltage_V", "output");
    let recording = Recording::read(&path, columns, Repair::Refuse).unwrap().0;
    let errors = [Operator::Mkp, Operator::Kp].map(|operator| {
        let options = FitOptions {
            operator,
            levels: 10,
            ..FitOptions::plain()
        };
        Fit::from(&options)
            .run(&recording)
            .unwrap()
            .fit
            .unwrap()
            .rmse
    });
    assert!((errors[0] - errors[1]).abs() < 1e-9 * errors[0]);
}
