//! What both reports are made of: figures with titles and captions, written as files around a page.

use crate::draw::sheet::{Drawing, Sheet};
use crate::error::ReportError;
use crate::frame;
use crate::linked;
use crate::png;
use hysteron::{AtomicFile, AtomicFolder, Destination, Own, printable};
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// A set of figures and the page around them.
pub(crate) trait Figures {
    /// Names a figure.
    type Figure: Copy + PartialEq + 'static;

    /// Every figure, in the order of the page.
    const ALL: &'static [Self::Figure];

    /// The figure's file name without extension.
    fn stem(figure: Self::Figure) -> &'static str;

    /// Whether the data are simulated; every figure then says so.
    fn simulated(&self) -> bool;

    /// The short title at the head of a figure.
    fn title(&self, figure: Self::Figure) -> String;

    /// What a figure shows, in a sentence or two.
    fn caption(&self, figure: Self::Figure) -> String;

    /// The figure; `None` where there is nothing to show in it.
    fn draw(&self, figure: Self::Figure) -> Option<Drawing>;

    /// The page around the figures in `drawn`.
    fn page(&self, drawn: &[(Self::Figure, Drawing)]) -> String;

    /// Whether a page can draw the figure again from the numbers of its panels, where one zooms.
    fn is_linked(figure: Self::Figure) -> bool;

    /// What the page needs at its end, so that its figures zoom.
    fn scripts(&self, drawn: &[(Self::Figure, Drawing)]) -> Markup {
        let linked = drawn.iter().filter(|(figure, _)| Self::is_linked(*figure));
        linked::scripts(linked.map(|(figure, drawing)| (Self::stem(*figure), drawing)))
    }

    /// The empty sheet of a figure.
    fn sheet(&self, figure: Self::Figure, width: f64) -> Sheet {
        let note = self.simulated().then_some("simulated, not measured");
        Sheet::new(Self::stem(figure), width, &self.title(figure), note)
    }

    /// The finished figure with its caption as spoken text.
    fn finish(&self, figure: Self::Figure, sheet: Sheet, height: f64) -> Drawing {
        sheet.finish(height, &self.caption(figure))
    }

    /// A drawn figure on the page, with its number, title and caption; `beside` ends the caption.
    fn picture(
        &self,
        figure: Self::Figure,
        drawn: &[(Self::Figure, Drawing)],
        beside: Markup,
    ) -> Markup {
        let mut numbered = drawn.iter().enumerate();
        let Some((number, (_, drawing))) = numbered.find(|(_, (drawn, _))| *drawn == figure) else {
            return html! {};
        };
        let words = [self.title(figure), self.caption(figure)];
        frame::picture(Self::stem(figure), number, &drawing.svg, &words, beside)
    }

    /// Writes each figure that there is as SVG and PNG, and the page `index.html`, into the folder
    /// `within` the one that is being written. Returns the paths, the page first.
    fn write(&self, folder: &mut AtomicFolder, within: &Path) -> Result<Vec<PathBuf>, ReportError> {
        let drawn = self.drawn();
        let mut names = vec![within.join("index.html")];
        for (figure, Drawing { svg, .. }) in &drawn {
            let stem = Self::stem(*figure);
            let [svg_name, png_name] =
                ["svg", "png"].map(|extension| within.join(format!("{stem}.{extension}")));
            write_file(folder, &svg_name, svg.as_bytes())?;
            let pixels = png::of_svg(svg).map_err(|reason| ReportError::Raster {
                path: folder.path().join(&png_name),
                reason,
            })?;
            write_file(folder, &png_name, &pixels)?;
            names.extend([svg_name, png_name]);
        }
        write_file(folder, &names[0], self.whole_page(&drawn).as_bytes())?;
        Ok(names.iter().map(|name| folder.path().join(name)).collect())
    }

    /// Each figure that there is.
    fn drawn(&self) -> Vec<(Self::Figure, Drawing)> {
        // Names come from anywhere; XML allows no control characters.
        let drawing = |figure| {
            let mut drawing = self.draw(figure)?;
            drawing.svg = printable(&drawing.svg).into_owned();
            Some((figure, drawing))
        };
        Self::ALL
            .iter()
            .filter_map(|&figure| drawing(figure))
            .collect()
    }

    /// The page around the figures in `drawn`, as it is written.
    fn whole_page(&self, drawn: &[(Self::Figure, Drawing)]) -> String {
        printable(&self.page(drawn)).into_owned()
    }
}

/// Makes the folder `dir`, lets `write` fill it, and puts it into place whole.
pub(crate) fn write_folder<'t>(
    dir: impl Into<Destination<'t>>,
    write: impl FnOnce(&mut AtomicFolder, &Path) -> Result<Vec<PathBuf>, ReportError>,
) -> Result<Vec<PathBuf>, ReportError> {
    let mut folder = AtomicFolder::create(dir, None)?;
    let paths = write(&mut folder, Path::new(""))?;
    folder.commit()?;
    Ok(paths)
}

fn write_file(folder: &mut AtomicFolder, name: &Path, content: &[u8]) -> Result<(), ReportError> {
    Ok(folder.file(name, |path| {
        AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(content)
    })?)
}
