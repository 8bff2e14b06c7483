//! The figures of a report, drawn, and the page around them: one HTML file with everything in it.

use crate::figure::{Drawn, Figure};
use crate::linked;
use crate::made::Made;
use crate::subject::{Section, Subject};
use hysteron_files::printable;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("page.css");
/// Nothing from elsewhere, and nothing sent there.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data: blob:; base-uri 'none'; form-action 'none'";

/// What a report shows, laid out.
pub(crate) struct Layout {
    /// Of all figures that there can be.
    pub(crate) stems: Vec<&'static str>,
    /// Those that there are.
    pub(crate) drawn: Vec<Drawn>,
    simulated: Option<&'static str>,
    lead: Markup,
    body: Markup,
}

impl Layout {
    /// Draws those figures of `view` whose stems are wanted.
    pub(crate) fn new<V: Subject>(view: &V, is_wanted: impl Fn(&str) -> bool) -> Self {
        let (sections, simulated) = (V::sections(), view.simulated());
        let figures = || sections.iter().flat_map(Section::figures);
        let wanted = figures().filter(|figure| is_wanted(figure.stem));
        let drawn: Vec<Drawn> = wanted
            .filter_map(|figure| {
                figure.drawn(view, view.begins(), simulated.map(|words| words.caption))
            })
            .collect();
        Self {
            stems: figures().map(|figure| figure.stem).collect(),
            simulated: simulated.map(|words| words.page),
            lead: view.lead(),
            body: html! {
                (view.above())
                @for part in &sections { (section(part, view, &drawn)) }
                (view.below())
            },
            drawn,
        }
    }

    /// The page under `heading`.
    pub(crate) fn html(&self, heading: &str, made: Made<'_>) -> String {
        let heading = match heading.trim() {
            "" => "Report",
            _ => heading,
        };
        let linked = self.drawn.iter().filter(|figure| figure.is_linked);
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="content-security-policy" content=(POLICY);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (heading) @if self.simulated.is_some() { " (simulated)" } }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    main {
                        h1 { (heading) }
                        p.lead { (self.lead) }
                        @if let Some(simulated) = self.simulated { p.simulated { (simulated) } }
                        (self.body)
                        footer { (made.html()) }
                    }
                    (linked::scripts(linked.map(|figure| (figure.stem, &figure.drawing))))
                }
            }
        };
        printable(&page.into_string()).into_owned()
    }
}

fn section<V>(section: &Section<V>, view: &V, drawn: &[Drawn]) -> Markup {
    let found = |figure: &Figure<V>| drawn.iter().find(|drawn| drawn.stem == figure.stem);
    let picture = |figure| html! { @if let Some(drawn) = found(figure) { (self::picture(drawn)) } };
    let [above, below] = (section.notes)(view);
    let is_empty = above.0.is_empty()
        && below.0.is_empty()
        && section.figures().all(|figure| found(figure).is_none());
    let content = html! {
        (above)
        @for row in &section.rows {
            @if let [figure] = row.as_slice() { (picture(figure)) }
            @else { div.pair { @for figure in row { (picture(figure)) } } }
        }
        (below)
    };
    html! {
        @if section.name.is_empty() { (content) }
        @else if !is_empty { section { h2 { (section.name) } (content) } }
    }
}

/// A figure, with the name of its file: it has no other number on the page. Its width is in pixels:
/// all figures of a page have one scale, and so one size of text.
fn picture(figure: &Drawn) -> Markup {
    html! {
        figure id=(figure.stem) style={"--width:" (figure.width)} {
            div.wide { (PreEscaped(&figure.drawing.svg)) }
            figcaption {
                b { (figure.title) "." } " " (figure.caption)
                " " span.beside {
                    (figure.stem)
                    @if let Some(number) = figure.chapter { ", beside Fig. " (number) " of the chapter" }
                    "."
                }
            }
        }
    }
}
