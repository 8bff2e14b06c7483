//! What a sample of `Model::run` takes, in nanoseconds, for `python/benchmarks/simulate.py`: `cargo
//! run --release -p hysteron-measure -- simulate-speed MODEL SAMPLES`. `SAMPLES` is a file of
//! 64-bit numbers, least significant byte first.

use crate::result::Result;
use hysteron::Model;
use std::hint::black_box;
use std::time::Instant;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let [model, samples] = arguments else {
        return Err("a model file and a file of samples are needed".into());
    };
    let model = Model::read(model.as_ref())?;
    let bytes = std::fs::read(samples)?;
    let (samples, _) = bytes.as_chunks::<8>();
    let input: Vec<f64> = samples.iter().map(|s| f64::from_le_bytes(*s)).collect();
    let mut output = vec![0.0; input.len()];
    // The shortest of several runs: other load on the machine only adds time.
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        let start = Instant::now();
        model.run(&mut model.start(), black_box(&input), &mut output)?;
        black_box(&mut output);
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{}", 1e9 * best / input.len() as f64);
    Ok(())
}
