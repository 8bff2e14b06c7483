//! The roles of columns over random tables: right, or in doubt, and never wrong.

use hysteron::{Columns, Recording, Repair, Roles, TableReader, preview_table};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Names of one quantity, and its unit.
type Names = (&'static [&'static str], &'static str);

const TIMES: Names = (
    &[
        "time",
        "Time",
        "Zeit",
        "Temps",
        "tiempo",
        "X_Value",
        "t",
        "timestamp",
        "Uhrzeit",
        "Elapsed",
    ],
    "s",
);
const INPUTS: [Names; 4] = [
    (
        &[
            "temperature",
            "T",
            "Temperatur",
            "Température",
            "temperatura",
            "Draht Temperatur",
            "temp",
        ],
        "°C",
    ),
    (
        &[
            "voltage",
            "U",
            "Voltage",
            "voltaje",
            "drive voltage",
            "Eingangsspannung",
        ],
        "V",
    ),
    (&["current", "I", "Strom", "courant", "corriente"], "A"),
    (&["input", "duty", "Eingang", "entrée", "entrada"], "%"),
];
const OUTPUTS: [Names; 3] = [
    (
        &[
            "displacement",
            "Weg",
            "Federweg",
            "déplacement",
            "desplazamiento",
            "extension",
            "Position",
            "stroke",
            "Auslenkung",
            "SpringLength",
        ],
        "mm",
    ),
    (&["strain", "Dehnung", "déformation", "deformación"], "%"),
    (&["angle", "Winkel", "ángulo"], "deg"),
];
const LOADS: [Names; 2] = [
    (
        &[
            "load",
            "force",
            "Kraft",
            "effort",
            "fuerza",
            "Last",
            "Zugkraft",
            "load cell",
        ],
        "N",
    ),
    (&["stress", "contrainte", "esfuerzo"], "MPa"),
];
/// Names that say nothing.
const MUTE: [&str; 6] = ["a", "Kanal 3", "ch1", "Untitled", "AI0", "wert"];
/// Other columns of loggers.
const OTHERS: [&str; 6] = [
    "ambient temperature",
    "sigma",
    "index",
    "Comment",
    "T_set",
    "status",
];

fn named(rng: &mut ChaCha8Rng, (names, unit): Names) -> String {
    let name = names[rng.random_range(0..names.len())];
    match rng.random_range(0..4) {
        0 => name.to_owned(),
        1 => format!("{name} [{unit}]"),
        2 => format!("{name} ({unit})"),
        _ => format!("{name}_{}", unit.trim_start_matches('°')),
    }
}

struct Drawn {
    text: String,
    /// Input, output, time and load.
    truth: [Option<String>; 4],
    /// Whether names say all roles.
    telling: bool,
}

fn draw(rng: &mut ChaCha8Rng) -> Drawn {
    let rows = rng.random_range(30..200);
    let with_time = rng.random_bool(0.8);
    let with_load = rng.random_bool(0.4);
    let telling = rng.random_bool(0.6);
    // Without names, all that is known of a column are its values.
    let name = |rng: &mut ChaCha8Rng, names, mute: &mut Vec<&str>| match telling {
        true => named(rng, names),
        false if rng.random_bool(0.5) => named(rng, names),
        false => mute.pop().unwrap().to_owned(),
    };
    let mut mute = MUTE.to_vec();
    mute.shuffle(rng);
    let inputs = INPUTS[rng.random_range(0..INPUTS.len())];
    let outputs = OUTPUTS[rng.random_range(0..OUTPUTS.len())];
    let loads = LOADS[rng.random_range(0..LOADS.len())];
    let input = name(rng, inputs, &mut mute);
    let output = name(rng, outputs, &mut mute);
    let time = name(rng, TIMES, &mut mute);
    let load = name(rng, loads, &mut mute);
    let speed = rng.random_range(0.05..0.4);
    let phase = rng.random_range(0.0..6.0);
    let back = rng.random_bool(0.2).then(|| rng.random_range(1..rows));
    let jitter = rng.random_range(0.0..0.1);
    let mut columns: Vec<(String, Vec<String>)> = Vec::new();
    let mut push = |name: &str, of: &mut dyn FnMut(usize) -> String| {
        columns.push((name.to_owned(), (0..rows).map(of).collect()));
    };
    let x = |n: usize| 50.0 + 30.0 * (speed * n as f64 + phase).sin();
    push(&input, &mut |n| x(n).to_string());
    let mut y = x(0);
    push(&output, &mut |n| {
        y = y.clamp(x(n) - 5.0, x(n) + 5.0);
        (0.2 * y).to_string()
    });
    if with_time {
        let stamps = rng.random_bool(0.2);
        push(&time, &mut |n| {
            let n = if back.is_some_and(|back| n >= back) {
                n as f64 - 20.0
            } else {
                n as f64
            };
            let t = 0.5 * (n + rng.random_range(0.0..=jitter)) + 100.0;
            match stamps {
                true => format!("2026-11-23T14:{:02}:{:06.3}", (t / 60.0) as u32, t % 60.0),
                false => t.to_string(),
            }
        });
    }
    if with_load {
        let steps = rng.random_range(2..5);
        push(&load, &mut |n| (10 * (1 + n * steps / rows)).to_string());
    }
    for other in OTHERS {
        if rng.random_bool(0.25) {
            push(other, &mut |n| match other {
                "Comment" => "ok".to_owned(),
                "index" => n.to_string(),
                _ => rng.random_range(0.0..3.0).to_string(),
            });
        }
    }
    columns.shuffle(rng);
    let header: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = header.join(";") + "\n";
    for n in 0..rows {
        let cells: Vec<&str> = columns.iter().map(|(_, cells)| cells[n].as_str()).collect();
        text += &(cells.join(";") + "\n");
    }
    Drawn {
        text,
        truth: [
            Some(input),
            Some(output),
            with_time.then_some(time),
            with_load.then_some(load),
        ],
        telling,
    }
}

fn roles(text: &str) -> Roles {
    let mut table = TableReader::from_bytes("run.csv", text.to_owned(), 1 << 24).unwrap();
    preview_table(&mut table).unwrap().roles
}

#[test]
fn roles_are_right_or_in_doubt() {
    let mut rng = ChaCha8Rng::seed_from_u64(2900);
    let mut doubtful = 0;
    for round in 0..10_000 {
        let Drawn {
            text,
            truth: [input, output, time, load],
            telling,
        } = draw(&mut rng);
        let found = roles(&text);
        let header = text.lines().next().unwrap();
        let at = format!("round {round}: {header}: {found:?}");
        if found.doubts.is_empty() {
            assert_eq!((&found.input, &found.output), (&input, &output), "{at}");
            assert!(found.time.is_none() || found.time == time, "{at}");
            assert!(found.load.is_none() || found.load == load, "{at}");
        } else {
            doubtful += 1;
        }
        if telling {
            assert!(found.doubts.is_empty(), "{at}");
            assert_eq!((found.time, found.load), (time, load), "{at}");
        }
    }
    // Names that say nothing are often in doubt; else the test says nothing of doubts.
    assert!((1000..5000).contains(&doubtful), "{doubtful}");
}

/// Input, output, time and load; a question mark for a role in doubt.
fn told(text: &str) -> [String; 4] {
    let roles = roles(text);
    let doubtful = |role| roles.doubts.iter().any(|doubt| doubt.role == role);
    let text = |name: Option<String>, role| match doubtful(role) {
        true => "?".to_owned(),
        false => name.unwrap_or_default(),
    };
    [
        text(roles.input.clone(), "input"),
        text(roles.output.clone(), "output"),
        text(roles.time.clone(), "time"),
        text(roles.load.clone(), "load"),
    ]
}

/// Roles of columns of which the first rises and the others go up and down.
fn rising_first(header: &str) -> [String; 4] {
    let rows = (0..24).map(|n| {
        let x = f64::from(n) * 0.8;
        format!("{n},{},{},{}\n", x.sin(), x.cos(), (x / 2.0).cos())
    });
    told(&format!("{header}\n{}", rows.collect::<String>()))
}

/// A clock that falls is a history backwards: it is taken for the time, and reading it says so. One
/// that goes both ways is told.
#[test]
fn a_clock_that_falls_is_not_passed_over() {
    let table = |time: &dyn Fn(i32) -> i32| {
        let rows = (0..200).map(|n| {
            let x = f64::from(n) * 0.1;
            format!("{},{},{}\n", time(n), x.sin(), x.cos())
        });
        format!(
            "time,temperature_C,displacement_mm\n{}",
            rows.collect::<String>()
        )
    };
    let falls = table(&|n| 200 - n);
    assert_eq!(roles(&falls).time.as_deref(), Some("time"));
    let columns = Columns {
        time: Some("time"),
        ..Columns::new("temperature_C", "displacement_mm")
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, &falls).unwrap();
    for repair in [Repair::Refuse, Repair::Mend] {
        let refused = Recording::read(&path, columns, repair).unwrap_err();
        let refused = refused.to_string();
        assert!(
            refused.contains("the newest first: bring the rows"),
            "{refused}"
        );
    }
    let mixed = roles(&table(&|n| 7 * n % 11));
    assert_eq!(mixed.time, None);
    let told = &mixed.reasons;
    assert!(
        told.iter().any(|told| told.starts_with("no time")),
        "{told:?}"
    );
}

#[test]
fn columns_are_known_by_name_and_unit() {
    let all = [
        (
            "time_s,duty,position_m,sensor_voltage_V",
            ["duty", "position_m", "time_s", ""],
        ),
        (
            "time_s,temperature_C,extension_mm,load_N",
            ["temperature_C", "extension_mm", "time_s", "load_N"],
        ),
        (
            "time_min,current_A,BL_T,BL_sigma",
            ["current_A", "BL_T", "time_min", ""],
        ),
        (
            "time_s,voltage_V,polarization_uC_cm2,current_A",
            ["voltage_V", "polarization_uC_cm2", "time_s", ""],
        ),
        ("n,H_A_per_m,B_T,copied", ["H_A_per_m", "B_T", "", ""]),
        (
            "Zeit,Kraft,Temperatur,Weg in mm",
            ["Temperatur", "Weg in mm", "Zeit", "Kraft"],
        ),
        (
            "X_Value,Spannung [V],Weg [mm],Comment",
            ["Spannung [V]", "Weg [mm]", "X_Value", ""],
        ),
        (
            "time [s],humidity [%],temperature [degC],displacement [um]",
            ["temperature [degC]", "displacement [um]", "time [s]", ""],
        ),
        (
            "Zeit,T [°C],Dehnung [%],Spannung [MPa]",
            ["T [°C]", "Dehnung [%]", "Zeit", "Spannung [MPa]"],
        ),
        (
            "Temps (s),Température (°C),Déplacement (mm),Effort (N)",
            [
                "Température (°C)",
                "Déplacement (mm)",
                "Temps (s)",
                "Effort (N)",
            ],
        ),
        (
            "tiempo,tensión [V],desplazamiento,fuerza [N]",
            ["tensión [V]", "desplazamiento", "tiempo", "fuerza [N]"],
        ),
        // The unit alone, where the name says nothing.
        (
            "a [s],b [degC],c [mm],d [N]",
            ["b [degC]", "c [mm]", "a [s]", "d [N]"],
        ),
        ("a,x,y,sigma", ["x", "y", "a", ""]),
        ("row,T,foo,T_set", ["T", "foo", "", ""]),
        (
            "Zeit,Force sensor [N],Temperature [C],Wegsensor",
            ["Temperature [C]", "Wegsensor", "Zeit", "Force sensor [N]"],
        ),
        // A word within another, and a letter in upper and in lower case.
        (
            "time_s,extension,I_A,stress_MPa",
            ["I_A", "extension", "time_s", "stress_MPa"],
        ),
        (
            "Zeit,i [A],Wegaufnehmer,n",
            ["i [A]", "Wegaufnehmer", "Zeit", ""],
        ),
    ];
    for (header, expected) in all {
        assert_eq!(rising_first(header), expected, "{header}");
    }
}

#[test]
fn what_cannot_be_told_is_in_doubt() {
    let all = [
        ("t,a,b,c", ["?", "?", "t", ""]),
        // Two temperatures, two displacements, a stress or a voltage.
        ("t,T1,T2,weg", ["?", "weg", "t", ""]),
        ("t,T,left position,right position", ["T", "?", "t", ""]),
        ("t,Temperatur,Spannung,Dehnung", ["?", "Dehnung", "t", ""]),
        // A wire that is pulled, and one that is heated.
        ("t,strain,stress,sigma", ["?", "?", "t", ""]),
        ("t,sigma,std,error", ["?", "?", "t", ""]),
    ];
    for (header, expected) in all {
        assert_eq!(rising_first(header), expected, "{header}");
    }
}

#[test]
fn what_rises_evenly_is_no_output() {
    for name in ["foo", "x", "Weg", "output", "a [mm]"] {
        let [_, output, ..] = rising_first(&format!("{name},T,power,c"));
        assert_ne!(output, name);
    }
    // A clock and a slow input, or the other way round.
    let rows: String = (0..40)
        .map(|n| format!("{n},{},{}\n", 3 * n, (n % 7).min(4)))
        .collect();
    assert_eq!(told(&format!("foo,bar,Weg\n{rows}")), ["?", "Weg", "", ""]);
    let rows: String = (0..40)
        .map(|n| format!("{n},{},{}\n", n % 7, n % 5))
        .collect();
    assert_eq!(told(&format!("foo,bar,Weg\n{rows}")), ["?", "Weg", "", ""]);
    assert_eq!(told(&format!("foo,T,Weg\n{rows}")), ["T", "Weg", "foo", ""]);
    // A clock that is set back, timestamps, and `t` that goes up and down.
    let rows: String = (0..40)
        .map(|n| format!("{},{},{}\n", n % 25, n % 7, n % 5))
        .collect();
    assert_eq!(
        told(&format!("foo,T,lift\n{rows}")),
        ["T", "lift", "foo", ""]
    );
    let rows: String = (10..50)
        .map(|n| format!("23.11.2026 14:03:{n},{},{}\n", n % 7, n % 5))
        .collect();
    assert_eq!(
        told(&format!("foo,T,lift\n{rows}")),
        ["T", "lift", "foo", ""]
    );
    let rows: String = (0..40).map(|n| format!("{},{}\n", n % 7, n % 5)).collect();
    assert_eq!(told(&format!("t,lift\n{rows}")), ["t", "lift", "", ""]);
}

#[test]
fn a_load_counts_where_it_changes() {
    let text = "temperature_C,strain,stress_MPa\n30,0,50\n80,1,51\n30,0,150\n";
    assert_eq!(told(text)[3], "stress_MPa");
    let text = "temperature_C,strain,stress_MPa\n30,0,50\n80,1,51\n30,0,50\n";
    assert_eq!(told(text)[3], "");
    assert_eq!(
        told("voltage,force\n0,0\n2,1\n1,3\n"),
        ["voltage", "force", "", ""]
    );
}
