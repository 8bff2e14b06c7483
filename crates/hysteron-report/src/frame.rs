//! What every page has: one HTML file with everything in it.

use crate::made::Made;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("page.css");
/// Nothing from elsewhere, and nothing sent there.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data: blob:; base-uri 'none'; form-action 'none'";

/// The page of `body`; `simulated` says that nothing on it was measured. `scripts` stand at its
/// end.
pub(crate) fn html(
    heading: &str,
    lead: Markup,
    simulated: Option<&str>,
    body: Markup,
    made: Made<'_>,
    scripts: Markup,
) -> String {
    let heading = if heading.trim().is_empty() {
        "Report"
    } else {
        heading
    };
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="content-security-policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (heading) @if simulated.is_some() { " (simulated)" } }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    h1 { (heading) }
                    p.lead { (lead) }
                    @if let Some(simulated) = simulated { p.simulated { (simulated) } }
                    (body)
                    footer { (made.html()) }
                }
                (scripts)
            }
        }
    }
    .into_string()
}

/// The figure `number`, counted from 0, with its title and caption; `beside` ends the caption.
pub(crate) fn picture(
    id: &str,
    number: usize,
    svg: &str,
    [title, caption]: &[String; 2],
    beside: Markup,
) -> Markup {
    // Its width in pixels: all figures of a page have one scale, and so one size of text.
    let width = svg.split_once(" width=\"").map_or("", |(_, rest)| rest);
    let width = width.split_once('"').map_or("760", |(width, _)| width);
    html! {
        figure id=(id) style={"--width:" (width)} {
            div.wide { (PreEscaped(svg)) }
            figcaption { b { "Figure " (number + 1) ". " (title) "." } " " (caption) (beside) }
        }
    }
}
