//! The image whose size is measured: an endless loop over nothing, a forward step, or a forward and
//! an inverse step.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::hint::black_box;
    use panic_halt as _;

    #[cfg(not(feature = "double"))]
    type Real = f32;
    #[cfg(feature = "double")]
    type Real = f64;

    #[cfg(feature = "forward")]
    mod model {
        use super::Real;
        use hysteron_core::{Error, Model, Operator, Plane, table_len};

        include!(concat!(env!("OUT_DIR"), "/size.rs"));

        pub type Bench = Model<Real, [Real; table_len(LEVELS)]>;

        pub fn new() -> Result<Bench, Error> {
            let plane = Plane::new(20.0, 80.0, LEVELS)?;
            Model::new(plane, Operator::Mkp, &WEIGHTS, [0.0; table_len(LEVELS)])
        }
    }

    #[cfg(feature = "forward")]
    fn steps() -> Result<(), hysteron_core::Error> {
        use hysteron_core::{Turn, turn_capacity};
        let model = model::new()?;
        let mut state = model.state([Turn::default(); turn_capacity(model::LEVELS)])?;
        #[cfg(feature = "inverse")]
        let inverse = model.inverse()?;
        loop {
            black_box(model.step(&mut state, black_box(0.0))?.output);
            #[cfg(feature = "inverse")]
            {
                use hysteron_core::{Direction, Target};
                let heading = if black_box(true) {
                    None
                } else {
                    let rising = black_box(true);
                    let way = [Direction::Falling, Direction::Rising];
                    Some(way[usize::from(rising)])
                };
                let target = Target {
                    output: black_box(0.0),
                    heading,
                    tolerance: black_box(0.0),
                };
                black_box(inverse.step(&mut state, target)?);
            }
        }
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
        #[cfg(feature = "forward")]
        let _ = black_box(steps());
        loop {
            black_box::<Real>(0.0);
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
