//! What learns on the target: the options of each learner, and the basis of drift.

use super::constants::Constants;
use super::notation::{array, list};
use super::real::{Number, unfit};
use super::text::Beside;
use hysteron::{AdaptOptions, DriftBasis, Learner, Model, Result};
use hysteron_core::{Adaptation, Method, operator_count, table_index, table_len};
use std::fmt::Write;

/// The learners that run on the target, and how C names them.
const LEARNERS: [(Learner, &str); 3] = [
    (Learner::Increments, "increments"),
    (Learner::LeastSquares, "least_squares"),
    (Learner::Drift, "drift"),
];

/// The names and values of the options of a learner.
type Options<T> = [(&'static str, T); 11];

/// What learns on the target.
pub(super) struct Learners<T> {
    levels: usize,
    /// The Everett tables of the basis, one after the other.
    tables: Vec<T>,
    coefficients: Vec<T>,
    /// Trial and burst, and the numbers, of each of [`LEARNERS`].
    options: [(u32, u32, Options<T>); 3],
}

impl<T: Number> Learners<T> {
    /// The library's defaults for `model`.
    pub(super) fn of(model: &Model, constants: &Constants<T>) -> Result<Self> {
        let convert = |number: f64| {
            T::nearest(number)
                .ok_or_else(|| unfit(&format!("an option of {number:e} for a learner")))
        };
        let drift = DriftBasis::of(model, None)?;
        let (plane, operator) = (*constants.core.plane(), constants.core.operator());
        let levels = plane.levels();
        let mut tables = Vec::new();
        for member in &drift.basis {
            let weights: Vec<T> = member
                .iter()
                .map(|&mu| convert(mu))
                .collect::<Result<_>>()?;
            let table = vec![T::ZERO; table_len(levels)];
            let member = hysteron_core::Model::new(plane, operator, &weights, table)
                .map_err(|_| unfit("a member of the basis of drift"))?;
            tables.extend_from_slice(&member.table()[..table_len(levels)]);
        }
        let coefficients = drift.coefficients.iter().map(|&share| convert(share));
        let of = |learner| -> Result<_> {
            let options = AdaptOptions {
                learner,
                ..AdaptOptions::default()
            };
            let options = options.before(model)?;
            let mut numbers = numbers(&options).map(|(name, _)| (name, T::ZERO));
            for ((_, to), (_, from)) in numbers.iter_mut().zip(self::numbers(&options)) {
                *to = convert(from)?;
            }
            Ok((options.trial, options.burst, numbers))
        };
        let [(one, _), (two, _), (three, _)] = LEARNERS;
        Ok(Self {
            levels,
            tables,
            coefficients: coefficients.collect::<Result<_>>()?,
            options: [of(one)?, of(two)?, of(three)?],
        })
    }

    /// Bytes of the constants, without the weights.
    pub(super) fn constants(&self) -> usize {
        const WORD: usize = 4;
        let options = 4 * WORD + 11 * T::BYTES;
        (self.tables.len() + self.coefficients.len()) * T::BYTES + 4 * WORD + 3 * options
    }

    /// Numbers of memory for each of [`LEARNERS`].
    pub(super) fn numbers(&self) -> [usize; 3] {
        let (weights, table) = (operator_count(self.levels), table_len(self.levels));
        let squares = |count: usize| 9 * count + count * (count + 1);
        [
            2 * table + 5 * (weights + 1) + 2 * weights,
            table + squares(weights + 1) + weights,
            table + squares(self.coefficients.len() + 1),
        ]
    }

    /// What stands beside the model `name`.
    pub(super) fn text(&self, name: &str) -> Beside {
        let (sizes, declared) = self.declared(name);
        Beside {
            include: None,
            sizes,
            declared,
            defined: self.defined(name),
        }
    }

    /// Sizes as macros, and the declarations.
    fn declared(&self, name: &str) -> (String, String) {
        let shout = name.to_uppercase();
        let mut sizes = format!(
            "#define {shout}_OPERATORS {}\n",
            operator_count(self.levels)
        );
        let mut declared = format!(
            "extern const hys_real {name}_weights[{shout}_OPERATORS];\n\
             extern const hys_adapt_basis {name}_drift_basis;\n"
        );
        for ((_, learner), numbers) in LEARNERS.iter().zip(self.numbers()) {
            let learner_shout = learner.to_uppercase();
            let _ = writeln!(sizes, "#define {shout}_{learner_shout}_NUMBERS {numbers}");
            let _ = writeln!(declared, "extern const hys_adapt_options {name}_{learner};");
        }
        (sizes, declared)
    }

    /// The definitions, but for the weights.
    fn defined(&self, name: &str) -> String {
        let tables = self.tables.chunks(table_len(self.levels));
        let rows = tables
            .flat_map(|table| (0..=self.levels).map(move |p| &table[table_index(p, 0)..][..=p]));
        let mut text = format!(
            "\nstatic const hys_real drift_tables[] = {}\n\
             static const hys_real drift_coefficients[] = {}\n\
             const hys_adapt_basis {name}_drift_basis = {{drift_tables, drift_coefficients, {}, {}}};\n",
            array(rows),
            list(&self.coefficients),
            self.coefficients.len(),
            table_len(self.levels),
        );
        for ((learner, spelt), (trial, burst, numbers)) in LEARNERS.iter().zip(&self.options) {
            let basis = match learner {
                Learner::Drift => format!("&{name}_drift_basis"),
                _ => "NULL".into(),
            };
            let _ = write!(
                text,
                "\nconst hys_adapt_options {name}_{spelt} = {{\n    .basis = {basis},\n    \
                 .learner = HYS_{},\n    .trial = {trial}u,\n    .burst = {burst}u,\n",
                spelt.to_uppercase()
            );
            for (option, number) in numbers {
                let _ = writeln!(text, "    .{option} = {},", number.literal());
            }
            text += "};\n";
        }
        text
    }
}

/// The options that are numbers, as C names them. Those of other learners are zero.
fn numbers(options: &Adaptation<f64>) -> Options<f64> {
    let (steps, squares) = match options.method {
        Method::Increments { gain, span } => ([gain, span], [0.0; 4]),
        Method::LeastSquares {
            forgetting,
            noise,
            spread,
            correlation,
        } => ([0.0; 2], [forgetting, noise, spread, correlation]),
    };
    [
        ("gain", steps[0]),
        ("span", steps[1]),
        ("forgetting", squares[0]),
        ("noise", squares[1]),
        ("spread", squares[2]),
        ("correlation", squares[3]),
        ("offset_share", options.offset_share),
        ("dead_zone", options.dead_zone),
        ("leakage", options.leakage),
        ("movement", options.movement),
        ("gate", options.gate),
    ]
}
