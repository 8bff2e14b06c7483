//! A fit whose levels, smoothness or bootstrap are left to the data.

use crate::error::{Error, Result};
use crate::identify::choose::validate::{Candidates, cross_validate};
use crate::identify::fit_experiment;
use crate::identify::options::FitOptions;
use crate::identify::stages::body::fit_thermal;
use crate::model::Model;
use crate::progress::Watch;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};

/// What is not taken from the options but chosen, each where it is true.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Open {
    /// The number of levels, by the error on branches left out.
    pub levels: bool,
    /// The strength of the smoothness, in the same way.
    pub smooth: bool,
    /// The replicates, as [`FitOptions::usual_bootstrap`] has them for the levels that it comes to.
    pub bootstrap: bool,
}

/// All that a fit may be asked for, in one: chooses what is `open`, then identifies the weights, with `thermal` behind a
/// thermal body. What [`cross_validate`] found goes with the model.
///
/// ```
/// use hysteron::{FitOptions, Open, Recording, identify};
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let output = input.iter().map(|t| 0.5 * t).collect();
/// let open = Open { levels: true, ..Open::default() };
/// let recordings = [Recording::new(input, output)?];
/// let model = identify(&recordings, &FitOptions::default(), open, false, &|_, _| Ok(()))?;
/// assert!(model.fit.is_some_and(|fit| fit.validation.is_some()));
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// As [`fit_experiment`] and [`fit_thermal`]; [`Error::Fit`] for levels or smoothness left open behind a thermal body.
pub fn identify(
    recordings: &[Recording],
    options: &FitOptions,
    open: Open,
    thermal: bool,
    watch: Watch<'_>,
) -> Result<Model> {
    let mut options = options.clone();
    let mut validation = None;
    if open.levels || open.smooth {
        if thermal {
            let what = "behind a thermal body neither levels nor smoothness can be chosen";
            let settings = [Setting::any("levels"), Setting::any("smooth")];
            let remedy = Remedy::new("give {} and {} yourself", settings);
            return Err(Error::Fit(what.into()).remedied(remedy));
        }
        let candidates = Candidates::new(
            (!open.levels).then_some(options.levels),
            (!open.smooth).then_some(options.smooth),
        );
        let (chosen, found) = cross_validate(recordings, &options, &candidates, watch)?;
        options = chosen;
        validation = Some(found);
    }
    if open.bootstrap {
        options.bootstrap = FitOptions::usual_bootstrap(options.levels);
    }
    let mut model = match thermal {
        false => fit_experiment(recordings, &options, watch)?,
        true => fit_thermal(recordings, &options, watch)?,
    };
    if let Some(fit) = &mut model.fit {
        fit.validation = validation;
    }
    Ok(model)
}
