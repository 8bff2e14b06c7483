//! Times as people and programs write them: read as they were meant, or refused with the row.

use hysteron::{Columns, Error, Place, Recording, Repair};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use time::{Duration, OffsetDateTime, PrimitiveDateTime, UtcOffset};

/// How a moment is written: in UTC, in a zone ahead of it, and in seconds from the first.
struct Moment {
    at: OffsetDateTime,
    seconds: f64,
}

type Format = fn(&Moment) -> String;

/// Hour, minute, second and milliseconds, with this mark before these.
fn clock(at: &PrimitiveDateTime, mark: char) -> String {
    let (h, m, s, ms) = at.as_hms_milli();
    format!("{h:02}:{m:02}:{s:02}{mark}{ms:03}")
}

fn local(moment: &Moment, hours: i8) -> PrimitiveDateTime {
    let there = moment
        .at
        .to_offset(UtcOffset::from_hms(hours, 0, 0).unwrap());
    PrimitiveDateTime::new(there.date(), there.time())
}

fn dated(moment: &Moment, order: fn(i32, u8, u8) -> String, mark: char) -> String {
    let at = local(moment, 0);
    let date = order(at.year(), u8::from(at.month()), at.day());
    format!("{date} {}", clock(&at, mark))
}

fn iso(y: i32, m: u8, d: u8) -> String {
    format!("{y}-{m:02}-{d:02}")
}

fn us(moment: &Moment) -> String {
    let at = local(moment, 0);
    let (h, m, s, ms) = at.as_hms_milli();
    let (half, hour) = (if h < 12 { "AM" } else { "PM" }, (h + 11) % 12 + 1);
    let (year, month, day) = (at.year(), u8::from(at.month()), at.day());
    format!("{month}/{day}/{year} {hour}:{m:02}:{s:02}.{ms:03} {half}")
}

/// Those that mean one moment, whatever stands around them.
const CLEAR: [(&str, Format); 9] = [
    ("iso", |m| dated(m, iso, '.')),
    ("iso, t", |m| dated(m, iso, '.').replace(' ', "T")),
    ("iso, utc", |m| dated(m, iso, '.').replace(' ', "T") + "Z"),
    ("iso, comma", |m| dated(m, iso, ',')),
    ("german", |m| {
        dated(m, |y, m, d| format!("{d:02}.{m:02}.{y}"), ',')
    }),
    ("german, short", |m| {
        dated(m, |y, m, d| format!("{d}.{m}.{:02}", y % 100), '.')
    }),
    ("words", |m| {
        const NAMES: [&str; 12] = [
            "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec",
        ];
        dated(
            m,
            |y, m, d| format!("{d}-{}-{y}", NAMES[usize::from(m) - 1]),
            '.',
        )
    }),
    ("us", us),
    ("iso, zone", |m| {
        let there = local(m, 2);
        let date = iso(there.year(), u8::from(there.month()), there.day());
        format!("{date}T{}+02:00", clock(&there, '.'))
    }),
];

/// Those that are numbers.
const NUMBERS: [(&str, Format); 4] = [
    ("epoch", |m| format!("{:.3}", milliseconds(m) as f64 / 1e3)),
    ("epoch, ms", |m| milliseconds(m).to_string()),
    ("seconds", |m| format!("{:.3}", m.seconds)),
    ("seconds, late", |m| format!("{:.3}", 5000.0 + m.seconds)),
];

/// Those of which day and month may be exchanged.
const SLASHED: [(&str, Format); 2] = [
    ("day first", |m| {
        dated(m, |y, m, d| format!("{d:02}/{m:02}/{y}"), '.')
    }),
    ("month first", |m| {
        dated(m, |y, m, d| format!("{m:02}/{d:02}/{y}"), '.')
    }),
];

fn milliseconds(moment: &Moment) -> i128 {
    moment.at.unix_timestamp_nanos() / 1_000_000
}

/// Moments from a day between 2002 and 2060 on: steps of milliseconds to minutes, and pauses of hours.
fn moments(rng: &mut ChaCha8Rng) -> Vec<Moment> {
    let begin = OffsetDateTime::from_unix_timestamp(rng.random_range(1_010_000_000..2_840_000_000));
    let begin = begin.unwrap();
    let usual = [5, 250, 1000, 60_000][rng.random_range(0..4)];
    let mut passed = 0_i64;
    (0..rng.random_range(3..80))
        .map(|_| {
            let moment = Moment {
                at: begin + Duration::milliseconds(passed),
                seconds: passed as f64 / 1e3,
            };
            passed += match rng.random_bool(0.03) {
                true => rng.random_range(1..20 * 3_600_000),
                false => rng.random_range(usual / 2 + 1..2 * usual),
            };
            moment
        })
        .collect()
}

fn read(cells: &[String], repair: Repair) -> hysteron::Result<Vec<f64>> {
    let rows = cells.iter().enumerate();
    let rows = rows.map(|(n, cell)| format!("{cell};{};{}\n", n % 7, n % 5));
    let text = format!("t;x;y\n{}", rows.collect::<String>());
    let columns = Columns {
        time: Some("t"),
        ..Columns::new("x", "y")
    };
    let memory = hysteron::Memory::new(1 << 24);
    let read = Recording::segments_within("t.csv", text.into_bytes(), columns, repair, &memory);
    let segments = read?.0.into_iter();
    Ok(segments
        .flat_map(|part| part.recording.time.unwrap())
        .collect())
}

/// Times agree from the first sample on. Milliseconds since 1970 are exact to a microsecond.
fn agree(found: &[f64], moments: &[Moment]) -> bool {
    let near = |(t, moment): (&f64, &Moment)| {
        (t - found[0] - (moment.seconds - moments[0].seconds)).abs() < 2e-6
    };
    found.len() == moments.len() && found.iter().zip(moments).all(near)
}

#[test]
fn every_way_to_write_times_is_read() {
    let mut rng = ChaCha8Rng::seed_from_u64(2902);
    for round in 0..400 {
        let moments = moments(&mut rng);
        for (name, format) in CLEAR.iter().chain(&NUMBERS) {
            let cells: Vec<String> = moments.iter().map(format).collect();
            let found = read(&cells, Repair::Refuse).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(
                agree(&found, &moments),
                "round {round}, {name}: {cells:?}\n{found:?}"
            );
        }
    }
}

#[test]
fn day_and_month_are_never_exchanged() {
    let mut rng = ChaCha8Rng::seed_from_u64(2903);
    let mut asked = 0;
    for round in 0..1000 {
        let moments = moments(&mut rng);
        for (name, format) in SLASHED {
            let cells: Vec<String> = moments.iter().map(format).collect();
            match read(&cells, Repair::Refuse) {
                Ok(found) => assert!(agree(&found, &moments), "round {round}, {name}: {cells:?}"),
                Err(error) => {
                    asked += 1;
                    let text = error.to_string();
                    assert!(text.contains("day") && text.contains("month"), "{text}");
                }
            }
        }
    }
    assert!(asked < 100, "{asked} of 2000");
}

/// A cell of another kind is read as it is meant, or its row is named.
#[test]
fn mixed_formats_are_read_or_their_row_is_named() {
    let mut rng = ChaCha8Rng::seed_from_u64(2904);
    let all: Vec<_> = CLEAR.iter().chain(&NUMBERS).collect();
    let mut refused = 0;
    for round in 0..1500 {
        let moments = moments(&mut rng);
        let (name, format) = all[rng.random_range(0..all.len())];
        let (other, another) = all[rng.random_range(0..all.len())];
        // A clock that counts from its start may pause for thirty years: a segment begins there.
        if name.starts_with("seconds") && other.starts_with("epoch") {
            continue;
        }
        let at = rng.random_range(1..moments.len());
        let mut cells: Vec<String> = moments.iter().map(format).collect();
        cells[at] = another(&moments[at]);
        // Seconds of two clocks that rise all the way are those of one clock that paused: nothing
        // in the file tells them apart.
        let numbers: Vec<f64> = cells.iter().flat_map(|cell| cell.parse()).collect();
        if name.starts_with("seconds") && other.starts_with("seconds") && numbers.is_sorted() {
            let found = read(&cells, Repair::Refuse).unwrap();
            assert_eq!(found, numbers, "round {round}: {other} in {name}, row {at}");
            continue;
        }
        match read(&cells, Repair::Refuse) {
            Ok(found) => {
                let told = format!("round {round}: {other} in {name}, row {at}: {cells:?}");
                assert!(agree(&found, &moments), "{told}\n{found:?}");
            }
            Err(Error::Remedied { error, .. }) => {
                refused += 1;
                let Error::Recording { row, .. } = *error else {
                    panic!("{error}");
                };
                // A row that is far ahead is told where the next one goes back.
                let line = |n: usize| Some(Place::Line(n as u64 + 2));
                assert!(
                    row == line(at) || row == line(at + 1),
                    "{row:?}, not {at}: {cells:?}"
                );
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!(refused > 300, "{refused}");
}
