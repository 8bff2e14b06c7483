//! `hysteron export`

use crate::args;
use crate::terminal::{Result, print};
use hysteron_export::{COptions, CSampling, Fmu, FmuOptions};
use serde_json::json;

pub(crate) fn run(args: &args::Export) -> Result<()> {
    match args {
        args::Export::C(args) => c(args),
        args::Export::Fmu(args) => fmu(args),
    }
}

fn c(args: &args::ExportC) -> Result<()> {
    let model = model(&args.model, args.load)?;
    let sampling = CSampling {
        dt: args.dt,
        drive: args.drive_range,
    };
    let options = COptions {
        real: args.real.into(),
        name: args.name.as_deref(),
        source: &args.model,
        adaptation: args.adaptation,
    };
    let inputs = [args.model.as_path()];
    let target = args.force.target(&args.out, &inputs);
    let export = hysteron_export::c_sampled(&model, target, &options, &sampling)?;
    let (memory, worst) = (export.memory, export.worst_case);
    if args.json.json {
        let object = json!({
            "files": export.files,
            "name": export.name,
            "real": export.real.name(),
            "levels": export.levels,
            "inverse": export.inverse,
            "rounding": export.rounding,
            "stages": export.stages,
            "dt": export.dt,
            "delay_samples": model.delay().at(args.dt),
            "flash_bytes": memory.constants,
            "ram_bytes": {
                "state": memory.state,
                "mixed": memory.mixed,
                "turns": memory.turns,
                "adaptation": memory.adaptation,
            },
            "worst_case": {
                "turning_points_passed": worst.turning_points,
                "step_loop": worst.step,
                "inverse_halvings": worst.halvings,
            },
        });
        return print(&object.to_string());
    }
    let mut lines: Vec<String> = export
        .files
        .iter()
        .map(|f| f.display().to_string())
        .collect();
    lines.push(format!(
        "{} bytes of constants; {} bytes for each state with its turning points",
        memory.constants,
        memory.state + memory.turns
    ));
    if memory.mixed > 0 {
        lines.push(format!(
            "the weights depend on the load: {} of the bytes of each state hold those of the \
             present load",
            memory.mixed
        ));
    }
    if let Some(bytes) = memory.adaptation {
        lines.push(format!("{bytes} bytes more for a model that learns"));
    }
    if !export.stages.is_empty() {
        lines.push(format!("stages: {}", export.stages.join(", ")));
    }
    if !export.inverse {
        lines.push("weights below zero: the C runs forward only".into());
    }
    lines.extend(hysteron_export::delay_note(&model, args.dt));
    print(&lines.join("\n"))
}

fn fmu(args: &args::ExportFmu) -> Result<()> {
    let model = model(&args.model, args.load)?;
    let options = FmuOptions {
        inverse: args.inverse,
        fmi: args.fmi.into(),
        name: args.name.clone(),
    };
    let inputs = [args.model.as_path()];
    let target = args.force.target(&args.out, &inputs);
    let fmu = hysteron_export::fmu(&model, &options, target)?;
    let file = args.out.display().to_string();
    let Fmu {
        name,
        token,
        bytes,
        inputs,
        outputs,
        parameters,
    } = fmu;
    if args.json.json {
        let object = json!({
            "file": file, "name": name, "fmi": options.fmi.version(),
            "token": token, "bytes": bytes, "delay_s": model.delay().seconds(),
            "inputs": inputs, "outputs": outputs, "parameters": parameters,
        });
        return print(&object.to_string());
    }
    let (inputs, outputs) = (inputs.join(", "), outputs.join(", "));
    let kib = bytes.div_ceil(1024);
    let block = format!("{file}: block {name}, {inputs} -> {outputs}, {kib} KiB");
    let note = hysteron_export::delay_note(&model, None);
    print(
        &[Some(block), note]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("\n"),
    )
}

/// The model, at a load where one is given.
fn model(path: &std::path::Path, load: Option<f64>) -> Result<hysteron::Model> {
    let model = hysteron::Model::read(path)?;
    Ok(match load {
        Some(load) => model.at_load(load)?,
        None => model,
    })
}
