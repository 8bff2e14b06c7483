//! The settings of a control loop around a model.

use super::algorithm::{CLOCK, CONTROL};
use super::constants::Constants;
use super::parts::Parts;
use super::real::{Number, unfit};
use super::stages::Staged;
use super::text::Beside;
use hysteron::control::Scheme;
use hysteron::{Error, Model, Policy, Remedy, Result, Setting, Sign};
use std::fmt::Write;

/// Sums of intervals that differ by less than this share are one time, as in the library.
const ROUNDING: f64 = 1e-9;

/// Refuses what the loop cannot do on the target.
pub(super) fn check<T: Number>(
    scheme: &Scheme,
    model: &Model,
    constants: &Constants<T>,
    dt: Option<f64>,
) -> Result<()> {
    let refused = |what: &str| Err(Error::Export(what.into()));
    if model.load.is_some() {
        let remedy = Remedy::new("export it at one load with {}", [Setting::any("load")]);
        let what = "the controller has no reading of a load";
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    if constants.rounding.is_none() {
        let what = "a model with weights below zero has no inverse, which the controller needs";
        let remedy = Remedy::new("fit with {}", [Setting::word("solver", "nnls")]);
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    if dt.is_some_and(|dt| dt != scheme.interval_s) {
        return refused("model and controller have different sample times");
    }
    if scheme.inner.is_some() {
        return refused("an inner loop is not to be had on the target");
    }
    if scheme.commands != scheme.drives || scheme.policy != Policy::Hold {
        return refused("the commands are the drives on the target, and headings are given there");
    }
    // The library's own checks.
    hysteron::control::Controller::new(Scheme {
        compensator: None,
        ..scheme.clone()
    })?;
    Ok(())
}

/// Samples by which the output answers a drive too late.
pub(super) fn late(scheme: &Scheme, model: &Model) -> usize {
    let next = 1 + model.delay().at(Some(scheme.interval_s));
    scheme.delay.unwrap_or(next).saturating_sub(1)
}

pub(super) fn text<T: Number>(
    scheme: &Scheme,
    model: &Model,
    name: &str,
    staged: Option<&Staged<T>>,
    parts: Parts,
) -> Result<Beside> {
    let shout = name.to_uppercase();
    let late = late(scheme, model);
    let gains = scheme.pid.unwrap_or(hysteron::control::Gains {
        gain: 0.0,
        integral_s: 0.0,
        derivative_s: 0.0,
    });
    let (low, high) = scheme.drives;
    let (off, on) = model.output_range();
    let mut numbers = vec![
        ("dt", scheme.interval_s),
        ("gain", gains.gain),
        ("integral_s", gains.integral_s),
        ("derivative_s", gains.derivative_s),
        ("tolerance", scheme.tolerance),
        ("drive_min", low),
        ("drive_max", high),
        ("safe", 0f64.max(low).min(high)),
        ("slew", scheme.slew.unwrap_or(0.0)),
        ("range", (on - off).abs()),
        (
            "repeats_s",
            scheme.stuck_s.unwrap_or(0.0) * (1.0 - ROUNDING),
        ),
        ("lost_s", scheme.safety.lost_s.unwrap_or(0.0)),
        ("stuck_s", scheme.safety.stuck_s.unwrap_or(0.0)),
    ];
    numbers.extend(scheme.gate.map(|gate| ("gate", gate)));
    numbers.extend(parts.filter.then_some(("filter_s", scheme.filter_s)));
    let bits = parts.bits();
    let times = staged
        .filter(|_| parts.clock)
        .map(|staged| times(name, staged));
    let mut defined = times.unwrap_or_default();
    let _ = write!(
        defined,
        "\nconst hys_control {name}_control = {{\n    .model = &{},\n    .late = {late},\n",
        match staged {
            Some(_) => "hys_staged_in_loop",
            None => "hys_plain_in_loop",
        }
    );
    if parts.clock {
        defined += "    .clock = &times.clock,\n";
    }
    if bits > 0 {
        let _ = writeln!(defined, "    .has = {bits},");
    }
    for (field, number) in numbers {
        let number =
            T::nearest(number).ok_or_else(|| unfit(&format!("`{field}` of {number:e}")))?;
        let _ = writeln!(defined, "    .{field} = {},", number.literal());
    }
    let _ = write!(
        defined,
        "    .feedback = {},\n    .falls = {}\n}};\n",
        usize::from(scheme.pid.is_some()),
        usize::from(model.sign() == Sign::Negative),
    );
    // A model that was exported later, without these parts, took them out of the folder.
    let check = format!(
        "#if (HYS_LOOP & {bits}u) != {bits}u
#error \"{name}: export all models of this folder with the same parts of a loop\"
#endif
"
    );
    Ok(Beside {
        include: Some(match parts.clock {
            true => CLOCK[0].0,
            false => CONTROL[0].0,
        }),
        sizes: match bits {
            0 => format!("#define {shout}_LATE {late}\n"),
            _ => format!("#define {shout}_LATE {late}\n{check}"),
        },
        declared: format!("extern const hys_control {name}_control;\n"),
        defined,
    })
}

/// Defines the time constants of a model whose time is measured.
fn times<T: Number>(name: &str, staged: &Staged<T>) -> String {
    let times = staged.times().map(|time| time.literal());
    let [heating, cooling, behind @ ..] = times;
    let behind = behind.join(", ");
    format!(
        "\nstatic const hys_times times = {{\n    .clock = {{hys_clock_pass}},\n    \
         .model = &{name},\n    .heating = {heating},\n    .cooling = {cooling},\n    \
         .behind = {{{behind}}}\n}};\n"
    )
}
