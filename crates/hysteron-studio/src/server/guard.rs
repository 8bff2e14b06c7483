//! Who may call: a page of this server, in a browser of the user who started it.
//!
//! - `Host` has to be this server's. So another name that leads to 127.0.0.1 (DNS rebinding) is of
//!   no use.
//! - `Origin`, and `Sec-Fetch-Site` where the browser sends it, have to be this page's.
//! - The first part of every path is the secret.

use super::connections::Known;
use crate::page::POLICY;
use axum::extract::{Request, State};
use axum::http::header::{self, HeaderMap, HeaderName, HeaderValue};
use axum::http::{Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

/// What a call has to bring.
#[derive(Debug)]
pub(super) struct Guard {
    hosts: [String; 2],
    token: String,
}

impl Guard {
    pub(super) fn new(port: u16, token: String) -> Self {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        Self { hosts, token }
    }

    /// Compares in a time that does not tell where a guess goes wrong.
    pub(super) fn knows(&self, token: &str) -> bool {
        let (ours, theirs) = (self.token.as_bytes(), token.as_bytes());
        let pairs = ours.iter().zip(theirs);
        ours.len() == theirs.len() && pairs.fold(0, |all, (a, b)| all | (a ^ b)) == 0
    }

    /// Why a call is refused.
    fn refusal(&self, request: &Request) -> Option<&'static str> {
        let headers = request.headers();
        let host = only(headers, &header::HOST);
        let Some(host) = host.filter(|host| self.hosts.iter().any(|ours| ours == host)) else {
            return Some("this is not the host of the studio");
        };
        let origin = headers.contains_key(header::ORIGIN);
        let ours = only(headers, &header::ORIGIN).is_some_and(|o| o == format!("http://{host}"));
        if (origin || request.method() != Method::GET) && !ours {
            return Some("another page may not call the studio");
        }
        let site = HeaderName::from_static("sec-fetch-site");
        let own = |site: &str| matches!(site, "same-origin" | "none");
        // The first call may come from a link in a terminal or a mail, or from the page on the disk
        // that leads here. The browser then shows this page alone, whoever asked for it.
        let path = request.uri().path();
        let entry = path == "/";
        let shown = only(headers, &HeaderName::from_static("sec-fetch-dest")) == Some("document");
        let page = request.method() == Method::GET && shown && path.matches('/').count() == 2;
        let open_to_all = entry || page && path.ends_with('/');
        let called_by = headers.contains_key(&site).then(|| only(headers, &site));
        if !open_to_all && called_by.is_some_and(|by| !by.is_some_and(own)) {
            return Some("another page may not call the studio");
        }
        let first = path.split('/').nth(1).unwrap_or_default();
        match entry || self.knows(first) {
            true => None,
            false => Some("the address has no valid token: use the one that the command printed"),
        }
    }
}

/// The value of a header that is there once.
fn only<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?;
    values.next().is_none().then(|| value.to_str().ok())?
}

/// Checks a call, and says to the browser what a page of ours may do.
pub(super) async fn check(
    State(guard): State<Arc<Guard>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match guard.refusal(&request) {
        Some(why) => (StatusCode::FORBIDDEN, why).into_response(),
        None => {
            let known = request.extensions().get::<Known>();
            let secret = request.uri().path() != "/";
            known.filter(|_| secret).map(Known::note);
            next.run(request).await
        }
    };
    let headers = response.headers_mut();
    let sent = [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
        (
            HeaderName::from_static("cross-origin-resource-policy"),
            "same-origin",
        ),
        (
            HeaderName::from_static("cross-origin-opener-policy"),
            "same-origin",
        ),
    ];
    for (name, value) in sent {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}
