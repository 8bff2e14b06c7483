//! Preparation of real recordings. The data stay in `../shared/data`; without them the tests say so and pass.
#![allow(clippy::unwrap_used)]

use hysteron::{Columns, FitOptions, PrepareOptions, Recording, fit, prepare, rate_dependence};
use std::path::Path;

/// Name, time, input and output of every recording.
const RECORDINGS: [(&str, Option<&str>, &str, &str); 30] = [
    ("bh_M130_27s_loop1", None, "H_A_per_m", "B_T"),
    ("bh_M130_27s_loop2", None, "H_A_per_m", "B_T"),
    ("bh_M130_27s_loop3", None, "H_A_per_m", "B_T"),
    ("bh_MnZn_ferrite_loop1", None, "H_A_per_m", "B_T"),
    ("bh_MnZn_ferrite_loop2", None, "H_A_per_m", "B_T"),
    ("bh_MnZn_ferrite_loop3", None, "H_A_per_m", "B_T"),
    ("bh_MnZn_ferrite_loop4", None, "H_A_per_m", "B_T"),
    ("bh_amorf_loop1", None, "H_A_per_m", "B_T"),
    (
        "ferro_rtwhiteA_forc5",
        Some("time_s"),
        "voltage_V",
        "polarization_uC_cm2",
    ),
    (
        "magnet_lcls2_quad_ru3",
        Some("time_min"),
        "current_A",
        "BL_T",
    ),
    (
        "magnet_lcls2_quad_ru4",
        Some("time_min"),
        "current_A",
        "BL_T",
    ),
    ("piezo_pnzt_S1_1500V", None, "voltage_V", "displacement_nm"),
    ("sma_baraghini_Ramp02", Some("time_s"), "duty", "position_m"),
    ("sma_baraghini_Step02", Some("time_s"), "duty", "position_m"),
    ("sma_basaeri_train", None, "voltage_V", "output"),
    (
        "sma_bend_3load",
        Some("time_s"),
        "temperature_C",
        "extension_mm",
    ),
    ("sma_flexinol_150MPa", None, "temperature_C", "strain"),
    ("sma_flexinol_200MPa", None, "temperature_C", "strain"),
    ("sma_flexinol_50MPa", None, "temperature_C", "strain"),
    (
        "sma_isobaric_cycles_1_to_4",
        Some("time_s"),
        "temperature_C",
        "extension_mm",
    ),
    ("sma_nitico_walgren_200MPa", None, "temperature_C", "strain"),
    ("sma_nitico_walgren_50MPa", None, "temperature_C", "strain"),
    ("sma_nitico_walgren_7MPa", None, "temperature_C", "strain"),
    (
        "sma_nitihf_bigelow_100MPa",
        None,
        "temperature_C",
        "strain_percent",
    ),
    (
        "sma_nitihf_bigelow_200MPa",
        None,
        "temperature_C",
        "strain_percent",
    ),
    (
        "sma_nitihf_bigelow_400MPa",
        None,
        "temperature_C",
        "strain_percent",
    ),
    (
        "sma_nitihf_bigelow_50MPa",
        None,
        "temperature_C",
        "strain_percent",
    ),
    (
        "sma_nitihf_bigelow_7MPa",
        None,
        "temperature_C",
        "strain_percent",
    ),
    (
        "ferro_rtwhiteA_forc5",
        None,
        "voltage_V",
        "polarization_uC_cm2",
    ),
    ("sma_bend_3load", None, "temperature_C", "extension_mm"),
];

/// Every recording that is there.
fn recordings() -> Vec<(&'static str, Recording)> {
    let folder = Path::new("/work/shared/data").to_owned();
    if !folder.exists() {
        eprintln!("skipped: {} is not there", folder.display());
        return Vec::new();
    }
    let read = |(name, time, input, output)| {
        let columns = Columns {
            time,
            ..Columns::new(input, output)
        };
        let path = folder.join(format!("{name}.csv"));
        (name, Recording::read_csv(&path, columns).unwrap())
    };
    RECORDINGS.into_iter().map(read).collect()
}

fn nrmse(recording: &Recording) -> f64 {
    let model = fit(recording, &FitOptions::default()).unwrap();
    model.fit.unwrap().nrmse_percent
}

#[test]
fn table() {
    println!(
        "| recording | noise of input, output (% of range) | spikes | cut-off | false reversals | error before | after |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, recording) in recordings() {
        let (prepared, report) = prepare(&recording, &PrepareOptions::default()).unwrap();
        let (input, output) = recording.ranges();
        let spikes = report.spikes.clone().unwrap();
        let low_pass = report.low_pass.clone().unwrap();
        let band = report.band.clone().unwrap();
        println!(
            "| {name} | {:.3}, {:.3} | {:?} {:?} | {} {:?} ({:.3} {:.3}) | {} (band {:.3} %, moved {} {:.3} %) | {:.3} | {:.3} |",
            100.0 * report.input_noise / (input.1 - input.0),
            100.0 * report.output_noise / (output.1 - output.0),
            spikes.input,
            spikes.output,
            report.resampled.is_some(),
            low_pass.input.as_ref().map(|l| l.cutoff),
            100.0 * low_pass.input.as_ref().map_or(0.0, |l| l.removed) / (input.1 - input.0),
            100.0 * low_pass.output.as_ref().map_or(0.0, |l| l.removed) / (output.1 - output.0),
            band.false_reversals,
            100.0 * band.size / (input.1 - input.0),
            band.samples_changed,
            100.0 * band.largest_change / (input.1 - input.0),
            nrmse(&recording),
            nrmse(&prepared),
        );
        let (again, r2) = prepare(&prepared, &PrepareOptions::default()).unwrap();
        let d = |a: &[f64], b: &[f64]| {
            (a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / a.len() as f64).sqrt()
        };
        if again.len() == prepared.len() {
            println!(
                "   again: {:?} {:?} in {:.5}% out {:.5}%  {:?} {:?}",
                r2.spikes.as_ref().unwrap().input.first,
                r2.spikes.as_ref().unwrap().output.first,
                100.0 * d(&again.input, &prepared.input) / (input.1 - input.0),
                100.0 * d(&again.output, &prepared.output) / (output.1 - output.0),
                r2.low_pass.unwrap(),
                r2.band.unwrap().false_reversals
            );
        } else {
            println!("   again LENGTH");
        }
        if let Some(r) = rate_dependence(&recording).unwrap() {
            println!("   RATE {r:?}");
        }
    }
}
