//! The segments of a table are several recordings of one experiment, for everything that reads one.

use hysteron::{
    AdaptOptions, Columns, Errors, Fit, Learner, Model, Operator, Place, Plane, Progress,
    Recording, Repair, Sign, Start, adapt, evaluate_errors, evaluate_from, forward,
    inspect_recording,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A plant, and recordings of it, each from its start.
fn experiment(rng: &mut ChaCha8Rng, count: usize) -> (Model, Vec<Recording>) {
    let plane = Plane::new(20.0, 80.0, rng.random_range(3..8)).unwrap();
    let mut random = |high| rng.random_range(0.0..high);
    let weights = (0..plane.operators()).map(|_| random(1.0)).collect();
    let model = Model::new(Operator::Mkp, plane, weights, random(5.0), Sign::Positive).unwrap();
    let one = |rng: &mut ChaCha8Rng| {
        let rows = rng.random_range(40..120);
        let speed = rng.random_range(0.1..0.3);
        let input: Vec<f64> = (0..rows)
            .map(|n| 50.0 - 35.0 * (speed * f64::from(n)).cos() * rng.random_range(0.9..1.0))
            .collect();
        let output = model.simulate(&input).unwrap();
        let output = output.iter().map(|y| y + rng.random_range(-0.01..0.01));
        let mut recording = Recording::new(input.clone(), output.collect()).unwrap();
        recording.time = Some((0..rows).map(f64::from).collect());
        recording
    };
    let recordings = (0..count).map(|_| one(rng)).collect();
    (model, recordings)
}

/// The rows of all recordings in one table, whose clock is set back between them.
fn table(recordings: &[Recording]) -> String {
    let mut text = "t,x,y\n".to_owned();
    for recording in recordings {
        let time = recording.time.as_ref().unwrap();
        for ((t, x), y) in time.iter().zip(&recording.input).zip(&recording.output) {
            text += &format!("{t},{x},{y}\n");
        }
    }
    text
}

fn all(recordings: &[Recording], of: fn(&Recording) -> &Vec<f64>) -> Vec<f64> {
    recordings.iter().flat_map(of).copied().collect()
}

/// Errors that are summed in another order differ in their last digits.
fn alike(a: &Errors, b: &Errors) {
    assert_eq!((a.samples, a.max_abs), (b.samples, b.max_abs));
    assert!((a.rmse - b.rmse).abs() <= 1e-12 * b.rmse, "{a:?} {b:?}");
    let percent = |errors: &Errors| errors.nrmse_percent.unwrap();
    assert!((percent(a) - percent(b)).abs() <= 1e-12 * percent(b));
}

/// A load is no clock: it may go back and jump, and its rows are one recording.
#[test]
fn a_load_without_a_time_begins_no_segment() {
    let mut rng = ChaCha8Rng::seed_from_u64(30);
    let folder = tempfile::tempdir().unwrap();
    for _ in 0..15 {
        let (_, mut recordings) = experiment(&mut rng, 1);
        let recording = &mut recordings[0];
        let load = |_| match rng.random_range(0..10) {
            0 => rng.random_range(-500.0..500.0),
            _ => rng.random_range(49.0..51.0_f64),
        };
        recording.time = Some((0..recording.len()).map(load).collect());
        let path = folder.path().join("run.csv");
        std::fs::write(&path, table(&recordings)).unwrap();
        let columns = Columns {
            load: Some("t"),
            ..Columns::new("x", "y")
        };
        let (segments, notes) = Recording::read_segments(&path, columns, Repair::Refuse).unwrap();
        assert_eq!((segments.len(), notes.len()), (1, 0));
        assert_eq!(segments[0].recording.load, recordings[0].time);
    }
}

#[test]
fn a_table_of_segments_is_as_many_recordings() {
    let mut rng = ChaCha8Rng::seed_from_u64(29);
    let folder = tempfile::tempdir().unwrap();
    for round in 0..15 {
        let count = rng.random_range(1..5);
        let (model, recordings) = experiment(&mut rng, count);
        let path = folder.path().join("run.csv");
        std::fs::write(&path, table(&recordings)).unwrap();
        let columns = Columns {
            time: Some("t"),
            ..Columns::new("x", "y")
        };
        let (segments, _) = Recording::read_segments(&path, columns, Repair::Mend).unwrap();
        assert_eq!(segments.len(), count, "round {round}");
        for (segment, recording) in segments.iter().zip(&recordings) {
            assert_eq!(segment.recording.input, recording.input);
            assert_eq!(segment.recording.time, recording.time);
        }
        // Without repair the row is named, and nothing is read.
        let refused = Recording::read_segments(&path, columns, Repair::Refuse);
        assert_eq!(refused.is_err(), count > 1);

        let recordings: Vec<Recording> = segments.into_iter().map(|s| s.recording).collect();
        let output = all(&recordings, |r| &r.output);
        let each = recordings.iter();
        let apart: Vec<_> = each
            .map(|r| evaluate_from(&model, r, Start::Off).unwrap())
            .collect();
        let found = evaluate_from(&model, &recordings, Start::Off).unwrap();
        let modelled: Vec<f64> = apart.iter().flat_map(|e| e.output_model.clone()).collect();
        assert_eq!(found.output_model, modelled);
        let expected = Errors::between(&output, &modelled, |_| true).unwrap();
        alike(&found.forward, &expected);
        let short = evaluate_errors(&model, &recordings, Start::Off).unwrap();
        assert_eq!(short.forward, found.forward);
        let run = forward(&model, &recordings, Start::Off).unwrap();
        assert_eq!((run.errors, &run.output_model), (found.forward, &modelled));

        let inverse = found.inverse.unwrap();
        let input = all(&recordings, |r| &r.input);
        for run in [&inverse.hold, &inverse.anticipate] {
            let moving = Errors::between(&input, &run.input_model, |n| inverse.moving[n]);
            alike(&run.moving.unwrap(), &moving.unwrap());
            let whole = Errors::between(&input, &run.input_model, |_| true);
            alike(&run.all, &whole.unwrap());
        }

        let summary = inspect_recording(&recordings, *model.plane()).unwrap();
        assert_eq!((summary.samples, summary.segments), (output.len(), count));
        let excited = |r: &Recording| inspect_recording(r, *model.plane()).unwrap().excited;
        assert!(summary.excited >= recordings.iter().map(excited).max().unwrap());
        assert_eq!(summary.time.unwrap().longest_step, 1.0);
    }
}

/// What was learned goes on, and the operators start anew: else the model would err at the
/// beginning of each recording.
#[test]
fn an_adaptation_goes_on_through_segments() {
    let mut rng = ChaCha8Rng::seed_from_u64(30);
    for round in 0..12 {
        let (plant, recordings) = experiment(&mut rng, 3);
        let weights = plant.weights().iter().map(|mu| 0.7 * mu).collect();
        let (plane, sign) = (*plant.plane(), plant.sign());
        let model = Model::new(plant.operator(), plane, weights, plant.offset(), sign).unwrap();
        for learner in [Learner::Refit, Learner::LeastSquares, Learner::Drift] {
            let options = AdaptOptions {
                learner,
                ..AdaptOptions::default()
            };
            let found = adapt(&model, &recordings, &options, Progress::NONE).unwrap();
            let samples: usize = recordings.iter().map(Recording::len).sum();
            assert_eq!(found.output_model.len(), samples);
            let fixed = forward(&model, &recordings, Start::Off).unwrap().errors;
            alike(&found.whole.fixed, &fixed);
            let last = found.thirds[2];
            assert!(
                last.adapting.rmse < 0.5 * last.fixed.rmse,
                "round {round}, {learner:?}: {last:?}"
            );
            let again = forward(&found.model, &recordings, Start::Off).unwrap();
            alike(&found.again, &again.errors);
        }
    }
}

/// A fit, and the model's error on what it was fitted to, are those of the recordings.
#[test]
fn a_fit_says_the_error_that_an_evaluation_finds() {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let (_, recordings) = experiment(&mut rng, 3);
    let model = Fit::new().levels(6).bootstrap(0).run(&recordings).unwrap();
    let found = evaluate_from(&model, &recordings, Start::Fitted).unwrap();
    let fit = model.fit.unwrap();
    assert_eq!(fit.samples, found.forward.samples);
    assert!((fit.rmse - found.forward.rmse).abs() <= 1e-12 * fit.rmse);
}

#[test]
fn no_recording_is_an_error() {
    let (model, _) = experiment(&mut ChaCha8Rng::seed_from_u64(1), 1);
    let none: &[Recording] = &[];
    assert!(evaluate_from(&model, none, Start::Off).is_err());
    assert!(forward(&model, none, Start::Off).is_err());
    assert!(inspect_recording(none, *model.plane()).is_err());
    assert!(adapt(&model, none, &AdaptOptions::default(), Progress::NONE).is_err());
    assert!(hysteron::plane_of(none, 5).is_err());
}

/// Whatever was left out before a sample, and in whichever recording it is, its place is its line:
/// of a whole table with nothing left out too, whose header shifts the lines.
#[test]
fn the_place_of_a_sample_is_its_line_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(23);
    for round in 0..30 {
        let (count, dirty) = (rng.random_range(1..4), rng.random_range(0..3));
        let (_, recordings) = experiment(&mut rng, count);
        let mut rows: Vec<String> = table(&recordings).lines().map(str::to_owned).collect();
        for _ in 0..dirty {
            let row = rng.random_range(2..rows.len() - 2);
            rows[row] = format!("{},,1", rows[row].split(',').next().unwrap());
        }
        let path = folder.path().join(format!("{round}.csv"));
        std::fs::write(&path, rows.join("\n")).unwrap();
        let columns = Columns {
            time: Some("t"),
            ..Columns::new("x", "y")
        };
        let (segments, _) = Recording::read_segments(&path, columns, Repair::Mend).unwrap();
        for segment in &segments {
            let recording = &segment.recording;
            let time = recording.time.as_ref().unwrap();
            for (sample, x) in recording.input.iter().enumerate() {
                let Some(Place::Line(line)) = recording.place(sample) else {
                    panic!("no line in round {round}, sample {sample}");
                };
                let named = format!("sample {} (line {line} of the file)", sample + 1);
                assert_eq!(recording.named(sample), named);
                let row = &rows[line as usize - 1];
                assert!(row.starts_with(&format!("{},{x},", time[sample])), "{row}");
            }
            assert_eq!(recording.place(recording.len()), None);
        }
    }
}
