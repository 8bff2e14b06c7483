//! Writes the page with its tables, from the standard error of the images and from their sizes.

use crate::check::operator;
use crate::data::{FORWARD, LEVELS, Model, Run};
use crate::staged::{MEASURED, STAGED_LEVELS, StagedRun};
use hysteron_core::{Direction, Plane, Target, Turn, operator_count, table_len, turn_capacity};

type Data = (Vec<Model>, Vec<Run>);

const REALS: [(&str, usize); 2] = [("float", 4), ("double", 8)];
const ROUTES: [(&str, &str); 3] = [
    ("plain", "plain loop"),
    ("c", "exported C"),
    ("rust", "Rust core"),
];

/// The aim: so many times fewer instructions than the plain loop at 20 levels.
const AIMS: [(&str, f64); 2] = [("forward", 10.0), ("inverse", 20.0)];
const AIM_LEVELS: usize = 20;

pub fn page(
    data: &Data,
    staged: &[StagedRun],
    page: &str,
    measures: &str,
) -> Result<String, String> {
    let rows = measures
        .lines()
        .map(|line| line.split('\t').collect())
        .collect();
    let measures = Measures(rows);
    let (_, runs) = data;
    let steps: usize = runs.iter().map(|run| run.steps.len()).sum();
    let steps = steps + staged.iter().map(|run| run.steps.len()).sum::<usize>();
    let vectors = runs.iter().filter(|run| run.expected.is_some()).count()
        + staged.iter().filter(|run| run.expected.is_some()).count();
    let mut text = page
        .replace("{{runs}}", &(runs.len() + staged.len()).to_string())
        .replace("{{vectors}}", &vectors.to_string())
        .replace("{{steps}}", &steps.to_string());
    for (name, table) in [
        ("aims", measures.aims()?),
        ("forward", measures.instructions("forward")?),
        ("inverse", measures.instructions("inverse")?),
        ("worst", measures.worst(data)?),
        ("memory", measures.memory()?),
        ("stages", measures.stages()?),
        ("stage_memory", measures.stage_memory()?),
    ] {
        text = text.replace(&format!("{{{{{name}}}}}"), table.trim_end());
    }
    Ok(text)
}

/// Lines of tab-separated words: route, what, number type, run, …
struct Measures<'a>(Vec<Vec<&'a str>>);

/// The step of one kind that took the most instructions.
struct Worst<'a> {
    run: &'a str,
    instructions: f64,
    /// Its index in the run.
    place: usize,
}

impl<'a> Measures<'a> {
    /// The words of a line after these first ones.
    fn find(&self, start: &[&str]) -> Result<&[&'a str], String> {
        let row = self.0.iter().find(|row| row.starts_with(start));
        row.map(|row| &row[start.len()..])
            .ok_or(format!("not measured: {start:?}"))
    }

    fn number(&self, start: &[&str], place: usize) -> Result<f64, String> {
        let words = self.find(start)?;
        let number = words.get(place).and_then(|word| word.parse().ok());
        number.ok_or(format!("no number: {start:?} {words:?}"))
    }

    /// Over all runs with this number of levels.
    fn most(
        &self,
        route: &str,
        real: &str,
        levels: usize,
        kind: &str,
    ) -> Result<Worst<'a>, String> {
        let model = format!("bench_{levels}:");
        let is_of = |row: &&Vec<&str>| {
            row.starts_with(&[route, "steps", real]) && row[3].starts_with(&model) && row[4] == kind
        };
        let runs = self.0.iter().filter(is_of).map(|row| {
            let start = &row[..5];
            Ok(Worst {
                run: row[3],
                instructions: self.number(start, 2)?,
                place: self.number(start, 3)? as usize,
            })
        });
        let runs = runs.collect::<Result<Vec<_>, String>>()?;
        let most = runs
            .into_iter()
            .max_by(|a, b| a.instructions.total_cmp(&b.instructions));
        most.ok_or(format!("not measured: {route} {real} {levels} {kind}"))
    }

    fn mean(
        &self,
        route: &str,
        real: &str,
        levels: usize,
        kind: &str,
        shape: &str,
    ) -> Result<f64, String> {
        let run = format!("bench_{levels}: {kind}, {shape}");
        let start = [route, "steps", real, &run, kind];
        Ok(self.number(&start, 1)? / self.number(&start, 0)?)
    }

    fn instructions(&self, kind: &str) -> Result<String, String> {
        let mut text = String::from(
            "| number | K | steps | plain loop | exported C | Rust core | plain / C | plain / Rust |\n\
             | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n",
        );
        for (real, _) in REALS {
            for levels in LEVELS {
                for shape in ["smooth", "walk", "worst"] {
                    let of = |route: &str| match shape {
                        "worst" => Ok(self.most(route, real, levels, kind)?.instructions),
                        _ => self.mean(route, real, levels, kind, shape),
                    };
                    let [plain, c, rust] = [of("plain")?, of("c")?, of("rust")?];
                    let shape = if shape == "worst" {
                        "worst".into()
                    } else {
                        format!("{shape}, mean")
                    };
                    text += &format!(
                        "| {real} | {levels} | {shape} | {plain:.0} | {c:.0} | {rust:.0} | {:.1} | {:.1} |\n",
                        plain / c,
                        plain / rust
                    );
                }
            }
        }
        Ok(text)
    }

    /// Instructions of the steps of models with stages, beside those of the operators alone.
    fn stages(&self) -> Result<String, String> {
        let mut text = String::from(
            "| number | stages | forward, mean | worst | inverse, mean | worst | Rust core: forward, mean | inverse, mean |\n\
             | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        );
        for (real, _) in REALS {
            for what in ["none"].into_iter().chain(MEASURED) {
                let model = match what {
                    "none" => format!("bench_{STAGED_LEVELS}"),
                    stage => format!("stage_{stage}"),
                };
                let of = |route: &str, kind: &str| -> Result<(f64, f64), String> {
                    let run = format!("{model}: {kind}, walk");
                    let start = [route, "steps", real, &run, kind];
                    let mean = self.number(&start, 1)? / self.number(&start, 0)?;
                    Ok((mean, self.number(&start, 2)?))
                };
                let (forward, inverse) = (of("c", "forward")?, of("c", "inverse")?);
                let (rust, back) = (of("rust", "forward")?, of("rust", "inverse")?);
                text += &format!(
                    "| {real} | {what} | {:.0} | {:.0} | {:.0} | {:.0} | {:.0} | {:.0} |\n",
                    forward.0, forward.1, inverse.0, inverse.1, rust.0, back.0
                );
            }
        }
        Ok(text)
    }

    /// Bytes of models with stages in exported C, beside those of the operators alone.
    fn stage_memory(&self) -> Result<String, String> {
        let mut text = String::from(
            "| number | stages | flash: forward | forward and inverse | of it constants | RAM: state | of it stages | stack: forward | inverse |\n\
             | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        );
        let k = STAGED_LEVELS.to_string();
        for (real, _) in REALS {
            for what in ["none"].into_iter().chain(MEASURED) {
                let (model, size) = match what {
                    "none" => (format!("bench_{k}"), k.as_str()),
                    stage => (format!("stage_{stage}"), stage),
                };
                let flash = |part| self.number(&["c", "size", real, size, part], 0);
                let nothing = self.number(&["c", "size", real, &k, "0"], 0)?;
                let (forward, both) = (flash("1")? - nothing, flash("2")? - nothing);
                let constants = flash("constants")?;
                let run = |kind: &str| format!("{model}: {kind}, walk");
                let ram = |place| self.number(&["c", "ram", real, &run("forward")], place);
                let (stages, operators) = (ram(0)?, ram(1)?);
                let stack = |kind| self.number(&["c", "stack", real, &run(kind)], 0);
                text += &format!(
                    "| {real} | {what} | {forward:.0} | {both:.0} | {constants:.0} | {:.0} | {stages:.0} | {:.0} | {:.0} |\n",
                    stages + operators,
                    stack("forward")?,
                    stack("inverse")?
                );
            }
        }
        Ok(text)
    }

    fn aims(&self) -> Result<String, String> {
        let mut text = String::from(
            "| aim, K = 20 | number | exported C | Rust core |\n| --- | --- | ---: | ---: |\n",
        );
        for (kind, aim) in AIMS {
            for (real, _) in REALS {
                text += &format!("| {kind}: {aim:.0} times fewer than the plain loop | {real} |");
                for route in ["c", "rust"] {
                    let ratio = |shape| -> Result<f64, String> {
                        let of = |route| self.mean(route, real, AIM_LEVELS, kind, shape);
                        Ok(of("plain")? / of(route)?)
                    };
                    let least = ratio("smooth")?.min(ratio("walk")?);
                    let met = if least >= aim { "met" } else { "missed" };
                    text += &format!(" {least:.1}: {met} |");
                }
                text += "\n";
            }
        }
        Ok(text)
    }

    fn worst(&self, data: &Data) -> Result<String, String> {
        let mut text =
            String::from("| number | K | forward | inverse |\n| --- | ---: | --- | --- |\n");
        for (real, _) in REALS {
            for levels in LEVELS {
                let of = |kind| step(data, &self.most("c", real, levels, kind)?);
                text += &format!(
                    "| {real} | {levels} | {} | {} |\n",
                    of("forward")?,
                    of("inverse")?
                );
            }
        }
        Ok(text)
    }

    fn memory(&self) -> Result<String, String> {
        let mut text = String::from(
            "| number | K | route | flash: forward | forward and inverse | of it table or weights | RAM: model and state | stack: forward | inverse |\n\
             | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        );
        for (real, bytes) in REALS {
            for levels in LEVELS {
                for (route, name) in ROUTES {
                    let k = levels.to_string();
                    let flash = |what| self.number(&[route, "size", real, &k, what], 0);
                    let nothing = flash("0")?;
                    let (forward, both) = (flash("1")? - nothing, flash("2")? - nothing);
                    let constants = bytes
                        * if route == "c" {
                            table_len(levels)
                        } else {
                            operator_count(levels)
                        };
                    let run = |shape: &str| format!("bench_{levels}: {shape}");
                    let ram = [route, "ram", real, &run("forward, smooth")];
                    let ram = self.number(&ram, 0)? + self.number(&ram, 1)?;
                    let stack = |kind: &str| -> Result<f64, String> {
                        let of = |shape: &str| {
                            self.number(
                                &[route, "stack", real, &run(&format!("{kind}, {shape}"))],
                                0,
                            )
                        };
                        Ok(of("smooth")?.max(of("walk")?).max(of("adversary")?))
                    };
                    text += &format!(
                        "| {real} | {levels} | {name} | {forward:.0} | {both:.0} | {constants} | {ram:.0} | {:.0} | {:.0} |\n",
                        stack("forward")?,
                        stack("inverse")?
                    );
                }
            }
        }
        let whole = |real| -> Result<f64, String> {
            let flash = |route, what| self.number(&[route, "size", real, "20", what], 0);
            Ok(flash("whole", "2")? - flash("c", "2")?)
        };
        text += &format!(
            "\nWithout `--gc-sections` the exported C takes {:.0} bytes more in float and {:.0} in double.\n",
            whole("float")?,
            whole("double")?
        );
        Ok(text)
    }
}

/// The target or input of the step, and the number of corners in the state before it.
fn step((models, runs): &Data, worst: &Worst<'_>) -> Result<String, String> {
    let run = runs
        .iter()
        .find(|run| run.name == worst.run)
        .ok_or("no such run")?;
    let model = &models[run.model];
    let core = || {
        let plane = Plane::new(model.min, model.max, model.levels)?;
        let table = vec![0.0; table_len(model.levels)];
        let core = hysteron_core::Model::new(plane, operator(model), &model.weights, table)?;
        let mut state = core.state(vec![Turn::default(); turn_capacity(model.levels)])?;
        for &(kind, value) in &run.steps[..worst.place] {
            let heading = if kind > 0 {
                Direction::Rising
            } else {
                Direction::Falling
            };
            match kind {
                FORWARD => core.step(&mut state, value).map(|_| ())?,
                0 => core
                    .inverse()?
                    .step(&mut state, Target::new(value))
                    .map(|_| ())?,
                _ => {
                    let target = Target::new(value).heading(Some(heading));
                    core.inverse()?.step(&mut state, target).map(|_| ())?;
                }
            }
        }
        Ok::<_, hysteron_core::Error>(state.corners())
    };
    let corners = core().map_err(|why| why.to_string())?;
    let (kind, value) = run.steps[worst.place];
    let what = match kind {
        FORWARD => format!("to {value:.1} °C"),
        0 => format!("hold, for {value:.1} mm"),
        _ => format!("anticipate, for {value:.1} mm"),
    };
    Ok(format!("{what}, with {corners} corners held"))
}
