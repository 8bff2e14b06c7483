//! `hysteron export`

use crate::{Result, args};

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
    let model = model(&args.model, &args.load)?;
    Ok(hysteron_export::fmu(&model, &args.out)?)
}

/// The model at the load that is named, where one is.
fn model(path: &std::path::Path, load: &args::Load) -> Result<hysteron::Model> {
    match load.apply(hysteron::Model::read(path)?)? {
        (model, None) => Ok(model),
        (_, Some(column)) => Err(format!("--load {column}: a number is needed").into()),
    }
}
