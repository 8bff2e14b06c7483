//! Preparation of real recordings. Those that are absent are skipped, and named.

use crate::common::shared;
use hysteron::{
    Columns, Fit, FitOptions, PrepareOptions, Progress, Recording, Repair, Step, prepare,
    rate_dependence,
};
use std::path::PathBuf;

/// Name, time, input and output of every recording.
const RECORDINGS: [(&str, Option<&str>, &str, &str); 28] = [
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
        None, // its clock is too coarse: most times come twice
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
];

/// Every recording that is there.
fn recordings() -> Vec<(&'static str, Recording)> {
    let paths = shared(RECORDINGS.map(|(name, ..)| format!("{name}.csv")));
    let read = |((name, time, input, output), path): (_, Option<PathBuf>)| {
        let columns = Columns {
            time,
            ..Columns::new(input, output)
        };
        let recording = Recording::read(&path?, columns, Repair::Refuse).unwrap().0;
        Some((name, recording))
    };
    RECORDINGS.into_iter().zip(paths).filter_map(read).collect()
}

fn nrmse(recording: &Recording) -> f64 {
    let model = Fit::from(FitOptions::plain()).run(recording).unwrap();
    model.fit.unwrap().nrmse_percent
}

/// Percent of the range that two series differ by, rms.
fn difference(a: &[f64], b: &[f64], range: (f64, f64)) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    100.0 * (squares / a.len() as f64).sqrt() / (range.1 - range.0)
}

/// Recordings with noise that is worth a step: a flickering thermometer, a noisy one, a noisy
/// position. All others come out as they went in.
const NOISY: [&str; 3] = [
    "sma_isobaric_cycles_1_to_4",
    "sma_nitico_walgren_200MPa",
    "sma_baraghini_Step02",
];

/// The recordings of a valve. Not that of a pseudo-random drive (`prbn_1`): the valve cannot follow
/// its shortest steps, and a model without dynamics errs less without some of them.
#[test]
fn recordings_of_a_valve_come_out_as_they_went_in() {
    let names = ["100Hz", "20Hz", "sine100_1", "sine50_1"];
    let paths = shared(names.map(|name| format!("valve_{name}.csv")));
    for (name, path) in names.into_iter().zip(paths) {
        let Some(path) = path else { continue };
        let columns = Columns {
            time: Some("time_s"),
            ..Columns::new("voltage_V", "position")
        };
        let recording = Recording::read(&path, columns, Repair::Refuse).unwrap().0;
        let (prepared, report) =
            prepare(&recording, &PrepareOptions::default(), Progress::NONE).unwrap();
        assert!(prepared == recording, "{name}: {:?}", report.judged);
    }
}

/// Readings that dropped to zero between −2 and −8 °C, counted from 1; and in the second recording
/// (586) a single reading that sticks out of a cooling ramp by 1.7 °C, which may be true.
fn expected_spikes(name: &str) -> &'static [usize] {
    match name {
        "sma_bend_3load" => &[534, 538, 1417, 1418, 1627, 1630, 2541],
        "sma_isobaric_cycles_1_to_4" => &[586, 624, 626, 711],
        _ => &[],
    }
}

#[test]
fn spikes_are_taken_from_the_two_that_have_them_and_nothing_gets_worse() {
    println!(
        "| recording | noise of input, output (% of range) | spikes | false reversals | changed, input, output (% of range) | error, before (%) | after |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, recording) in recordings() {
        let (prepared, report) =
            prepare(&recording, &PrepareOptions::default(), Progress::NONE).unwrap();
        let spikes = report.spikes.unwrap();
        // Left to the data, only those are taken that cost something: where the output is flat, a
        // wrong input changes no model.
        let expected = expected_spikes(name);
        assert!(
            spikes.input.first.iter().all(|n| expected.contains(n)),
            "{name}"
        );
        let asked = PrepareOptions {
            spikes: Step::Value(4.0),
            ..PrepareOptions::all(Step::Off)
        };
        let (_, all) = prepare(&recording, &asked, Progress::NONE).unwrap();
        assert_eq!(all.spikes.unwrap().input.first, expected, "{name}");
        assert_eq!(
            (spikes.input.signs, spikes.output.first.len()),
            (0, 0),
            "{name}"
        );
        // Where time is irregular there is too little noise to ask for a filter.
        assert_eq!(prepared.len(), recording.len(), "{name}");
        let (input, output) = recording.ranges();
        let changed = [
            difference(&recording.input, &prepared.input, input),
            difference(&recording.output, &prepared.output, output),
        ];
        let [before, after] = [&recording, &prepared].map(nrmse);
        println!(
            "| {name} | {:.3}, {:.3} | {} | {} | {:.3}, {:.3} | {before:.3} | {after:.3} |",
            100.0 * report.input_noise / (input.1 - input.0),
            100.0 * report.output_noise / (output.1 - output.0),
            spikes.input.spikes,
            report.dead_band.unwrap().false_reversals,
            changed[0],
            changed[1],
        );
        let same = prepared == recording;
        assert!(same || NOISY.contains(&name), "{name}: {:?}", report.judged);
        // Smoothing narrows the range that errors are measured by, by half a per cent of itself.
        assert!(after <= 1.01 * before, "{name}: {before} to {after}");

        let (again, _) = prepare(&prepared, &PrepareOptions::default(), Progress::NONE).unwrap();
        // The noise that stays may be just above the 0.05 % that is left alone, and asks for a
        // second, gentler filter.
        assert!(
            difference(&again.input, &prepared.input, input) < 0.1,
            "{name}"
        );
        assert!(
            difference(&again.output, &prepared.output, output) < 0.1,
            "{name}"
        );
    }
}

#[test]
fn only_the_wires_without_a_thermometer_depend_on_rate() {
    println!(
        "| recording | rate (% of range) | R², time | R², path | time constant (s) | error of a static model (%) |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    for (name, recording) in recordings() {
        let Some(rate) = rate_dependence(&recording).unwrap() else {
            assert_eq!(recording.time, None, "{name}");
            continue;
        };
        println!(
            "| {name} | {:.4} | {:.3} | {:.3} | {:.3} | {:.3} |",
            rate.percent, rate.r2_time, rate.r2_path, rate.time_constant, rate.nrmse_percent
        );
        assert_eq!(
            rate.is_material(),
            name.starts_with("sma_baraghini"),
            "{name}"
        );
    }
}
