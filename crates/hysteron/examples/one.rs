use hysteron::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let r = Recording::read_csv(std::path::Path::new(&format!("/work/shared/data/{}.csv", a[1])), Columns::new(&a[2], &a[3])).unwrap();
    let start = match &a[4][..] {"on"=>Start::On,"unknown"=>Start::Unknown,_=>Start::Off};
    let t = std::time::Instant::now();
    let m = fit(&r, &FitOptions { levels: a[5].parse().unwrap(), smooth: a[6].parse().unwrap(), start, ..FitOptions::default() }).unwrap();
    println!("{} {:?} {:?}", m.fit.as_ref().unwrap().rmse, m.fit.as_ref().unwrap().weights_not_zero, t.elapsed());
}
