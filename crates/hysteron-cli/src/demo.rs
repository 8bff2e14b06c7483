//! `hysteron demo`

use crate::made::Typed;
use crate::terminal::{Result, print};
use crate::{args, evaluate, text};
use hysteron::{Errors, InverseRun, Verdict};
use hysteron_files::AtomicFolder;
use hysteron_report::{Report, Shown};
use hysteron_sim::rig::{Experiment, Reproduction};
use serde_json::json;
use std::path::Path;

/// Of the two recordings; any others do as well.
const SEEDS: [u64; 2] = [1, 2];

pub(crate) fn run(args: &args::Demo) -> Result<()> {
    let folder = &args.out;
    let mut written = AtomicFolder::create(args.force.target(folder, &[]), None)?;
    written.claim(["model.json", "report/index.html"])?;
    eprintln!("hysteron: recording a simulated NiTi spring twice, fitting, testing …");
    let demo = Reproduction::run(&Experiment::default(), SEEDS)?;
    for n in 0..2 {
        let [raw, prepared] = ["-raw", ""].map(|end| format!("recording-{}{end}.csv", n + 1));
        written.file(raw, |path| demo.raw[n].write_csv(path))?;
        written.file(prepared, |path| demo.prepared[n].write_csv(path))?;
    }
    written.file("model.json", |path| demo.model.write(path))?;
    let typed = Typed::now()?;
    let report = Report {
        title: "MKP model of a simulated NiTi tension spring",
        shown: Shown::Evaluation {
            model: &demo.model,
            recordings: demo.prepared[1].as_ref(),
            evaluation: &demo.evaluation,
            verdict: Some(&Verdict::of_evaluation(
                &demo.model,
                &demo.prepared[1],
                &demo.evaluation,
            )?),
        },
        made: typed.made(),
    };
    report.write_into(&mut written, Path::new("report"))?;
    written.commit()?;
    if args.json.json {
        let mut object = evaluate::to_json(&demo.evaluation);
        object["simulated"] = json!(true);
        object["fit"] = json!(demo.model.fit);
        object["folder"] = json!(folder);
        return print(&object.to_string());
    }
    print(&summary(&demo)?)?;
    print(&format!(
        "\nThe report is {}",
        folder.join("report").join("index.html").display()
    ))
}

/// The errors of one part of the samples.
type Part = fn(&InverseRun) -> Option<&Errors>;

fn summary(demo: &Reproduction) -> Result<String> {
    let evaluation = &demo.evaluation;
    let inverse = evaluation.inverse.as_ref().map_err(Clone::clone)?;
    let fit = demo.model.fit.as_ref().ok_or("a fit says how it went")?;
    let forward = &evaluation.forward;
    let mm = |value: f64| demo.model.output.text(value);
    let both = |part: Part, measure: fn(&Errors) -> f64| {
        [&inverse.hold, &inverse.anticipate].map(|run| {
            let value = part(run).map(measure);
            value.map_or("none".into(), |v| demo.model.input.text(v))
        })
    };
    let mut rows = vec![
        text::row([
            "simulated NiTi spring, 6 N",
            "hold",
            "anticipate",
            "the chapter's",
        ]),
        vec![
            "samples fitted, tested".into(),
            format!("{}, {}", fit.samples, forward.samples),
        ],
        vec![
            "weights not zero".into(),
            format!("{} of {}", fit.weights_not_zero, demo.model.weights().len()),
        ],
        vec!["forward RMSE".into(), mm(forward.rmse)],
        vec![
            "forward, largest error".into(),
            mm(forward.max_abs),
            String::new(),
            "0.5 mm".into(),
        ],
    ];
    let lines: [(&str, Part, &str); 2] = [
        (
            "while the output moves",
            |run| run.moving.as_ref(),
            "2 degC",
        ),
        ("in the dead band", |run| run.dead_band.as_ref(), "26 degC"),
    ];
    for (name, part, chapter) in lines {
        let [hold, anticipate] = both(part, |errors| errors.rmse);
        rows.push(vec![format!("inverse RMSE {name}"), hold, anticipate]);
        let [hold, anticipate] = both(part, |errors| errors.max_abs);
        rows.push(vec![
            format!("inverse, largest error {name}"),
            hold,
            anticipate,
            chapter.into(),
        ]);
    }
    Ok(text::table(&rows))
}
