//! The model inside the FMU: the text file `model.txt`.
//!
//! ```text
//! hysteron-fmu 1
//! block forward
//! token {8f0c…}
//! operator mkp
//! plane 20.0 80.0 20
//! output 0.0 1
//! weights 210
//! 0.25
//! …
//! end 217 b1946ac92492d234
//! ```
//! A model with stages, or one that does not start with every operator off, has version 2. Between
//! `output` and `weights` it has more lines, each with as many numbers as there are:
//!
//! ```text
//! first 0.0 100.0
//! start 12.5 4.0 1.5
//! body 20.0 2.0 1.5 3.0
//! drive 0.0 100.0
//! loads 0.0 200.0
//! shifts 0.0 12.0
//! scales
//! gains
//! offsets
//! spacing
//! creep 0.05
//! taus 10.0
//! lag 0.2
//! ```
//! These are the start values of signal and load; the operators' input and turning points at the
//! start; the constants of the body; the range of the drive; the constants of the other stages, as
//! they declare them ([`hysteron_core::Declared`]).
//!
//! A model whose weights depend on the load has version 3. After `lag` it has the range of the loads
//! and the offset of each part, and then the weights of the parts, one after the other:
//!
//! ```text
//! range 50.0 200.0
//! parts 1.0 2.5
//! weights 420
//! ```
//!
//! Versions 4 and 5 are versions 2 and 3 with a line for each constant of every stage, in the order in
//! which the stages are declared. They are written where a stage is there that version 2 does not
//! have. Versions 6 and 7 are versions 4 and 5 of a model with a dead time. After `output` they have
//! its samples and seconds:
//!
//! ```text
//! delay 3 0.15
//! ```
//!
//! A controller has one more line after `block`: tolerance, range of the output, gain, integral and
//! derivative time, lowest and highest drive, slew, times until a missing and a stuck reading end
//! the loop, gate, and the filter's time constant:
//!
//! ```text
//! block controller
//! control 0.1 10.0 0.5 0.2 0.0 0.0 1.0 5.0 0.5 1.0 0.2 0.0
//! ```
//!
//! The last line has the number of lines before it and their FNV-1a checksum. Each number has the
//! fewest digits that give the same number when it is read.

use super::block::{Block, Kind};
use super::by_load::ByLoad;
use super::lines::{Fault, Lines, Parsed};
use super::settings::Control;
use super::stages::{Constants, More};
use super::{Problem, Result, checksum};
use crate::delay::MOST;
use hysteron_core::{Model, Operator, Plane, operator_count, table_len};
use std::path::Path;

const FILE: &str = "model.txt";
const HEAD: &str = "hysteron-fmu 1";
/// The first line of a model with stages or with a start.
const HEAD_STAGES: [&str; 2] = ["hysteron-fmu 2", "hysteron-fmu 4"];
/// That of a model whose weights depend on the load.
const HEAD_PARTS: [&str; 2] = ["hysteron-fmu 3", "hysteron-fmu 5"];
/// Those of a model with a dead time, without and with such weights.
const HEAD_LATE: [&str; 2] = ["hysteron-fmu 6", "hysteron-fmu 7"];

/// Reads the model in the folder of the FMU's resources. Errors name file and line.
pub(crate) fn read(folder: &Path) -> Result<Block> {
    let path = folder.join(FILE);
    let place = path.display();
    let bytes = content(&path).map_err(|error| Problem(format!("{place}: {error}")))?;
    parse(&bytes).map_err(|fault| {
        let Fault { line, problem } = fault;
        Problem(format!(
            "{place}, line {line}: {problem}: export the model again"
        ))
    })
}

/// Reads regular files only: a pipe or a device could be read for ever.
fn content(path: &Path) -> std::io::Result<Vec<u8>> {
    let there = std::fs::metadata(path)?;
    if !there.is_file() {
        return Err(std::io::Error::other("this is no file"));
    }
    std::fs::read(path)
}

fn parse(bytes: &[u8]) -> Parsed<Block> {
    let text = std::str::from_utf8(bytes).map_err(|error| Fault {
        line: 1 + bytes[..error.valid_up_to()]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count(),
        problem: "this is not UTF-8".into(),
    })?;
    let mut lines = Lines::new(text);
    let head = lines.next()?;
    let is_late = HEAD_LATE.contains(&head);
    let by_load = HEAD_PARTS.contains(&head) || head == HEAD_LATE[1];
    if !(head == HEAD || by_load || is_late || HEAD_STAGES.contains(&head)) {
        let head: String = head.chars().take(2 * HEAD.len()).collect();
        return lines.fault(format!("`{head}` where `{HEAD}` is expected"));
    }
    let checksum = check_end(text)?;
    let kind = match lines.entry("block")? {
        ["forward"] => Kind::Forward,
        ["inverse"] => Kind::Inverse,
        ["controller"] => Kind::Controller,
        [other] => return lines.fault(format!("there is no block `{other}`")),
    };
    let control = match kind {
        Kind::Controller => Control::read(&mut lines)?,
        Kind::Forward | Kind::Inverse => Control::NONE,
    };
    let [token] = lines.entry("token")?;
    let operator = match lines.entry("operator")? {
        ["mkp"] => Operator::Mkp,
        ["kp"] => Operator::Kp,
        ["relay"] => Operator::Relay,
        [other] => return lines.fault(format!("there is no operator `{other}`")),
    };
    let [min, max, levels] = lines.entry("plane")?;
    let (min, max, levels) = (
        lines.finite(min)?,
        lines.finite(max)?,
        lines.number(levels)?,
    );
    let plane = Plane::new(min, max, levels).or_else(|error| lines.fault(error.to_string()))?;
    let [offset, sign] = lines.entry("output")?;
    let offset = lines.finite(offset)?;
    let sign = match sign {
        "1" => 1.0,
        "-1" => -1.0,
        other => return lines.fault(format!("the sign {other} is neither 1 nor -1")),
    };
    let dead = match is_late {
        false => (0, 0.0),
        true => {
            let [samples, seconds] = lines.entry("delay")?;
            let (samples, seconds) = (lines.number(samples)?, lines.finite(seconds)?);
            if !(1..=MOST).contains(&samples) || seconds <= 0.0 {
                return lines.fault(format!("`delay`, 1 to {MOST} samples and s are expected"));
            }
            (samples, seconds)
        }
    };
    let more = match head == HEAD {
        true => None,
        false => {
            let whole = is_late || head == HEAD_STAGES[1] || head == HEAD_PARTS[1];
            Some(More::read(&mut lines, whole)?)
        }
    };
    let by_load = match by_load {
        true => Some(ByLoad::read(&mut lines)?),
        false => None,
    };
    let [count] = lines.entry("weights")?;
    let count: usize = lines.number(count)?;
    let (each, parts) = (
        operator_count(levels),
        by_load.as_ref().map_or(1, ByLoad::count),
    );
    if count != parts * each {
        let needed = parts * each;
        return lines.fault(format!(
            "{count} weights where {needed} are needed: K(K+1)/2 of each of {parts} part(s)"
        ));
    }
    // The vectors grow with the lines. A number in the file alone allocates nothing.
    let mut models = Vec::new();
    for _ in 0..parts {
        let mut weights = Vec::new();
        for _ in 0..each {
            let line = lines.next()?;
            weights.push(lines.finite(line)?);
        }
        let table = vec![0.0; table_len(levels)];
        let model = Model::new(plane, operator, &weights, table)
            .or_else(|error| lines.fault(error.to_string()))?;
        if kind != Kind::Forward {
            model
                .inverse()
                .or_else(|error| lines.fault(error.to_string()))?;
        }
        models.push(model);
    }
    let end = lines.next()?;
    if !end.starts_with("end ") {
        return lines.fault("more lines than weights");
    }
    let by_load = by_load.map(|by_load| by_load.with(&models));
    let model = models.swap_remove(0);
    let mut block = Block {
        kind,
        token: token.into(),
        checksum,
        offset,
        sign,
        stages: None,
        by_load,
        dead,
        control,
        start: None,
        first: match kind {
            Kind::Forward => (plane.bottom(), 0.0),
            Kind::Inverse | Kind::Controller => (offset + sign * model.output_range().0, 0.0),
        },
        model,
    };
    if let Some(more) = more {
        let core = more.stages.core(offset, sign);
        let checked = core.and_then(|stages| {
            stages.check(&block.model)?;
            Ok(stages.is_none())
        });
        let bare = checked.or_else(|error| lines.fault(error.to_string()))?;
        let by_load = block.by_load.as_ref();
        let checked = by_load.map_or(Ok(()), |by_load| by_load.core().check(&block.model));
        checked.or_else(|error| lines.fault(error.to_string()))?;
        (block.start, block.first) = (more.start, more.first);
        let needed = |_: &Constants| !bare || block.by_load.is_some();
        block.stages = Some(more.stages).filter(needed);
    }
    if let Err(problem) = block.start(false) {
        return lines.fault(problem.0);
    }
    Ok(block)
}

/// Checks the last line and returns its checksum.
fn check_end(text: &str) -> Parsed<u64> {
    let count = text.matches('\n').count();
    let fault = |line: usize, problem: String| Err(Fault { line, problem });
    let Some(whole) = text.strip_suffix('\n') else {
        return fault(count + 1, "the file ends within a line".into());
    };
    let before = whole.rfind('\n').map_or(0, |n| n + 1);
    let (lines, end) = whole.split_at(before);
    if !end.starts_with("end ") {
        return fault(
            count,
            format!("the file ends with `{end}`, not with its last line, `end …`"),
        );
    }
    let checksum = checksum(lines.as_bytes());
    let expected = format!("end {} {checksum:016x}", count - 1);
    if end != expected {
        return fault(
            count,
            format!("`{end}` where the lines before say `{expected}`: one of them has changed"),
        );
    }
    Ok(checksum)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const LINES: [&str; 10] = [
        "hysteron-fmu 1",
        "block inverse",
        "token {abc}",
        "operator kp",
        "plane 20.0 80.0 2",
        "output -1.5 -1",
        "weights 3",
        "0.1",
        "0.0",
        "1e-3",
    ];

    fn closed(lines: &[&str]) -> String {
        let text: String = lines.iter().flat_map(|line| [line, "\n"]).collect();
        let checksum = checksum(text.as_bytes());
        format!("{text}end {} {checksum:016x}\n", lines.len())
    }

    #[test]
    fn what_is_written_is_read() {
        let block = parse(closed(&LINES).as_bytes()).unwrap();
        assert_eq!((block.kind, block.token.as_str()), (Kind::Inverse, "{abc}"));
        assert_eq!((block.offset, block.sign), (-1.5, -1.0));
        assert_eq!(block.model.plane().levels(), 2);
    }

    #[test]
    fn whatever_is_cut_or_changed_is_refused_with_its_line() {
        let text = closed(&LINES);
        // Miri takes a thousand times as long.
        let apart = if cfg!(miri) { 29 } else { 1 };
        for length in (0..text.len()).step_by(apart) {
            assert!(parse(&text.as_bytes()[..length]).is_err(), "{length} bytes");
        }
        for place in (0..text.len()).step_by(apart) {
            for bit in 0..8 {
                let mut bytes = text.clone().into_bytes();
                bytes[place] ^= 1 << bit;
                let fault = parse(&bytes).unwrap_err();
                assert!((1..=12).contains(&fault.line), "{place}: {fault:?}");
            }
        }
        assert!(parse(format!("{text}\n").as_bytes()).is_err());
    }

    #[test]
    fn a_fault_with_the_right_checksum_is_named() {
        let cases = [
            (1, "hysteron-fmu 8", "`hysteron-fmu 8` where"),
            (1, "hysteron-fmu 2", "`first` is expected"),
            (1, "hysteron-fmu 3", "`first` is expected"),
            (1, "hysteron-fmu 4", "`first` is expected"),
            (1, "hysteron-fmu 5", "`first` is expected"),
            (1, "hysteron-fmu 6", "`delay` and 2 value"),
            (1, "hysteron-fmu 7", "`delay` and 2 value"),
            (2, "block sideways", "no block"),
            (2, "block", "`block` and 1 value"),
            (4, "operator", "`operator` and 1 value"),
            (5, "plane 20.0 NaN 2", "not a finite number"),
            (5, "plane 20.0 10.0 2", "in"),
            (5, "plane 20.0 80.0 1", "1 levels"),
            (5, "plane 20.0 80.0 46341", "46341 levels"),
            (5, "plane 20.0 80.0 99999999999999999999", "no number"),
            (6, "output inf 1", "not a finite number"),
            (6, "output 0.0 2", "neither 1 nor -1"),
            (7, "weights 4", "are needed"),
            (8, "NaN", "not a finite number"),
            (9, "0.0 ", "no number"),
            (9, "1.0\n2.0", "end"),
        ];
        for (line, replaced, expected) in cases {
            let mut lines = LINES;
            lines[line - 1] = replaced;
            let text = match replaced.contains('\n') {
                true => closed(&lines.join("\n").split('\n').collect::<Vec<_>>()),
                false => closed(&lines),
            };
            let fault = parse(text.as_bytes()).unwrap_err();
            assert!(
                fault.problem.contains(expected) || fault.problem.contains("more lines"),
                "{replaced}: {fault:?}"
            );
            assert!(fault.line >= line, "{replaced}: {fault:?}");
        }
        // A large number of levels alone allocates nothing.
        let mut lines = LINES;
        (lines[4], lines[6]) = ("plane 20.0 80.0 46340", "weights 1073720970");
        assert!(parse(closed(&lines).as_bytes()).unwrap_err().line >= 11);
    }

    #[test]
    fn parts_of_the_weights() {
        let more = "first 20.0 60.0\nstart\nbody\ndrive\nloads\nshifts\nscales\ngains\noffsets\n\
                    spacing\ncreep\ntaus\nlag 0.0\nrange 50.0 200.0\nparts 1.0 2.5";
        let with = |replaced: (&str, &str)| {
            let mut lines: Vec<&str> = LINES[..6].to_vec();
            lines[0] = "hysteron-fmu 3";
            lines.extend(more.split('\n'));
            lines.extend(["weights 6", "0.1", "0.0", "1e-3", "0.5", "0.25", "2.0"]);
            let at = lines.iter().position(|line| *line == replaced.0).unwrap();
            lines[at] = replaced.1;
            parse(closed(&lines).as_bytes())
        };
        let block = with(("0.5", "0.5")).unwrap();
        assert!(block.is_loaded() && block.by_load.unwrap().count() == 2);
        let many = "parts 1 2 3 4 5 6 7 8 9";
        for (line, replaced, expected) in [
            ("range 50.0 200.0", "range 200.0 200.0", "in order"),
            ("range 50.0 200.0", "range 50.0 NaN", "not a finite"),
            ("range 50.0 200.0", "range 50.0", "in order"),
            ("range 50.0 200.0", "range -1.7e308 1.7e308", "`load`"),
            ("parts 1.0 2.5", "parts", "1 to 8 numbers"),
            ("parts 1.0 2.5", many, "1 to 8 numbers"),
            ("parts 1.0 2.5", "parts 1.0", "are needed"),
            ("weights 6", "weights 3", "are needed"),
            ("0.25", "-0.25", "negative"),
        ] {
            let fault = with((line, replaced)).unwrap_err();
            assert!(fault.problem.contains(expected), "{replaced}: {fault:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_device_in_its_place_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("/dev/null", folder.path().join(FILE)).unwrap();
        let found = read(folder.path());
        assert!(found.unwrap_err().0.contains("this is no file"));
    }

    #[test]
    fn a_message_does_not_repeat_a_file() {
        let text = "x".repeat(1_000_000);
        assert!(parse(text.as_bytes()).unwrap_err().problem.len() < 100);
    }

    #[test]
    fn an_inverse_needs_weights_from_zero_on() {
        let mut lines = LINES;
        lines[8] = "-0.5";
        assert!(
            parse(closed(&lines).as_bytes())
                .unwrap_err()
                .problem
                .contains("negative")
        );
        lines[1] = "block forward";
        assert!(parse(closed(&lines).as_bytes()).is_ok());
    }
}
