//! `hysteron export`

use crate::{Result, args, keep_apart, print};

pub(crate) fn run(args: &args::Export) -> Result<()> {
    match args {
        args::Export::C(args) => c(args),
        args::Export::Fmu(args) => fmu(args),
    }
}

fn c(args: &args::ExportC) -> Result<()> {
    let model = model(&args.model, &args.load)?;
    Ok(hysteron_export::c(&model, &args.out)?)
}

fn fmu(args: &args::ExportFmu) -> Result<()> {
    keep_apart(&args.model, &args.out)?;
    let model = model(&args.model, &args.load)?;
    let options = hysteron_export::FmuOptions {
        inverse: args.inverse,
        fmi: args.fmi.into(),
        name: args.name.clone(),
    };
    let fmu = hysteron_export::fmu(&model, &options, &args.out)?;
    let file = args.out.display().to_string();
    let hysteron_export::Fmu {
        name,
        token,
        bytes,
        inputs,
        outputs,
        parameters,
    } = fmu;
    if args.json.json {
        let object = serde_json::json!({
            "file": file, "name": name, "fmi": options.fmi.version(), "token": token, "bytes": bytes,
            "inputs": inputs, "outputs": outputs, "parameters": parameters,
        });
        return print(&object.to_string());
    }
    let (inputs, outputs) = (inputs.join(", "), outputs.join(", "));
    let kib = bytes.div_ceil(1024);
    print(&format!(
        "{file}: block {name}, {inputs} -> {outputs}, {kib} KiB"
    ))
}

/// The model at the load that is named, where one is.
fn model(path: &std::path::Path, load: &args::Load) -> Result<hysteron::Model> {
    match load.apply(hysteron::Model::read(path)?)? {
        (model, None) => Ok(model),
        (_, Some(column)) => Err(format!("--load {column}: a number is needed").into()),
    }
}
