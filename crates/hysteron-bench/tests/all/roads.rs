//! The other ways to a device: a child on a pipe, and a serial line (a pseudo-terminal).

use super::bench::{PID, config, folder, plain, rows};
use hysteron_bench::protocol::closed;
use hysteron_bench::{End, Options};
use std::io::{BufRead, BufReader, Write};
use std::time::{Duration, Instant};

fn ran(text: &str, device: &str) -> (tempfile::TempDir, hysteron_bench::Result<End>) {
    let folder = folder();
    let config = config(&folder, text, device);
    let found = plain(&config, &Options::default());
    (folder, found.map(|found| found.end))
}

/// A child made of a shell script: it needs no other program.
fn child(script: &str) -> String {
    format!("command = ['sh', '-c', '''{script}''']")
}

#[test]
fn a_child_that_never_speaks_dies_or_leaves_is_told_apart() {
    let begun = Instant::now();
    let (_, silent) = ran(PID, &child("exit 3"));
    let silent = silent.unwrap_err().to_string();
    assert!(silent.contains("ended before"), "{silent}");
    assert!(begun.elapsed() < Duration::from_secs(5));
    let (_, none) = ran(PID, "command = ['no-such-program']");
    assert!(none.unwrap_err().to_string().contains("cannot be opened"));

    let header = closed("H 1 dt=0.05 drive=0:10 safe=0.5 columns=output,temperature");
    let sample = closed("S 1 0.05 0 1.0 20");
    // It says one sample, and half of another one, and dies; or closes its output and stays.
    for (script, end) in [
        (
            format!("read a; printf '%b' \"{header}{sample}S 2 0.1\"; read b; read c; exit 7"),
            "closed",
        ),
        (
            format!("read a; printf '%b' \"{header}{sample}\"; exec >&-; sleep 60"),
            "closed",
        ),
        (
            format!("read a; printf '%b' \"{header}{sample}\"; sleep 60"),
            "lost",
        ),
        (
            format!("read a; printf '%b' \"{header}{sample}\"; yes nonsense"),
            "lost",
        ),
        (
            format!("read a; printf '%b' \"{header}{sample}\"; cat /dev/zero"),
            "lost",
        ),
    ] {
        let begun = Instant::now();
        let (folder, found) = ran(PID, &child(&script.replace('\n', "\\n")));
        let found = found.unwrap();
        assert_eq!(found.word(), end, "{script}: {found}");
        assert!(begun.elapsed() < Duration::from_secs(10), "{script}");
        assert_eq!(rows(&folder.path().join("run.csv")).len(), 1);
    }
}

#[test]
fn a_child_does_not_outlive_its_run() {
    let header = closed("H 1 dt=0.05 drive=0:10 safe=0.5 columns=output,temperature");
    let sample = closed("S 1 0.05 0 1.0 20");
    let script = format!(
        "trap '' TERM INT HUP; read a; printf '%b' \"{header}{sample}\"; echo $$ > pid; \
         sleep 300 & wait; sleep 300"
    );
    let (folder, found) = ran(PID, &child(&script.replace('\n', "\\n")));
    assert_eq!(found.unwrap().word(), "lost");
    let pid = std::fs::read_to_string(folder.path().join("pid")).unwrap();
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", pid.trim()));
    assert!(stat.is_err(), "{stat:?}");
}

#[test]
fn a_serial_line_carries_a_run() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let board = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&board).unwrap();
    unlockpt(&board).unwrap();
    let port = ptsname(&board, Vec::new()).unwrap().into_string().unwrap();
    let served = std::thread::spawn(move || {
        let mut board = std::fs::File::from(board);
        let mut lines = BufReader::new(board.try_clone().unwrap());
        let (mut n, mut applied, mut output, mut drive) = (0, 0, 0.0, 0.5);
        let mut line = String::new();
        loop {
            line.clear();
            // Until somebody has opened it, a pseudo-terminal ends at once.
            if lines.read_line(&mut line).unwrap_or(0) == 0 {
                std::thread::sleep(Duration::from_millis(5));
                continue;
            }
            let words: Vec<&str> = line.split(['*', ' ']).collect();
            match words[0] {
                "?" => board
                    .write_all(closed(super::device::HEADER).as_bytes())
                    .unwrap(),
                "Q" => {
                    board.write_all(closed("E host").as_bytes()).unwrap();
                    return n;
                }
                "D" => (applied, drive) = (words[1].parse().unwrap(), words[2].parse().unwrap()),
                _ => {}
            }
            if words[0] == "G" || (words[0] == "D" && applied == n) {
                n += 1;
                output += 0.25 * (2.0 * drive - output);
                let text = format!("S {n} {:.3} {applied} {output:.6} 20", 0.05 * n as f64);
                board
                    .write_all(closed(&text).replace('\n', "\r\n").as_bytes())
                    .unwrap();
            }
        }
    });
    let (folder, found) = ran(PID, &format!("serial = '{port}'\nbaud = 57600"));
    assert_eq!(found.unwrap(), End::Done);
    assert_eq!(rows(&folder.path().join("run.csv")).len(), 60);
    assert!(served.join().unwrap() >= 60);
}
