//! The model as the FMU's binary reads it: `hysteron-capi/src/fmi/resource.rs` says what the lines
//! are.

use super::options::Block;
use super::{control, staged};
use hysteron::{Model, Operator, Result, Sign};
use std::fmt::Write;

pub(super) fn write(model: &Model, block: Block<'_>, token: &str) -> Result<String> {
    let plane = model.plane();
    let (min, max, levels) = (plane.min(), plane.max(), plane.levels());
    let (name, control) = match block {
        Block::Forward => ("forward", String::new()),
        Block::Inverse => ("inverse", String::new()),
        Block::Controller(scheme) => ("controller", control::line(model, scheme)),
    };
    let operator = match model.operator() {
        Operator::Mkp => "mkp",
        Operator::Kp => "kp",
        Operator::Relay => "relay",
    };
    let sign = match model.sign() {
        Sign::Positive => 1,
        Sign::Negative => -1,
    };
    // Those of the parts, one after the other, where they depend on the load.
    let parts = staged::parts(model);
    let weights = parts.map_or(model.weights(), |load| load.joined().1);
    let offset = model.offset();
    let (version, more) = match staged::is_plain(model) {
        true => (1, String::new()),
        false => {
            let (input, load) = staged::first(model);
            let signal = match block.is_forward() {
                false => staged::first_target(model)?,
                true => input,
            };
            let version = match (model.delay().is_none(), staged::is_whole(model)) {
                (true, false) => 2,
                (true, true) => 4,
                (false, _) => 6,
            };
            let lines = staged::delay(model) + &staged::lines(model, (signal, load));
            (version + usize::from(parts.is_some()), lines)
        }
    };
    let mut text = format!(
        "hysteron-fmu {version}\nblock {name}\n{control}token {token}\noperator {operator}\nplane {min:?} {max:?} \
         {levels}\n\
         output {offset:?} {sign}\n{more}weights {}\n",
        weights.len()
    );
    for weight in weights {
        // The shortest that reads back as the same number. Writing to a text cannot fail.
        let _ = writeln!(text, "{weight:?}");
    }
    let (count, checksum) = (text.matches('\n').count(), checksum(text.as_bytes()));
    let _ = writeln!(text, "end {count} {checksum:016x}");
    Ok(text)
}

/// FNV-1a.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
