use crate::data::preview_table;
use crate::data::table::TableReader;

/// Input, output, time and load; a question mark for a role in doubt.
fn roles(text: &str) -> [String; 4] {
    let mut table = TableReader::from_bytes("t.csv", text.to_owned(), 1 << 20).unwrap();
    let roles = preview_table(&mut table).unwrap().roles;
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
    roles(&format!("{header}\n{}", rows.collect::<String>()))
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
    // A clock that is set back, timestamps, and `t` that goes up and down.
    let rows: String = (0..40)
        .map(|n| format!("{},{},{}\n", n % 25, n % 7, n % 5))
        .collect();
    assert_eq!(
        roles(&format!("foo,T,lift\n{rows}")),
        ["T", "lift", "foo", ""]
    );
    let rows: String = (10..50)
        .map(|n| format!("23.11.2026 14:03:{n},{},{}\n", n % 7, n % 5))
        .collect();
    assert_eq!(
        roles(&format!("foo,T,lift\n{rows}")),
        ["T", "lift", "foo", ""]
    );
    let rows: String = (0..40).map(|n| format!("{},{}\n", n % 7, n % 5)).collect();
    assert_eq!(roles(&format!("t,lift\n{rows}")), ["t", "lift", "", ""]);
}

#[test]
fn a_load_counts_where_it_changes() {
    let text = "temperature_C,strain,stress_MPa\n30,0,50\n80,1,51\n30,0,150\n";
    assert_eq!(roles(text)[3], "stress_MPa");
    let text = "temperature_C,strain,stress_MPa\n30,0,50\n80,1,51\n30,0,50\n";
    assert_eq!(roles(text)[3], "");
    assert_eq!(
        roles("voltage,force\n0,0\n2,1\n1,3\n"),
        ["voltage", "force", "", ""]
    );
}
