//! A figure: its name, its words, and how it is drawn.

use crate::draw::sheet::{Drawing, Sheet};
use crate::number::capitalised;
use hysteron_files::printable;

/// A figure of what the view `V` holds.
pub(crate) struct Figure<V> {
    /// File name without extension; ids on a page begin with it.
    pub(crate) stem: &'static str,
    /// Number of the chapter's figure that it stands beside.
    pub(crate) chapter: Option<&'static str>,
    /// Width in pixels.
    pub(crate) width: f64,
    /// Whether a page can draw it again from the numbers of its panels, where one zooms.
    pub(crate) is_linked: bool,
    /// The short title at its head, and a caption of a sentence or two; `None` where there is
    /// nothing to show.
    pub(crate) words: fn(&V) -> Option<[String; 2]>,
    /// Draws it below the title; returns the height of the figure, `None` where there is nothing
    /// to show.
    pub(crate) draw: fn(&V, &mut Sheet) -> Option<f64>,
}

/// A figure, drawn.
pub(crate) struct Drawn {
    pub(crate) stem: &'static str,
    pub(crate) chapter: Option<&'static str>,
    pub(crate) width: f64,
    pub(crate) is_linked: bool,
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) drawing: Drawing,
}

impl<V> Figure<V> {
    /// The figure of `view`; what is simulated says so, with `simulated` before its caption. Lines
    /// through so many samples break at those of `begins`.
    pub(crate) fn drawn(
        &self,
        view: &V,
        begins: (usize, &[usize]),
        simulated: Option<&str>,
    ) -> Option<Drawn> {
        let [title, caption] = (self.words)(view)?.map(|words| capitalised(&words));
        let caption = simulated.unwrap_or_default().to_owned() + &caption;
        let note = simulated.map(|_| "simulated, not measured");
        let mut sheet = Sheet::new(self.stem, self.width, &title, note);
        sheet.canvas.breaking(begins);
        let height = (self.draw)(view, &mut sheet)?;
        let mut drawing = sheet.finish(height, &caption);
        // Names come from anywhere; XML allows no control characters.
        drawing.svg = printable(&drawing.svg).into_owned();
        Some(Drawn {
            stem: self.stem,
            chapter: self.chapter,
            width: self.width,
            is_linked: self.is_linked,
            title,
            caption,
            drawing,
        })
    }
}
