use hysteron::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let r = Recording::read_csv(std::path::Path::new(&format!("/work/shared/data/{}.csv", a[1])), Columns::new(&a[2], &a[3])).unwrap();
    let start = match a.get(4).map(|s| &s[..]) {Some("on")=>Start::On,Some("unknown")=>Start::Unknown,_=>Start::Off};
    for levels in [5, 7, 10, 14, 20, 28, 40] {
        print!("{levels:3}");
        for smooth in [0.0, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
            let l = left_out(std::slice::from_ref(&r), &FitOptions { levels, smooth, start, ..FitOptions::default() }, None, &|_, _| Ok(())).unwrap();
            print!(" {:7.3}/{:7.3}", l.training_nrmse_percent, l.nrmse_percent);
        }
        println!();
    }
}
