//! `hysteron fit`

use crate::{Result, args, print, recording, text};
use hysteron::{Columns, FitOptions, Operator, Sign, Solver};
use serde_json::json;

pub(crate) fn run(args: &args::Fit) -> Result<()> {
    let columns = Columns::new(&args.input, &args.output);
    let same = |a: &std::path::Path| a.canonicalize().ok();
    let replaced = |data: &std::path::PathBuf| same(data) == same(&args.out);
    if args.out.exists() && args.data.iter().any(replaced) {
        return Err(format!(
            "{}: the model would replace the recording: name another file",
            args.out.display()
        )
        .into());
    }
    let read = |data: &std::path::PathBuf| recording::read(data, columns, &args.repair);
    let recordings: Vec<_> = args.data.iter().map(read).collect::<Result<_>>()?;
    let mut recording = match <[_; 1]>::try_from(recordings) {
        Ok([recording]) => recording,
        Err(_) => return Err("a fit takes one recording: name one file".into()),
    };
    let units = [
        (&args.input_unit, &mut recording.input_quantity),
        (&args.output_unit, &mut recording.output_quantity),
    ];
    for (unit, quantity) in units {
        if unit.is_some() {
            quantity.unit.clone_from(unit);
        }
    }
    let (recording, preparation, rate) = prepare::before_fit(recording, &args.prepare)?;
    let options = FitOptions {
        operator: match args.operator {
            args::Operator::Mkp => Operator::Mkp,
            args::Operator::Kp => Operator::Kp,
            args::Operator::Relay => Operator::Relay,
        },
        levels: args.levels,
        range: args.range,
        solver: match args.solver {
            args::Solver::Nnls => Solver::Nnls,
            args::Solver::Ols => Solver::Ols,
        },
        sign: match args.sign {
            args::Sign::Auto => None,
            args::Sign::Positive => Some(Sign::Positive),
            args::Sign::Negative => Some(Sign::Negative),
        },
        offset: args.offset,
    };
    let model = hysteron::fit(&recording, &options)?;
    model.write(&args.out)?;

    let plane = model.plane();
    let inside = |t: &&f64| plane.clipped(**t).is_some();
    let clipped = recording.input.iter().filter(inside).count();
    if clipped > 0 {
        eprintln!(
            "hysteron: {clipped} of {} inputs lie outside the active range {} to {} and were taken as its ends: widen --range",
            recording.len(),
            text::number(plane.bottom()),
            text::number(plane.max())
        );
    }
    let Some(fit) = &model.fit else {
        return Ok(());
    };
    if args.json.json {
        return print(
            &json!({
                "model": args.out,
                "operators": plane.operators(),
                "plane": {"min": plane.min(), "max": plane.max(), "levels": plane.levels()},
                "offset": model.offset(),
                "sign": model.sign().factor() as i64,
                "clipped": clipped,
                "fit": fit,
                "preparation": preparation,
                "rate": rate,
            })
            .to_string(),
        );
    }
    let negative = model.weights().iter().filter(|mu| **mu < 0.0).count();
    print(&format!(
        "{}: {} samples, {} of {} weights not zero{}\nRMSE {} ({:.2} % of the range), largest error {}",
        args.out.display(),
        fit.samples,
        fit.weights_not_zero,
        plane.operators(),
        match negative {
            0 => String::new(),
            count => format!(", {count} below zero (no inverse)"),
        },
        text::with_unit(fit.rmse, &model.output),
        fit.nrmse_percent,
        text::with_unit(fit.max_abs, &model.output),
    ))
}
