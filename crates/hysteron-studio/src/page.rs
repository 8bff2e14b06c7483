//! The page: files that are part of the program, for the server and for a folder that any server
//! can give.

use std::borrow::Cow;
use std::sync::LazyLock;

/// A file of the page.
#[derive(Debug, Clone)]
pub struct PageFile {
    /// Its name; the page itself is `index.html`.
    pub name: &'static str,
    /// Its media type.
    pub media: &'static str,
    /// What is in it.
    pub text: Cow<'static, str>,
}

const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Files by name and media type, read from the folder of the page.
macro_rules! files {
    ($($name:literal as $media:expr),* $(,)?) => {
        &[$(($name, $media, include_str!(concat!("../page/", $name)))),*]
    };
}

type File = (&'static str, &'static str, &'static str);

/// What both have.
const SHARED: &[File] = files![
    "style.css" as "text/css; charset=utf-8",
    "icon.svg" as "image/svg+xml",
    "main.js" as SCRIPT,
    "api.js" as SCRIPT,
    "dom.js" as SCRIPT,
    "open.js" as SCRIPT,
    "task.js" as SCRIPT,
    "split.js" as SCRIPT,
    "layers.js" as SCRIPT,
    "zip.js" as SCRIPT,
    "fit.js" as SCRIPT,
    "look.js" as SCRIPT,
    "play.js" as SCRIPT,
    "plane.js" as SCRIPT,
    "drive.js" as SCRIPT,
    "design.js" as SCRIPT,
    "prepare.js" as SCRIPT,
    "hand.js" as SCRIPT,
    "path.js" as SCRIPT,
    "alike.js" as SCRIPT,
    "home.js" as SCRIPT,
    "plot.js" as SCRIPT,
    "theme.js" as SCRIPT,
];

/// The way to a session in the command.
#[cfg(feature = "server")]
const SERVED: &[File] = files!["http.js" as SCRIPT];

/// The way to a session in a worker of the browser.
const STATIC: &[File] = files![
    "local.js" as SCRIPT,
    "worker.js" as SCRIPT,
    "kept.js" as SCRIPT,
    "fitter.js" as SCRIPT,
    "wasm.js" as SCRIPT,
];

const INDEX: &str = include_str!("../page/index.html");

/// The session as WebAssembly, beside the static page.
pub const STATIC_SESSION: &str = "hysteron.wasm";

/// Nothing but what the page's own folder has, and nothing sent elsewhere. Plotly writes its style
/// into the page, so that styles are allowed there.
macro_rules! policy {
    ($scripts:literal) => {
        concat!(
            "default-src 'none'; script-src 'self'",
            $scripts,
            "; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; \
             base-uri 'none'; form-action 'none'"
        )
    };
}

/// The policy of a page of the server, which sends it. The last part is of no use inside a page.
#[cfg(feature = "server")]
pub(crate) const POLICY: &str = concat!(policy!(""), "; frame-ancestors 'none'");

/// What makes a static page of the page: its policy, and the name of the way to its session.
const HEAD: &str = concat!(
    "<meta charset=\"utf-8\">\n<meta http-equiv=\"content-security-policy\" content=\"",
    policy!(" 'wasm-unsafe-eval'; worker-src 'self'"),
    "\">\n<meta name=\"hysteron-session\" content=\"local\">"
);

/// plotly.js, unpacked once.
static PLOTLY: LazyLock<String> = LazyLock::new(hysteron_report::plotly);

fn plotly() -> PageFile {
    PageFile {
        name: "plotly.js",
        media: SCRIPT,
        text: PLOTLY.as_str().into(),
    }
}

fn page((name, media, text): &File) -> PageFile {
    let text = Cow::Borrowed(*text);
    PageFile { name, media, text }
}

/// The page of the server.
#[cfg(feature = "server")]
pub(crate) fn index() -> &'static str {
    INDEX
}

/// A file beside the page of the server.
#[cfg(feature = "server")]
pub(crate) fn served(file: &str) -> Option<PageFile> {
    if file == "plotly.js" {
        return Some(plotly());
    }
    let mut files = SHARED.iter().chain(SERVED);
    files.find(|(name, ..)| *name == file).map(page)
}

/// The files of a page that needs no server of ours: any that gives files will do. The session,
/// [`STATIC_SESSION`], has to stand beside them; `tools/static-studio` builds it.
///
/// ```
/// let files: Vec<_> = hysteron_studio::static_page().collect();
/// let index = files.iter().find(|file| file.name == "index.html").unwrap();
/// assert!(index.text.contains("content-security-policy"));
/// assert!(files.iter().any(|file| file.name == "worker.js"));
/// ```
pub fn static_page() -> impl Iterator<Item = PageFile> {
    let index = PageFile {
        name: "index.html",
        media: "text/html; charset=utf-8",
        text: INDEX.replacen("<meta charset=\"utf-8\">", HEAD, 1).into(),
    };
    let files = SHARED.iter().chain(STATIC).map(page);
    [index, plotly()].into_iter().chain(files)
}
