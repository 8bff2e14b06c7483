//! `hysteron export`

use crate::args;
use crate::terminal::{Result, print};
use hysteron::Model;
use hysteron::control::Scheme;
use hysteron_export::{ArduinoOptions, COptions, CSampling, Fmu, FmuOptions};
use hysteron_sim::joint::TargetLoop;
use serde_json::json;

pub(crate) fn run(args: &args::Export) -> Result<()> {
    match args {
        args::Export::C(args) => c(args),
        args::Export::Arduino(args) => arduino(args),
        args::Export::Fmu(args) => fmu(args),
    }
}

fn c(args: &args::ExportC) -> Result<()> {
    let model = model(&args.model, args.load)?;
    let control = match (args.controller, args.dt) {
        (true, Some(dt)) => {
            let chosen = TargetLoop {
                dt,
                drives: args.drive_range,
                gains: args.gains,
                gate: args.gate,
                filter_s: args.filter,
            };
            Some(chosen.scheme(&model)?)
        }
        _ => None,
    };
    let sampling = match control {
        None => CSampling {
            dt: args.dt,
            drive: args.drive_range,
            measured: false,
        },
        Some(_) => CSampling {
            measured: args.measured_dt,
            ..CSampling::of_loop(&model, args.dt)
        },
    };
    let options = COptions {
        real: args.real.into(),
        name: args.name.as_deref(),
        source: &args.model,
        adaptation: args.adaptation,
    };
    let inputs = [args.model.as_path()];
    let target = args.force.target(&args.out, &inputs);
    let export = match &control {
        None => hysteron_export::c_sampled(&model, target, &options, &sampling)?,
        Some(control) => {
            hysteron_export::c_controlled(&model, target, &options, &sampling, control)?
        }
    };
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
                "controller": memory.controller,
            },
            "control": control.as_ref().map(loop_json),
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
    if let (Some(bytes), Some(control)) = (memory.controller, &control) {
        lines.push(format!(
            "{bytes} bytes more for a controller, and a second state; {}",
            loop_text(control)
        ));
    }
    if !export.stages.is_empty() {
        lines.push(format!("stages: {}", export.stages.join(", ")));
    }
    lines.extend(dead_time(&model, args.dt));
    if !export.inverse {
        lines.push("weights below zero: the C runs forward only".into());
    }
    print(&lines.join("\n"))
}

fn arduino(args: &args::ExportArduino) -> Result<()> {
    let model = model(&args.model, args.load)?;
    // The sketches have the share of time for which current flows as the drive.
    let (low, high) = model.drive.unwrap_or((0.0, 1.0));
    let drives = args.drive_range.unwrap_or((low.max(0.0), high.min(1.0)));
    let chosen = TargetLoop {
        drives: Some(drives),
        gains: args.gains,
        ..TargetLoop::new(args.dt)
    };
    let control = chosen.scheme(&model)?;
    let options = ArduinoOptions {
        name: args.name.as_deref(),
        source: &args.model,
        board: args.board.into(),
        adaptation: args.adaptation,
    };
    let inputs = [args.model.as_path()];
    let target = args.force.target(&args.out, &inputs);
    let sampling = CSampling::of_loop(&model, Some(args.dt));
    let made = hysteron_export::arduino(&model, target, &options, &sampling, &control)?;
    let (export, memory) = (made.export, made.memory);
    if args.json.json {
        let object = json!({
            "files": export.files,
            "name": export.name,
            "levels": export.levels,
            "stages": export.stages,
            "standalone": made.standalone,
            "board": options.board.name(),
            "model_bytes": { "flash": memory.model_flash, "ram": memory.model_ram },
            "sketch_bytes": { "flash": memory.flash, "ram": memory.ram },
            "board_bytes": { "flash": options.board.flash(), "ram": options.board.ram() },
            "follows": memory.follows,
            "learns": args.adaptation,
            "control": loop_json(&control),
        });
        return print(&object.to_string());
    }
    let files = export.files.iter().map(|file| file.display().to_string());
    let mut lines: Vec<String> = files.collect();
    let of = |most: Option<usize>| most.map_or(String::new(), |most| format!(" of {most}"));
    lines.push(format!(
        "{}: the model takes {} bytes of flash and {} of RAM; with the sketch at most {}{} and {}{}",
        options.board.name(),
        memory.model_flash,
        memory.model_ram,
        memory.flash,
        of(options.board.flash()),
        memory.ram,
        of(options.board.ram()),
    ));
    if !made.standalone {
        lines.push(
            "no sketch `standalone`: its drive is a share of full power, and this one leaves 0 to 1"
                .into(),
        );
    }
    if !memory.follows {
        lines.push(
            "there is no room for a second state: a reading that stands still is believed".into(),
        );
    }
    lines.push(loop_text(&control));
    lines.extend(dead_time(&model, Some(args.dt)));
    print(&lines.join("\n"))
}

fn loop_json(scheme: &Scheme) -> serde_json::Value {
    json!({
        "dt": scheme.interval_s,
        "gains": scheme.pid,
        "drive": [scheme.drives.0, scheme.drives.1],
        "delay_samples": scheme.delay,
        "tolerance": scheme.tolerance,
        "lost_s": scheme.safety.lost_s,
        "stuck_s": scheme.safety.stuck_s,
        "gate": scheme.gate,
        "filter_s": scheme.filter_s,
    })
}

fn loop_text(scheme: &Scheme) -> String {
    let Scheme {
        pid,
        interval_s,
        drives: (low, high),
        ..
    } = scheme;
    let gains = pid.map_or(String::new(), |gains| {
        format!(
            "gain {:.3e}, integral time {:.3e} s, derivative time {:.3e} s, ",
            gains.gain, gains.integral_s, gains.derivative_s
        )
    });
    format!("PID: {gains}every {interval_s} s, drive {low} to {high}")
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
    let fmu = match args.dt.filter(|_| args.controller) {
        None => hysteron_export::fmu(&model, &options, target)?,
        Some(dt) => {
            let chosen = TargetLoop {
                dt,
                drives: args.drive_range,
                gains: args.gains,
                gate: args.gate,
                filter_s: args.filter,
            };
            let scheme = chosen.scheme(&model)?;
            hysteron_export::fmu_controlled(&model, &scheme, &options, target)?
        }
    };
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
    let lines: Vec<String> = [Some(block), dead_time(&model, None)]
        .into_iter()
        .flatten()
        .collect();
    print(&lines.join("\n"))
}

/// What an export carries of a dead time, where there is one.
fn dead_time(model: &Model, dt: Option<f64>) -> Option<String> {
    let (samples, seconds) = (model.delay().at(dt), model.delay().seconds());
    // A clock is rounded; a nanosecond is no part of a time that one gives.
    let seconds = (seconds * 1e9).round() / 1e9;
    (!model.delay().is_none()).then(|| format!("dead time: {seconds} s or {samples} samples"))
}

/// The model, at a load where one is given.
fn model(path: &std::path::Path, load: Option<f64>) -> Result<hysteron::Model> {
    let model = hysteron::Model::read(path)?;
    crate::model::say_if_poor(&model);
    Ok(match load {
        Some(load) => model.at_load(load)?,
        None => model,
    })
}
