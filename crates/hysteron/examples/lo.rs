use hysteron::*;
use std::time::Instant;
const INPUTS: [&str; 5] = ["temperature_C","voltage_V","duty","current_A","H_A_per_m"];
const OUTPUTS: [&str; 9] = ["output","strain","strain_percent","extension_mm","position_m","BL_T","polarization_uC_cm2","displacement_nm","B_T"];
fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let start = std::env::args().nth(2).unwrap_or("off".into());
    let start = match &start[..] {"on"=>Start::On,"unknown"=>Start::Unknown,_=>Start::Off};
    let folder = std::path::Path::new("/work/shared/data");
    let mut names: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).filter(|n| n.ends_with(".csv") && n != "MANIFEST.csv" && n.contains(&only)).collect();
    names.sort();
    for name in names {
        let path = folder.join(&name);
        let table = TableReader::open(&path).unwrap();
        let find = |known: &[&'static str]| known.iter().copied().find(|k| table.header().iter().any(|h| h == k));
        let (i, o) = (find(&INPUTS).unwrap(), find(&OUTPUTS).unwrap());
        let r = Recording::read_csv(&path, Columns::new(i, o)).unwrap();
        print!("{name:36}");
        let watch: Watch = &|_, _| Ok(());
        for (operator, c) in [(Operator::Mkp, Some(Candidates::new(None, None))), (Operator::Mkp, None), (Operator::Kp, None), (Operator::Relay, None)] {
            let t = Instant::now();
            let l = left_out(std::slice::from_ref(&r), &FitOptions { operator, start: if c.is_some() {start} else {Start::Off}, ..FitOptions::default() }, c.as_ref(), watch);
            match l { Ok(l) => {
            print!(" | {:8.3} {:8.3} {:6.2}s", l.training_nrmse_percent, l.nrmse_percent, t.elapsed().as_secs_f64());
            if c.is_some() { print!(" {:?}", l.chosen); } }
            Err(e) => print!(" {e}") }
        }
        println!();
    }
}
