//! What a report shows: figures in sections, and the words around them.

use crate::figure::Figure;
use hysteron::{Setting, Verdict};
use maud::{Markup, html};

/// What a report shows; its views are subjects.
pub(crate) trait Subject: Sized {
    /// All figures, in the order of the page.
    fn sections() -> Vec<Section<Self>>;

    /// The number of samples, and those at which another recording begins: lines through so many
    /// samples break there.
    fn begins(&self) -> (usize, &[usize]) {
        (0, &[])
    }

    /// How page and captions say that the data are simulated, where they are.
    fn simulated(&self) -> Option<Simulated>;

    /// The sentence below the heading.
    fn lead(&self) -> Markup;

    /// What stands above the sections.
    fn above(&self) -> Markup;

    /// What stands below them.
    fn below(&self) -> Markup {
        html! {}
    }
}

/// A part of a page; without figures and notes, it does not appear.
pub(crate) struct Section<V> {
    /// Its heading; a page of one section needs none.
    pub(crate) name: &'static str,
    /// Its figures; those of one row stand side by side where there is room.
    pub(crate) rows: Vec<Vec<Figure<V>>>,
    /// What stands above and below its figures.
    pub(crate) notes: fn(&V) -> [Markup; 2],
}

impl<V> Section<V> {
    /// Figures one below the other.
    pub(crate) fn column(name: &'static str, figures: Vec<Figure<V>>) -> Self {
        Self::new(
            name,
            figures.into_iter().map(|figure| vec![figure]).collect(),
        )
    }

    /// Figures in rows.
    pub(crate) fn new(name: &'static str, rows: Vec<Vec<Figure<V>>>) -> Self {
        Self {
            name,
            rows,
            notes: |_| [html! {}, html! {}],
        }
    }

    pub(crate) fn figures(&self) -> impl Iterator<Item = &Figure<V>> {
        self.rows.iter().flatten()
    }
}

/// How a report says that nothing in it was measured.
#[derive(Clone, Copy)]
pub(crate) struct Simulated {
    /// A sentence at the head of the page.
    pub(crate) page: &'static str,
    /// What each caption begins with.
    pub(crate) caption: &'static str,
}

impl Simulated {
    /// Of a recording.
    pub(crate) const RECORDING: &'static str =
        "Simulated: this recording comes from a simulated plant, not from a measurement.";
}

/// Whether a model is good enough, and if not, why.
pub(crate) fn verdict(verdict: Option<&Verdict>) -> Markup {
    let lines = verdict
        .into_iter()
        .flat_map(|verdict| verdict.lines(Setting::typed));
    html! {
        div.wide { table.facts.verdict { @for (heading, text) in lines {
            tr { th scope="row" { (heading) } td { (told(heading, &text)) } }
        } } }
    }
}

/// The grade stands out.
fn told(heading: &str, text: &str) -> Markup {
    match text.split_once(": ").filter(|_| heading == "verdict") {
        Some((grade, rest)) => {
            html! { strong class=(format!("grade {grade}")) { (grade) } ": " (rest) }
        }
        None => html! { (text) },
    }
}
