//! Words of names, in English, German, French and Spanish.

use super::quantity::Quantity::{self, *};

/// Words that a name has as a whole.
const WHOLE: &[(Quantity, &[&str])] = &[
    (
        Time,
        &[
            "time", "temps", "zeit", "hora", "heure", "date", "datum", "fecha", "clock", "stamp",
        ],
    ),
    (
        Counter,
        &[
            "nr", "no", "id", "row", "step", "fila", "ligne", "zeile", "num",
        ],
    ),
    (
        About,
        &[
            "std", "err", "set", "sp", "soll", "ref", "room", "raum", "model", "copied", "status",
            "noise", "flag", "code", "rh", "bat",
        ],
    ),
    (Drive, &["in", "pwm", "cmd"]),
    (Temperature, &["temp", "tc", "thermo"]),
    (Voltage, &["volt", "volts", "vin"]),
    (Current, &["amp", "amps", "strom"]),
    (Field, &["feld", "champ", "campo"]),
    (Pressure, &["druck"]),
    (Response, &["out", "y_out"]),
    (
        Displacement,
        &["disp", "weg", "hub", "lift", "pos", "course", "gap"],
    ),
    (Angle, &["theta", "phi"]),
    (Polarization, &["pol"]),
    (Flux, &["bl"]),
    (
        Load,
        &[
            "load", "last", "charge", "carga", "gewicht", "weight", "poids", "peso",
        ],
    ),
    (Force, &["kraft"]),
    (X, &["x"]),
    (Y, &["y"]),
];

/// Words that a word of a name begins or ends with: `Federweg` and `Temperaturfühler`.
const PART: &[(Quantity, &[&str])] = &[
    (
        Time,
        &[
            "timestamp",
            "uhrzeit",
            "zeitstempel",
            "tiempo",
            "horodat",
            "elapsed",
            "messzeit",
        ],
    ),
    (Time, &["seconds", "sekunden", "secondes", "segundos"]),
    (
        Counter,
        &[
            "index", "indice", "sample", "count", "counter", "zähler", "muestra", "cycle",
        ],
    ),
    (
        Counter,
        &[
            "zyklus",
            "ciclo",
            "échantillon",
            "echantillon",
            "numer",
            "nummer",
            "numér",
        ],
    ),
    (About, &["humid", "feuchte", "luftfeu", "batter"]),
    (
        About,
        &[
            "sigma",
            "error",
            "erreur",
            "fehler",
            "simulated",
            "residual",
        ],
    ),
    (
        About,
        &[
            "ambient", "ambiant", "umgebung", "setpoint", "sollwert", "consigne", "consigna",
        ],
    ),
    (
        About,
        &[
            "reference",
            "referenz",
            "référence",
            "referencia",
            "target",
            "status",
            "deviation",
        ],
    ),
    (
        Drive,
        &[
            "input", "drive", "duty", "command", "eingang", "stellgr", "entrée", "entree",
        ],
    ),
    (Drive, &["entrada", "excitation", "anregung", "tastgrad"]),
    (
        Temperature,
        &["temperat", "températ", "thermocouple", "thermoelement"],
    ),
    (
        Voltage,
        &["voltage", "spannung", "voltaje", "tension", "tensión"],
    ),
    (
        Stress,
        &[
            "stress",
            "spannung",
            "contrainte",
            "tensión",
            "tension",
            "esfuerzo",
        ],
    ),
    (Force, &["tension"]),
    (
        Current,
        &[
            "current",
            "courant",
            "corriente",
            "stromstärke",
            "intensité",
            "intensidad",
        ],
    ),
    (Power, &["power", "leistung", "puissance", "potencia"]),
    (Field, &["field", "feldst", "magnetfeld"]),
    (Pressure, &["pressure", "pression", "presión", "presion"]),
    (
        Response,
        &[
            "output", "response", "ausgang", "sortie", "salida", "messwert", "réponse",
        ],
    ),
    (
        Displacement,
        &[
            "displacement",
            "extension",
            "stroke",
            "deflection",
            "position",
            "elongation",
            "length",
            "auslenkung",
            "verschiebung",
            "länge",
            "laenge",
            "federweg",
            "stellweg",
            "déplacement",
            "deplacement",
            "allongement",
            "longueur",
            "desplazamiento",
            "posición",
            "posicion",
            "alargamiento",
            "longitud",
            "carrera",
            "recorrido",
        ],
    ),
    (
        Strain,
        &[
            "strain",
            "dehnung",
            "déformation",
            "deformation",
            "deformación",
            "deformacion",
        ],
    ),
    (
        Angle,
        &["angle", "winkel", "rotation", "ángulo", "angulo", "drehung"],
    ),
    (Polarization, &["polariz", "polaris", "polarisation"]),
    (
        Flux,
        &[
            "flux",
            "fluss",
            "magnetiz",
            "magnetis",
            "flujo",
            "induktion",
            "induction",
        ],
    ),
    (
        Resistance,
        &["resistance", "widerstand", "résistance", "resistencia"],
    ),
    (
        Force,
        &[
            "force",
            "fuerza",
            "kraft",
            "effort",
            "torque",
            "drehmoment",
            "couple",
        ],
    ),
];

/// Single letters as physics writes them, where the case counts.
const LETTERS: &[(&str, Quantity)] = &[
    ("T", Temperature),
    ("t", Time),
    ("U", Voltage),
    ("u", Drive),
    ("V", Voltage),
    ("I", Current),
    ("H", Field),
    ("B", Flux),
    ("M", Flux),
    ("F", Force),
    ("R", Resistance),
    ("P", Polarization),
    ("P", Power),
    ("P", Pressure),
    ("p", Pressure),
    ("s", Displacement),
    ("s", Time),
    ("n", Counter),
    ("i", Counter),
];

const SENSORS: [&str; 5] = ["sensor", "capteur", "fühler", "aufnehmer", "transducer"];

/// A word without the sensor at its end: `wegsensor` says what `weg` says.
fn sensed(word: &str) -> &str {
    let bare = SENSORS.iter().find_map(|sensor| word.strip_suffix(sensor));
    bare.filter(|bare| !bare.is_empty()).unwrap_or(word)
}

/// What a name may mean: all that its most telling words mean, or else the `letter` that it begins
/// with, as it is written: `I` is a current, and `i` a counter.
pub(super) fn may_mean(words: &[String], letter: Option<&str>) -> Vec<Quantity> {
    let mut found = Vec::new();
    for (n, word) in words.iter().enumerate() {
        let word = sensed(word);
        let whole = WHOLE.iter().filter(|(_, known)| {
            // One or two letters count only at the beginning: not `Weg in mm`.
            known.contains(&word) && (word.chars().count() > 2 || n == 0)
        });
        found.extend(whole.map(|(quantity, _)| *quantity));
        let each = PART.iter();
        let each =
            each.flat_map(|(quantity, all)| all.iter().map(move |known| (*quantity, *known)));
        let parts = each.filter(|(_, known)| word.starts_with(known) || word.ends_with(known));
        let parts: Vec<(Quantity, &str)> = parts.collect();
        // `extension` is no `tension`.
        let hidden = |known: &str| {
            let mut others = parts.iter();
            others.any(|(_, other)| *other != known && other.contains(known))
        };
        let whole_parts = parts.iter().filter(|(_, known)| !hidden(known));
        found.extend(whole_parts.map(|(quantity, _)| *quantity));
    }
    if found.is_empty() {
        let known = LETTERS.iter().filter(|(known, _)| Some(*known) == letter);
        found.extend(known.map(|(_, quantity)| *quantity));
    }
    found.sort_unstable();
    found.dedup();
    // What a sensor gives before it is converted is about its quantity.
    let of_sensor = |word: &String| SENSORS.iter().any(|sensor| word.contains(sensor));
    let electrical = [Voltage, Current, Resistance];
    if words.iter().any(of_sensor) && electrical.iter().any(|q| found.contains(q)) {
        return vec![About];
    }
    // What is about another column is nothing else; a counter of samples is no drive.
    for alone in [About, Counter, Time] {
        if found.contains(&alone) && found != [Time, Displacement] {
            return vec![alone];
        }
    }
    // `load force` is a load, and `input voltage` a drive.
    for role in [Load, Drive, Response] {
        if found.contains(&role) {
            return vec![role];
        }
    }
    found
}
