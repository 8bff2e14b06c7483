//! Three loops of `hysteron run` over pseudo-terminals, and how fast they answer. Prints
//! `docs/measured/bench-jitter.md`:
//! `cargo run --release -p hysteron-measure -- jitter target/release/hysteron 600`

use crate::median::median;
use crate::result::Result;
use hysteron::{Fit, Recording};
use hysteron_bench::protocol::{closed, opened};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Samples a second.
const RATES: [f64; 3] = [10.0, 100.0, 1000.0];

/// Ends of the classes of the histogram, ms.
const CLASSES: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, f64::INFINITY];

/// Half the width of the play that the device has, in units of its drive.
const PLAY: f64 = 1.0;

/// What the device saw: when each sample went out, how late that was, and how long its answer took.
#[derive(Default)]
struct Clocked {
    sent: Vec<Instant>,
    late: Vec<f64>,
    answered: Vec<Option<f64>>,
    drive: (usize, f64),
    begun: bool,
    over: bool,
}

pub(crate) fn run(words: &[String]) -> Result<()> {
    let [command, seconds] = words else {
        return Err("name the command, and for how many seconds each loop runs".into());
    };
    let seconds: f64 = seconds.parse()?;
    let folder = tempfile::tempdir()?;
    write_model(folder.path())?;
    let loops: Vec<Result<(Clocked, Value)>> = std::thread::scope(|scope| {
        let one = |rate| {
            let folder = folder.path();
            scope.spawn(move || looped(command, folder, rate, seconds).map_err(|e| e.to_string()))
        };
        let running: Vec<_> = RATES.map(one).into();
        let ended = running.into_iter().map(|one| match one.join() {
            Ok(found) => found.map_err(Into::into),
            Err(_) => Err("a loop broke".into()),
        });
        ended.collect()
    });
    let loops = loops.into_iter().collect::<Result<Vec<_>>>()?;
    print(seconds, &loops);
    Ok(())
}

/// The output after a drive.
fn moved(output: f64, drive: f64) -> f64 {
    output.clamp(drive - PLAY, drive + PLAY)
}

/// A model of the device, from a recording of decaying strokes.
fn write_model(folder: &Path) -> Result<()> {
    let stroke = |n: u32| {
        let t = f64::from(n) * 0.02;
        5.0 - 5.0 * (1.0 - 0.007 * t) * t.cos()
    };
    let input: Vec<f64> = (0..4000).map(stroke).collect();
    let follow = |output: &mut f64, drive: &f64| {
        *output = moved(*output, *drive);
        Some(*output)
    };
    let output = input.iter().scan(0.0, follow).collect();
    let model = Fit::new().run(&Recording::new(input, output)?)?;
    std::fs::write(folder.join("model.json"), model.to_json())?;
    Ok(())
}

/// One loop: a device with a clock of its own at one end, the command at the other.
fn looped(command: &str, folder: &Path, rate: f64, seconds: f64) -> Result<(Clocked, Value)> {
    let board = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
    grantpt(&board)?;
    unlockpt(&board)?;
    let port = ptsname(&board, Vec::new())?.into_string()?;
    let config = folder.join(format!("{rate}.toml"));
    let reference = folder.join(format!("{rate}.csv"));
    let mut table = String::from("time,reference\n");
    for n in 0..=(20.0 * seconds) as u32 {
        let time = f64::from(n) * 0.05;
        table += &format!("{time:.2},{:.5}\n", 5.0 - 3.0 * (time * 0.7).cos());
    }
    std::fs::write(reference, table)?;
    std::fs::write(
        &config,
        format!(
            "mode = 'control'\nlog = '{rate}-log.csv'\nduration_s = {seconds}\n\
             device = {{ serial = '{port}' }}\nreference = {{ table = '{rate}.csv' }}\n\
             [controller]\nkind = 'adaptive-inverse-pid'\nmodel = 'model.json'\n"
        ),
    )?;
    let clocked = Arc::new(Mutex::new(Clocked::default()));
    let reads = {
        let (board, clocked) = (File::from(board.try_clone()?), clocked.clone());
        std::thread::spawn(move || read(board, rate, &clocked))
    };
    let writes = {
        let (board, clocked) = (File::from(board), clocked.clone());
        std::thread::spawn(move || write(board, rate, &clocked))
    };
    let mut run = Command::new(command);
    let run = run.arg("run").arg(&config).args(["--json", "--force"]);
    let done = run.output()?;
    locked(&clocked).over = true;
    let broke = |_| "the device broke";
    writes.join().map_err(broke)?;
    reads.join().map_err(broke)?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        return Err(format!("{command} at {rate} Hz: {said}").into());
    }
    let found = std::mem::take(&mut *locked(&clocked));
    Ok((found, serde_json::from_slice(&done.stdout)?))
}

/// The lock on what both threads share. It stays usable if one of them panics.
fn locked(clocked: &Mutex<Clocked>) -> std::sync::MutexGuard<'_, Clocked> {
    clocked.lock().unwrap_or_else(|broken| broken.into_inner())
}

/// Takes what the host says, until the loop is over.
fn read(mut board: File, rate: f64, clocked: &Mutex<Clocked>) {
    let Ok(lines) = board.try_clone() else { return };
    let mut lines = BufReader::new(lines);
    let mut line = String::new();
    while !locked(clocked).over {
        line.clear();
        // Until somebody has opened it, a pseudo-terminal ends at once.
        if lines.read_line(&mut line).unwrap_or(0) == 0 {
            std::thread::sleep(Duration::from_millis(5));
            continue;
        }
        let now = Instant::now();
        let text = opened(line.trim_end().as_bytes()).unwrap_or_default();
        let words: Vec<&str> = text.split(' ').collect();
        let answer = match words[..] {
            ["?"] => Some(format!(
                "H 1 name=clock dt={} drive=0:10 safe=0 watchdog=1 columns=output",
                1.0 / rate
            )),
            ["Q"] => Some("E host".to_owned()),
            ["G"] => {
                locked(clocked).begun = true;
                None
            }
            ["D", n, drive] => {
                if let (Ok(n), Ok(drive)) = (n.parse::<usize>(), drive.parse()) {
                    let mut clocked = locked(clocked);
                    clocked.drive = (n, drive);
                    let took = clocked.sent.get(n.wrapping_sub(1));
                    let took = took.map(|sent| now.duration_since(*sent).as_secs_f64());
                    if let Some(answered) = clocked.answered.get_mut(n.wrapping_sub(1)) {
                        *answered = took;
                    }
                }
                None
            }
            _ => None,
        };
        if let Some(answer) = answer {
            let quits = answer.starts_with('E');
            let _ = board.write_all(closed(&answer).as_bytes());
            if quits {
                locked(clocked).over = true;
            }
        }
    }
}

/// Samples by its own clock, whatever the host does.
fn write(mut board: File, rate: f64, clocked: &Mutex<Clocked>) {
    while !locked(clocked).begun {
        if locked(clocked).over {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let begun = Instant::now();
    let mut output = 0.0;
    for n in 1_usize.. {
        let due = begun + Duration::from_secs_f64(n as f64 / rate);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
        let text = {
            let mut clocked = locked(clocked);
            if clocked.over {
                return;
            }
            let (applied, drive) = clocked.drive;
            output = moved(output, drive);
            let now = Instant::now();
            clocked.late.push(now.duration_since(due).as_secs_f64());
            clocked.sent.push(now);
            clocked.answered.push(None);
            format!("S {n} {:.4} {applied} {output:.6}", n as f64 / rate)
        };
        if board.write_all(closed(&text).as_bytes()).is_err() {
            return;
        }
    }
}

fn print(seconds: f64, loops: &[(Clocked, Value)]) {
    println!("{}", include_str!("text/jitter.md").trim_end());
    let heading = RATES.map(|rate| format!("{rate:.0} Hz")).join(" | ");
    println!("\nHere each ran for {seconds:.0} s.\n\n| | {heading} |");
    println!("| --- | ---: | ---: | ---: |");
    let row = |name: &str, cell: &dyn Fn(usize) -> String| {
        let cells: Vec<String> = (0..loops.len()).map(cell).collect();
        println!("| {name} | {} |", cells.join(" | "));
    };
    let answers = |k: usize| -> Vec<f64> {
        let all = loops[k].0.answered.iter().flatten();
        let mut all: Vec<f64> = all.map(|s| 1e3 * s).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let ms = |value: f64| format!("{value:.3} ms");
    let at = |k: usize, share: f64| {
        let all = answers(k);
        let last = all.len().saturating_sub(1);
        all.get((share * last as f64) as usize)
            .copied()
            .unwrap_or(f64::NAN)
    };
    row("samples", &|k| loops[k].1["samples"].to_string());
    row("samples that the host missed", &|k| {
        loops[k].1["lost"].to_string()
    });
    row("samples without an answer, but for the last", &|k| {
        let answered = &loops[k].0.answered;
        let all = answered.iter().take(answered.len().saturating_sub(1));
        all.filter(|took| took.is_none()).count().to_string()
    });
    row("answers later than the next sample", &|k| {
        let interval = 1e3 / RATES[k];
        answers(k)
            .iter()
            .filter(|ms| **ms > interval)
            .count()
            .to_string()
    });
    row("answer, median", &|k| ms(median(answers(k))));
    row("answer, 99 %", &|k| ms(at(k, 0.99)));
    row("answer, 99.9 %", &|k| ms(at(k, 0.999)));
    row("answer, worst", &|k| ms(at(k, 1.0)));
    row("sample late by the device's clock, median", &|k| {
        ms(1e3 * median(loops[k].0.late.clone()))
    });
    row("sample late by the device's clock, worst", &|k| {
        ms(1e3 * loops[k].0.late.iter().copied().fold(0.0, f64::max))
    });
    row("jitter as the run tells it (RMS)", &|k| {
        ms(1e3 * loops[k].1["jitter_s"].as_f64().unwrap_or(f64::NAN))
    });
    row("how the run ended", &|k| {
        loops[k].1["end"].as_str().unwrap_or("").into()
    });
    println!("\nHow many answers took how long:\n\n| up to | {heading} |");
    println!("| --- | ---: | ---: | ---: |");
    let mut from = 0.0;
    for to in CLASSES {
        let name = match to.is_finite() {
            true => format!("{to} ms"),
            false => "longer".into(),
        };
        row(&name, &|k| {
            let of = answers(k);
            of.iter()
                .filter(|ms| from < **ms && **ms <= to)
                .count()
                .to_string()
        });
        from = to;
    }
}
