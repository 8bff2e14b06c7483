//! Connections: few, and none that only waits.
//!
//! A connection counts as known when it has brought the secret. Of the others the oldest one gives
//! way, so that nobody can keep the owner out by connecting.

use axum::Router;
use axum::extract::Request;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::task::JoinHandle;

/// The most connections that have not brought the secret, and the most that have.
const STRANGERS: usize = 64;
const KNOWN: usize = 256;

/// How long the head of a request may take, and each part of a body.
const HEAD: Duration = Duration::from_secs(20);
pub(super) const PART: Duration = Duration::from_secs(30);

/// Whether a connection has brought the secret.
#[derive(Debug, Clone, Default)]
pub(super) struct Known(Arc<AtomicBool>);

impl Known {
    pub(super) fn note(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

type Open = VecDeque<(Known, JoinHandle<()>)>;

/// Ends the oldest of these connections, if they are too many.
fn limit(open: &mut Open, known: bool, most: usize) {
    let these = open.iter().filter(|(which, _)| which.is_set() == known);
    if these.count() > most {
        let oldest = open.iter().position(|(which, _)| which.is_set() == known);
        if let Some((_, task)) = oldest.and_then(|at| open.remove(at)) {
            task.abort();
        }
    }
}

/// Serves until it is dropped.
///
/// # Errors
/// Where the system takes the port away.
pub(super) async fn serve(listener: TcpListener, app: Router) -> std::io::Result<()> {
    let mut open = Open::new();
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            // A connection that is gone already, or too many open files for now.
            Err(_) => {
                open.retain(|(_, task)| !task.is_finished());
                limit(&mut open, false, 0);
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        let known = Known::default();
        let (app, of_calls) = (app.clone(), known.clone());
        let service = tower::service_fn(move |mut request: Request<hyper::body::Incoming>| {
            request.extensions_mut().insert(of_calls.clone());
            tower::ServiceExt::oneshot(app.clone(), request)
        });
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEAD)
            .serve_connection(TokioIo::new(stream), TowerToHyperService::new(service));
        let task = tokio::spawn(async move {
            // Nobody is left to be told.
            let _ = connection.await;
        });
        open.retain(|(_, task)| !task.is_finished());
        open.push_back((known, task));
        limit(&mut open, false, STRANGERS);
        limit(&mut open, true, KNOWN);
    }
}
