//! Asks a device who it is.

use crate::device::{Line, Received};
use crate::end::Stop;
use crate::protocol::{FromDevice, Header, ToDevice, opened};
use std::time::{Duration, Instant};

/// How long a device may take to say who it is, and how often it is asked: a board restarts when
/// its port is opened, and a program may have much to load.
const ANSWER: Duration = Duration::from_secs(15);
const AGAIN: Duration = Duration::from_secs(1);
/// How often somebody who stops the run is looked for.
const LOOK: Duration = Duration::from_millis(20);

/// Who the device is; `None` in the error for somebody who stopped it.
pub(crate) fn ask(line: &mut dyn Line, stop: &Stop) -> std::result::Result<Header, Option<String>> {
    let start = Instant::now();
    let mut asked = None;
    let mut came = 0;
    while start.elapsed() < ANSWER {
        if stop.is_set() {
            return Err(None);
        }
        if asked.is_none_or(|at: Instant| at.elapsed() >= AGAIN) {
            let sent = line.send(&ToDevice::Who.line());
            sent.map_err(|error| Some(format!("it cannot be asked who it is: {error}")))?;
            asked = Some(Instant::now());
        }
        match line.receive(Instant::now() + LOOK) {
            // A board that was running says other things first.
            Received::Line(bytes, _) => {
                came += bytes.len();
                if let Some(FromDevice::Header(header)) = opened(&bytes).and_then(FromDevice::parse)
                {
                    return header.map_err(Some);
                }
            }
            Received::Silence => {}
            Received::Closed => return Err(Some("it ended before it said who it is".into())),
        }
    }
    let heard = match came {
        0 => "nothing came from it: is this its port, and does it run a program of this protocol?"
            .to_owned(),
        _ => format!(
            "{came} bytes came, none of them its first line: is the baud rate that of the device, and \
             does it run a program of this protocol?"
        ),
    };
    Err(Some(format!(
        "it did not say who it is within {} s; {heard}",
        ANSWER.as_secs()
    )))
}
