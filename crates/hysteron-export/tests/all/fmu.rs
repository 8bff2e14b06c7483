//! FMUs as files: the description, what is packed, what is refused.

use hysteron::{Model, Operator, Plane, Quantity, Sign};
use hysteron_export::{Fmi, Fmu, FmuOptions, fmu};
use std::collections::{BTreeMap, HashSet};
use std::io::Read;
use std::path::Path;

fn model() -> Model {
    let plane = Plane::new(20.0, 80.0, 3).unwrap();
    // Numbers that a careless writer would round.
    let weights = vec![0.1 + 0.2, 1e-300, 1.0 / 3.0, 0.0, 5e22, f64::MIN_POSITIVE];
    let mut model = Model::new(Operator::Mkp, plane, weights, -0.1, Sign::Negative).unwrap();
    model.input = Quantity::with_unit("wire <\"temperature\"> & 'more'", "°C");
    model.output = Quantity::with_unit("strain", "furlong");
    model
}

fn all_options() -> Vec<FmuOptions> {
    let pairs = [
        (false, Fmi::V2),
        (true, Fmi::V2),
        (false, Fmi::V3),
        (true, Fmi::V3),
    ];
    let options = pairs.map(|(inverse, fmi)| FmuOptions {
        inverse,
        fmi,
        name: None,
    });
    options.to_vec()
}

fn export(model: &Model, options: &FmuOptions) -> (Fmu, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("block.FMU");
    let made = fmu(model, options, &path).unwrap();
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(bytes.len(), made.bytes);
    (made, bytes)
}

pub fn unpacked(bytes: &[u8]) -> BTreeMap<String, Vec<u8>> {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let count = archive.len();
    let mut entry = |n| {
        let mut entry = archive.by_index(n).unwrap();
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        (entry.name().unwrap().into_owned(), content)
    };
    (0..count).map(&mut entry).collect()
}

#[test]
fn the_same_model_is_the_same_file() {
    let mut tokens = HashSet::new();
    for options in all_options() {
        let (first, bytes) = export(&model(), &options);
        assert!((first.clone(), bytes) == export(&model(), &options));
        assert!(tokens.insert(first.token));
    }
    let options = FmuOptions::default();
    let mut renamed = model();
    renamed.input.name = "temperature".into();
    assert!(tokens.insert(export(&renamed, &options).0.token));
    let weights = model().weights().iter().map(|mu| mu * 2.0).collect();
    let other = Model::new(
        Operator::Mkp,
        *model().plane(),
        weights,
        -0.1,
        Sign::Negative,
    )
    .unwrap();
    assert!(tokens.insert(export(&other, &options).0.token));
}

#[test]
fn what_is_packed() {
    let named = FmuOptions {
        name: Some("spring_1".into()),
        ..FmuOptions::default()
    };
    let cases = [
        (
            FmuOptions::default(),
            "binaries/linux64/sf_MKP.so",
            "binaries/win64/sf_MKP.dll",
        ),
        (
            named,
            "binaries/linux64/spring_1.so",
            "binaries/win64/spring_1.dll",
        ),
        (
            FmuOptions {
                inverse: true,
                fmi: Fmi::V3,
                name: None,
            },
            "binaries/x86_64-linux/sf_Inverse_MKP.so",
            "binaries/x86_64-windows/sf_Inverse_MKP.dll",
        ),
    ];
    for (options, linux, windows) in cases {
        let (made, bytes) = export(&model(), &options);
        let files = unpacked(&bytes);
        assert!(files[linux].starts_with(b"\x7fELF") && files[windows].starts_with(b"MZ"));
        let arm = format!("binaries/aarch64-linux/{}.so", made.name);
        assert!(files[&arm].starts_with(b"\x7fELF"));
        macs(&files, options.fmi, &made.name);
        let json = std::str::from_utf8(&files["resources/model.json"]).unwrap();
        assert_eq!(Model::from_json(json).unwrap(), model());
        let text = std::str::from_utf8(&files["resources/model.txt"]).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let block = if options.inverse {
            "block inverse"
        } else {
            "block forward"
        };
        assert_eq!(
            lines[..3],
            ["hysteron-fmu 1", block, &format!("token {}", made.token)]
        );
        assert_eq!(
            lines[3..7],
            [
                "operator mkp",
                "plane 20.0 80.0 3",
                "output -0.1 -1",
                "weights 6"
            ]
        );
        let weights = lines[7..13]
            .iter()
            .map(|line| line.parse::<f64>().unwrap().to_bits());
        assert!(weights.eq(model().weights().iter().map(|mu| mu.to_bits())));
        assert!(files.contains_key("documentation/licenses/license.txt"));
    }
}

#[test]
fn the_description_is_well_formed_and_says_what_the_model_says() {
    for options in all_options() {
        let (made, bytes) = export(&model(), &options);
        let text = unpacked(&bytes).remove("modelDescription.xml").unwrap();
        let text = String::from_utf8(text).unwrap();
        let xml = roxmltree::Document::parse(&text).unwrap();
        let root = xml.root_element();
        assert_eq!(root.attribute("fmiVersion"), Some(options.fmi.version()));
        assert_eq!(root.attribute("modelName"), Some(made.name.as_str()));
        let token = if options.fmi == Fmi::V2 {
            "guid"
        } else {
            "instantiationToken"
        };
        assert_eq!(root.attribute(token), Some(made.token.as_str()));

        let variables: Vec<_> = xml
            .descendants()
            .filter(|node| node.has_attribute("causality"))
            .collect();
        let all = |name| {
            variables
                .iter()
                .map(|v| v.attribute(name).unwrap())
                .collect::<HashSet<_>>()
        };
        assert_eq!(all("name").len(), variables.len());
        assert_eq!(all("valueReference").len(), variables.len());
        let having = |causality| {
            let of = variables
                .iter()
                .filter(|v| v.attribute("causality") == Some(causality));
            of.map(|v| v.attribute("name").unwrap()).collect::<Vec<_>>()
        };
        let temperature = "wire <\"temperature\"> & 'more'";
        let (inputs, outputs, parameters) = match options.inverse {
            false => (
                vec![temperature],
                vec!["strain", "clipped"],
                vec!["start_on"],
            ),
            true => (
                vec!["strain", "heading"],
                vec![temperature, "status"],
                vec!["tolerance", "start_on"],
            ),
        };
        assert_eq!((having("input"), having("output")), (inputs, outputs));
        assert_eq!(
            (having("parameter"), having("independent")),
            (parameters, vec!["time"])
        );
        assert_eq!(
            (having("input"), having("output")),
            (
                made.inputs.iter().map(String::as_str).collect(),
                made.outputs.iter().map(String::as_str).collect()
            )
        );

        let differences = xml
            .descendants()
            .filter(|node| node.has_attribute("relativeQuantity"));
        assert_eq!(
            differences.count(),
            usize::from(options.inverse),
            "the tolerance"
        );

        // Starts as numbers: all operators off.
        let start = variables[1]
            .descendants()
            .find_map(|node| node.attribute("start"))
            .unwrap();
        let expected = if options.inverse {
            model().output_range().0
        } else {
            model().plane().bottom()
        };
        assert_eq!(start.parse(), Ok(expected));

        let units: Vec<_> = xml
            .descendants()
            .filter(|node| node.has_tag_name("Unit"))
            .collect();
        let names: Vec<_> = units
            .iter()
            .map(|unit| unit.attribute("name").unwrap())
            .collect();
        assert_eq!(names, ["furlong", "°C"]);
        assert!(
            units[0].first_element_child().is_none(),
            "nobody says what it is"
        );
        let base = units[1].first_element_child().unwrap();
        assert_eq!(
            (base.attribute("K"), base.attribute("offset")),
            (Some("1"), Some("273.15"))
        );
    }
}

#[test]
fn what_is_refused_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |model: &Model, options: &FmuOptions, name: &str, expected: &str| {
        let error = fmu(model, options, &folder.path().join(name))
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    };
    let plain = FmuOptions::default();
    refused(&model(), &plain, "block.zip", "let it end with .fmu");
    refused(&model(), &plain, "block", "let it end with .fmu");
    refused(&model(), &plain, "no/such/block.fmu", "block.fmu");
    let long = "a".repeat(64);
    for name in ["", "1st", "a b", "é", "../x", "a.b", "CON", &long] {
        let options = FmuOptions {
            name: Some(name.into()),
            ..plain.clone()
        };
        refused(&model(), &options, "block.fmu", "`name`");
    }
    let weights = vec![1.0, -1.0, 1.0];
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let negative = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    let inverse = FmuOptions {
        inverse: true,
        ..plain.clone()
    };
    refused(
        &negative,
        &inverse,
        "block.fmu",
        "1 negative weight(s): operators i=1 j=2",
    );
    assert!(fmu(&negative, &plain, &folder.path().join("block.fmu")).is_ok());
}

/// The libraries for a Mac: two in FMI 3.0. In FMI 2.0 one that holds both, each where its head says.
fn macs(files: &BTreeMap<String, Vec<u8>>, fmi: Fmi, name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("binaries");
    let wanted = ["x86_64-darwin", "aarch64-darwin"];
    let wanted = wanted.map(|system| {
        (
            system,
            std::fs::read(folder.join(system).join("hysteron.dylib")).unwrap(),
        )
    });
    if fmi == Fmi::V3 {
        for (system, bytes) in &wanted {
            assert_eq!(&files[&format!("binaries/{system}/{name}.dylib")], bytes);
        }
        return;
    }
    let fat = &files[&format!("binaries/darwin64/{name}.dylib")];
    let number = |n: usize| u32::from_be_bytes(fat[4 * n..4 * n + 4].try_into().unwrap()) as usize;
    assert_eq!([number(0), number(1)], [0xcafe_babe, 2]);
    for (n, (processor, (_, bytes))) in [0x0100_0007, 0x0100_000c]
        .into_iter()
        .zip(&wanted)
        .enumerate()
    {
        let entry = 2 + 5 * n;
        let (begin, length) = (number(entry + 2), number(entry + 3));
        assert_eq!(number(entry), processor);
        assert_eq!(begin % (1 << number(entry + 4)), 0);
        assert_eq!(&fat[begin..begin + length], bytes);
    }
}

/// The binaries that are packed are those whose hashes stand beside them.
#[test]
fn the_binaries_are_the_recorded_ones() {
    use sha2::Digest;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("binaries");
    let record = std::fs::read_to_string(folder.join("built.txt")).unwrap();
    let files: Vec<&str> = record.lines().filter(|line| line.contains('/')).collect();
    assert_eq!(files.len(), 5);
    for line in files {
        let (hash, name) = line.split_once("  ").unwrap();
        let found = sha2::Sha256::digest(std::fs::read(folder.join(name)).unwrap());
        let found: String = found.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(
            found, hash,
            "{name}: run crates/hysteron-export/binaries/build"
        );
    }
}
