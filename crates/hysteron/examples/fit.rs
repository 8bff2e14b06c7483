//! Fits a model to a recording and prints what the fit says.
//!
//! `cargo run --example fit -p hysteron` makes a recording of its own.
//! `cargo run --example fit -p hysteron -- run.csv temperature displacement` reads yours: the file,
//! the column of the input, the column of the output.

use hysteron::{Auto, Columns, Fit, Recording, Repair};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let recording = match &arguments[..] {
        [] => made()?,
        [file, input, output] => {
            let columns = Columns::new(input, output);
            let (recording, notes) = Recording::read(Path::new(file), columns, Repair::Refuse)?;
            for note in notes {
                eprintln!("{file}: {note}"); // what was assumed of the file
            }
            recording
        }
        _ => return Err("usage: fit [FILE INPUT OUTPUT]".into()),
    };

    // Say only what differs from the defaults. `Auto` leaves a value to the data.
    let model = Fit::new().levels(Auto).run(&recording)?;

    println!("levels                {}", model.plane().levels());
    println!("operators             {}", model.plane().operators());
    if let Some(fit) = &model.fit {
        println!("weights not zero      {}", fit.weights_not_zero);
        println!("error, RMSE           {:.4}", fit.rmse);
        println!("error, of the range   {:.2} %", fit.nrmse_percent);
        if let Some(validation) = &fit.validation {
            // The error on parts of the recording that the fit did not see: the honest number.
            println!("error, left out       {:.2} %", validation.nrmse_percent);
        }
        if let Some(confidence) = &fit.confidence {
            println!("unknowns              {}", confidence.unknowns);
            println!("determined by data    {}", confidence.rank);
        }
    }
    Ok(())
}

/// A recording in place of a measured one: a play of 4 °C, heated and cooled less and less far.
fn made() -> hysteron::Result<Recording> {
    let angle = |n: u32| f64::from(n) * 0.02;
    let swing = |n: u32| 30.0 - 0.006 * f64::from(n);
    let input: Vec<f64> = (0..4000)
        .map(|n| 50.0 - swing(n) * angle(n).cos())
        .collect();
    let mut position: f64 = 20.0;
    let output = input.iter().map(|&temperature| {
        position = position.clamp(temperature - 2.0, temperature + 2.0);
        0.2 * position
    });
    let output = output.collect();
    Recording::new(input, output)
}
