//! A device on a socket, with a proxy before it that does what a cable, a sensor or a board may do.

use hysteron_bench::protocol::{closed, opened};
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// What goes wrong at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Its line never comes.
    Drop,
    /// Its line comes twice.
    Double,
    /// A bit of its line turns.
    Corrupt,
    /// Half of its line comes.
    Cut,
    /// The line of an earlier sample comes before it.
    Old,
    /// Lines without meaning come before it.
    Flood,
    /// It comes late, ms.
    Delay(u64),
    /// The reading is lost for so many samples.
    Nan(u64),
    /// The reading is off by so much, once.
    Spike(f64),
    /// The reading stands still from here on.
    Stuck,
    /// What it measures is jammed from here on; its noise goes on.
    Jam,
    /// The sensor is turned round from here on.
    Turned,
    /// The drive that answers it never comes.
    NoDrive,
    /// Nothing comes any more.
    Freeze,
    /// The line breaks.
    Kill,
    /// The device ends by itself.
    Ends,
}

impl Fault {
    /// Whether a run has to end with it.
    pub fn is_fatal(self) -> bool {
        matches!(self, Self::Stuck | Self::Freeze | Self::Kill | Self::Ends)
    }
}

/// What the device has seen.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Drives by sample, as they came.
    pub drives: Vec<(u64, f64)>,
    /// Lines with a wrong check.
    pub wrong: usize,
    /// The drive at the end.
    pub drive: f64,
    pub quit: bool,
    pub samples: u64,
}

pub const DT: f64 = 0.05;
pub const SAFE: f64 = 0.5;
pub const HEADER: &str =
    "H 1 name=test dt=0.05 drive=0:10[V] safe=0.5 watchdog=1 columns=output[mm],temperature[degC]";

/// A lag of 0.2 s with a gain of 2, read with a noise of 0.002.
#[derive(Default)]
struct Board {
    faults: Vec<(u64, Fault)>,
    stream: Option<TcpStream>,
    report: Report,
    applied: u64,
    output: f64,
    stuck: Option<f64>,
    jammed: Option<f64>,
    turned: bool,
    frozen: bool,
    lost_until: u64,
    last_line: String,
}

/// Starts a device that serves one run. Its address, and what it has seen.
pub fn start(faults: Vec<(u64, Fault)>) -> (String, JoinHandle<Report>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let served = thread::spawn(move || {
        let (stream, _) = listener.accept().unwrap();
        serve(stream, faults)
    });
    (address, served)
}

fn serve(stream: TcpStream, faults: Vec<(u64, Fault)>) -> Report {
    // Where every sample is answered, a busy machine must not look like a drive that was lost.
    let answered = |(_, fault): &(u64, Fault)| matches!(fault, Fault::Spike(_));
    let patience = match faults.iter().all(answered) {
        true => Duration::from_secs(5),
        false => Duration::from_millis(20),
    };
    stream.set_read_timeout(Some(patience)).unwrap();
    stream.set_nodelay(true).unwrap();
    let mut lines = BufReader::new(stream.try_clone().unwrap());
    let mut board = Board {
        faults,
        stream: Some(stream),
        ..Board::default()
    };
    board.report.drive = SAFE;
    let (mut line, mut waits) = (Vec::new(), 0);
    loop {
        match lines.read_until(b'\n', &mut line) {
            Ok(0) => break,
            Ok(_) => {
                waits = 0;
                let heard = board.hear(&line);
                line.clear();
                if !heard {
                    break;
                }
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                waits += 1;
                if waits > 150 {
                    break;
                }
                // A board goes on with the drive that it has.
                if board.report.samples > 0 {
                    board.sample();
                }
            }
            Err(_) => break,
        }
    }
    if !board.report.quit {
        // The watchdog.
        board.report.drive = SAFE;
    }
    board.report
}

impl Board {
    /// Whether it goes on.
    fn hear(&mut self, line: &[u8]) -> bool {
        let Some(text) = opened(line.strip_suffix(b"\n").unwrap_or(line)) else {
            self.report.wrong += 1;
            return true;
        };
        let words: Vec<&str> = text.split(' ').collect();
        match words[0] {
            "?" => self.send(&closed(HEADER)),
            "G" => self.sample(),
            "Q" => {
                self.report.quit = true;
                self.report.drive = SAFE;
                self.send(&closed("E host"));
                return false;
            }
            "D" => {
                let number: u64 = words[1].parse().unwrap();
                let drive = words[2].parse().unwrap();
                if self.faults.contains(&(number, Fault::NoDrive)) {
                    return true;
                }
                self.report.drives.push((number, drive));
                self.report.drive = drive;
                let new = number == self.report.samples && self.applied != number;
                self.applied = number;
                if new {
                    self.sample();
                }
            }
            _ => self.report.wrong += 1,
        }
        true
    }

    fn sample(&mut self) {
        self.output += DT / 0.2 * (2.0 * self.report.drive - self.output);
        self.report.samples += 1;
        let n = self.report.samples;
        let turns = (n as f64 * 12.9898).sin() * 43758.5453;
        let mut reading =
            self.jammed.unwrap_or(self.output) + 0.007 * (turns - turns.floor() - 0.5);
        let faults: Vec<Fault> = self
            .faults
            .iter()
            .filter(|(at, _)| *at == n)
            .map(|(_, f)| *f)
            .collect();
        let mut times = 1;
        let (mut corrupt, mut cut) = (false, false);
        for fault in faults {
            match fault {
                Fault::Drop => times = 0,
                Fault::Double => times = 2,
                Fault::Corrupt => corrupt = true,
                Fault::Cut => cut = true,
                Fault::Old => self.send(&self.last_line.clone()),
                Fault::Flood => (0..500).for_each(|n| self.send(&format!("S {n} nonsense\n"))),
                Fault::Delay(ms) => thread::sleep(Duration::from_millis(ms)),
                Fault::Nan(count) => self.lost_until = n + count,
                Fault::Spike(size) => reading += size,
                Fault::Stuck => self.stuck = Some(reading),
                Fault::Jam => self.jammed = Some(self.output),
                Fault::Turned => self.turned = true,
                Fault::Freeze => self.frozen = true,
                Fault::Kill => {
                    let _ = self
                        .stream
                        .take()
                        .map(|stream| stream.shutdown(Shutdown::Both));
                }
                Fault::Ends => {
                    self.send(&closed("E limit"));
                    self.frozen = true;
                }
                Fault::NoDrive => {}
            }
        }
        let reading = self.stuck.unwrap_or(reading);
        let reading = if self.turned { -reading } else { reading };
        let reading = match n < self.lost_until {
            true => "nan".to_owned(),
            false => format!("{reading:.6}"),
        };
        let (time, applied) = (n as f64 * DT, self.applied);
        let line = closed(&format!("S {n} {time:.3} {applied} {reading} 21.5"));
        self.last_line.clone_from(&line);
        let mut bytes = line.into_bytes();
        if corrupt {
            bytes[6] ^= 1;
        }
        if cut {
            bytes.truncate(9);
        }
        for _ in 0..times {
            self.send_bytes(&bytes);
        }
    }

    fn send(&mut self, line: &str) {
        self.send_bytes(line.as_bytes());
    }

    fn send_bytes(&mut self, bytes: &[u8]) {
        if let (Some(stream), false) = (&mut self.stream, self.frozen) {
            let _ = stream.write_all(bytes);
        }
    }
}
