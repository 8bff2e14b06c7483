//! The calls of the page.

use super::connections::PART;
use super::guard::Guard;
use super::shared::Shared;
use crate::page;
use crate::{Fault, Request, Response as Found, Told};
use axum::Json;
use axum::body::Body;
use axum::extract::{Path, Query, State};
use axum::http::header::{self, CONTENT_TYPE};
use axum::http::{HeaderMap, StatusCode};
use axum::response::sse::{Event, Sse};
use axum::response::{Html, IntoResponse, Redirect, Response};
use hysteron::Growing;
use std::collections::HashMap;
use std::convert::Infallible;
use std::io::Write;
use std::sync::{Arc, PoisonError};
use std::time::Duration;
use tokio_stream::wrappers::IntervalStream;
use tokio_stream::{Stream, StreamExt};

pub(super) type Parts = (Arc<Guard>, Arc<Shared>);

/// The address that the command printed leads to the page.
pub(super) async fn enter(
    State((guard, _)): State<Parts>,
    Query(query): Query<HashMap<String, String>>,
) -> Response {
    match query.get("token") {
        Some(token) if guard.knows(token) => Redirect::to(&format!("/{token}/")).into_response(),
        _ => {
            let why = "the address has no valid token: use the one that the command printed";
            (StatusCode::FORBIDDEN, why).into_response()
        }
    }
}

pub(super) async fn nothing() -> Response {
    (StatusCode::NOT_FOUND, "there is nothing here").into_response()
}

pub(super) async fn index() -> Html<&'static str> {
    Html(page::index())
}

/// A file of the page.
pub(super) async fn file(Path((_, name)): Path<(String, String)>) -> Response {
    match page::served(&name) {
        Some(file) => ([(CONTENT_TYPE, file.media)], file.text).into_response(),
        None => nothing().await,
    }
}

/// A request to the session, and its response or fault, as JSON.
pub(super) async fn session(State((_, shared)): State<Parts>, body: Body) -> Response {
    /// The longest request.
    const MOST: usize = 2 << 20;
    let body = tokio::time::timeout(PART, axum::body::to_bytes(body, MOST)).await;
    let request = match body {
        Ok(Ok(body)) => serde_json::from_slice::<Request>(&body),
        Ok(Err(_)) | Err(_) => return refused(&Fault::defect("a request was cut off")),
    };
    let Ok(request) = request else {
        return refused(&Fault::defect(
            "the page asked for what the session does not know",
        ));
    };
    let changes = request.changes();
    let done = tokio::task::spawn_blocking(move || {
        let mut answer = shared.session().handle(request)?;
        if let Some(job) = answer.job.take() {
            let shared = shared.clone();
            std::thread::spawn(move || {
                let turn = shared.turn.lock().unwrap_or_else(PoisonError::into_inner);
                let finished = job.run();
                drop(turn);
                let found = shared.session().finish(finished);
                *shared.failed.lock().unwrap_or_else(PoisonError::into_inner) = found.err();
                shared.changed();
            });
        }
        if changes {
            shared.changed();
        }
        Ok(answer.response)
    });
    answered(done.await)
}

/// The bytes of a file that was dropped on the page.
pub(super) async fn open(
    State((_, shared)): State<Parts>,
    Path((_, name)): Path<(String, String)>,
    headers: HeaderMap,
    body: Body,
) -> Response {
    let length = headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    let mut upload = shared.session().upload();
    let lacks = || Fault::too_large("the file", shared.session().room());
    let announced = usize::try_from(length.unwrap_or(0)).unwrap_or(usize::MAX);
    if upload.reserve(announced).is_err() {
        return refused(&lacks());
    }
    let mut parts = body.into_data_stream();
    while let Ok(part) = tokio::time::timeout(PART, parts.next()).await {
        match part {
            None => return opened(shared.clone(), name, upload).await,
            Some(Err(_)) => break,
            Some(Ok(part)) if upload.write_all(&part).is_err() => return refused(&lacks()),
            Some(Ok(_)) => {}
        }
    }
    refused(&Fault::missing("the file was cut off", "drop it again"))
}

async fn opened(shared: Arc<Shared>, name: String, upload: Growing) -> Response {
    let done = tokio::task::spawn_blocking(move || {
        let mut session = shared.session();
        session.open_upload(&name, upload)?;
        let response = session.handle(Request::Overview)?.response;
        drop(session);
        shared.changed();
        Ok(response)
    });
    answered(done.await)
}

/// Reads the files again that were named on the command line.
pub(super) async fn reload(State((_, shared)): State<Parts>) -> Response {
    let done = tokio::task::spawn_blocking(move || {
        let named = shared.named.lock().unwrap_or_else(PoisonError::into_inner);
        for path in named.iter() {
            shared.open_named(path)?;
        }
        shared.changed();
        Ok(shared.session().handle(Request::Overview)?.response)
    });
    answered(done.await)
}

/// Progress and changes as server-sent events.
pub(super) async fn events(
    State((_, shared)): State<Parts>,
) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    const EVERY: Duration = Duration::from_millis(150);
    let mut last = String::new();
    let ticks = IntervalStream::new(tokio::time::interval(EVERY));
    let events = ticks.filter_map(move |_| {
        let state = Told {
            changes: *shared.changes.borrow(),
            // While a call holds the session, there is nothing new.
            jobs: shared.session.try_lock().ok()?.jobs(),
            failed: shared
                .failed
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clone(),
            named: shared
                .named
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .len(),
        };
        let state = serde_json::to_string(&state).ok()?;
        (state != last).then(|| {
            last.clone_from(&state);
            Ok(Event::default().data(state))
        })
    });
    Sse::new(events).keep_alive(axum::response::sse::KeepAlive::default())
}

fn answered(done: Result<Result<Found, Fault>, tokio::task::JoinError>) -> Response {
    match done {
        Ok(Ok(found)) => Json(found).into_response(),
        Ok(Err(fault)) => refused(&fault),
        Err(_) => refused(&Fault::defect("a call ended in a panic")),
    }
}

fn refused(fault: &Fault) -> Response {
    let status = match fault.code {
        100 => StatusCode::NOT_FOUND,
        101 => StatusCode::PAYLOAD_TOO_LARGE,
        104 => StatusCode::INTERNAL_SERVER_ERROR,
        _ => StatusCode::UNPROCESSABLE_ENTITY,
    };
    (status, Json(fault)).into_response()
}
