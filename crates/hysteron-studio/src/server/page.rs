//! The page: files that are part of the program.

use axum::extract::Path;
use axum::http::header::CONTENT_TYPE;
use axum::response::{Html, IntoResponse, Response};
use std::sync::LazyLock;

const SCRIPT: &str = "text/javascript; charset=utf-8";

const FILES: [(&str, &str, &str); 16] = [
    (
        "style.css",
        "text/css; charset=utf-8",
        include_str!("../../page/style.css"),
    ),
    (
        "icon.svg",
        "image/svg+xml",
        include_str!("../../page/icon.svg"),
    ),
    ("main.js", SCRIPT, include_str!("../../page/main.js")),
    ("api.js", SCRIPT, include_str!("../../page/api.js")),
    ("dom.js", SCRIPT, include_str!("../../page/dom.js")),
    ("open.js", SCRIPT, include_str!("../../page/open.js")),
    ("fit.js", SCRIPT, include_str!("../../page/fit.js")),
    ("look.js", SCRIPT, include_str!("../../page/look.js")),
    ("play.js", SCRIPT, include_str!("../../page/play.js")),
    ("plane.js", SCRIPT, include_str!("../../page/plane.js")),
    ("drive.js", SCRIPT, include_str!("../../page/drive.js")),
    ("design.js", SCRIPT, include_str!("../../page/design.js")),
    ("prepare.js", SCRIPT, include_str!("../../page/prepare.js")),
    ("hand.js", SCRIPT, include_str!("../../page/hand.js")),
    ("home.js", SCRIPT, include_str!("../../page/home.js")),
    ("plot.js", SCRIPT, include_str!("../../page/plot.js")),
];

/// plotly.js, which the crate `plotly` carries. It gives its scripts as elements of a page, this one
/// first.
static PLOTLY: LazyLock<String> = LazyLock::new(|| {
    const ELEMENT: &str = "<script type=\"text/javascript\">";
    let all = plotly::Plot::offline_js_sources();
    let rest = all.strip_prefix(ELEMENT).unwrap_or_default();
    // A later element begins where the last of these marks is.
    let first = rest
        .rsplit_once(ELEMENT)
        .map_or(rest, |(first, _)| first)
        .trim_end();
    first.strip_suffix("</script>").unwrap_or(first).to_owned()
});

pub(super) async fn index() -> Html<&'static str> {
    Html(include_str!("../../page/index.html"))
}

pub(super) async fn file(Path((_, file)): Path<(String, String)>) -> Response {
    if file == "plotly.js" {
        return ([(CONTENT_TYPE, SCRIPT)], PLOTLY.as_str()).into_response();
    }
    match FILES.iter().find(|(name, ..)| *name == file) {
        Some((_, media, text)) => ([(CONTENT_TYPE, *media)], *text).into_response(),
        None => super::guard::nothing().await,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn plotly_is_one_script() {
        let script = super::PLOTLY.as_str();
        assert!(script.starts_with("/**") && script.contains("plotly.js v"));
        assert!(
            !script.contains("<script type=\"text/javascript\">")
                && !script.contains("MathJax-script")
        );
        assert!(script.len() > 3_000_000, "{}", script.len());
    }
}
