//! The session over HTTP: a page, its calls, and the progress of the work as events.
//!
//! Only this machine and only this user: bound to 127.0.0.1, with a secret in every address.
//! `guard` checks each call, `calls` answers. `connections` bounds how many there are, `kept` is the
//! file of the session.

mod calls;
mod connections;
mod guard;
mod kept;
mod shared;

use crate::{Fault, Session};
use axum::Router;
use axum::routing::{get, post};
use guard::Guard;
use kept::Kept;
use shared::Shared;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::net::TcpListener;
use tokio::sync::watch;

/// A studio on this machine, before it runs.
#[derive(Debug)]
pub struct Server {
    listener: std::net::TcpListener,
    token: String,
    shared: Arc<Shared>,
    kept: Option<Kept>,
}

impl Server {
    /// Binds 127.0.0.1 at `port`; 0 takes a free one. The files take at most `budget` bytes of
    /// memory.
    ///
    /// # Errors
    /// Where the port is taken, or the system gives no random numbers.
    pub fn bind(port: u16, budget: u64) -> std::io::Result<Self> {
        let listener = std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let mut secret = [0; 24];
        getrandom::fill(&mut secret).map_err(std::io::Error::other)?;
        let token = secret.iter().map(|byte| format!("{byte:02x}")).collect();
        let shared = Arc::new(Shared {
            session: Mutex::new(Session::new(budget)),
            named: Mutex::new(Vec::new()),
            failed: Mutex::new(None),
            turn: Mutex::new(()),
            changes: watch::Sender::new(0),
        });
        Ok(Self {
            listener,
            token,
            shared,
            kept: None,
        })
    }

    /// Opens a file of the disk. The page can have it read again, and no other.
    ///
    /// # Errors
    /// [`Fault`] for a file that cannot be read.
    pub fn open(&self, path: &Path) -> Result<(), Fault> {
        self.shared.open_named(path)?;
        let mut named = self
            .shared
            .named
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        named.push(path.to_owned());
        Ok(())
    }

    /// Keeps the session in a file: opens it if it is there, and writes it at once, soon after each
    /// change and at the end. A studio that was killed goes on from there. A lock beside the file
    /// holds it for this studio.
    ///
    /// # Errors
    /// [`Fault`] for a file that is there and is no session, that cannot be written, or that another
    /// studio holds.
    pub fn keep(&mut self, path: &Path) -> Result<(), Fault> {
        self.kept = Some(Kept::open(path, &mut self.shared.session())?);
        Ok(())
    }

    /// The address for the user, with the secret.
    ///
    /// # Errors
    /// Where the system does not tell the port.
    pub fn address(&self) -> std::io::Result<String> {
        let port = self.listener.local_addr()?.port();
        Ok(format!("http://127.0.0.1:{port}/?token={}", self.token))
    }

    /// Serves until `stop` says so. Work under way is then cancelled.
    ///
    /// # Errors
    /// Where the system takes the port away, or the session could not be saved at the end.
    pub fn run(self, stop: std::sync::mpsc::Receiver<()>) -> std::io::Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()?;
        let shared = self.shared.clone();
        let (end, mut ended) = watch::channel(false);
        std::thread::spawn(move || {
            // A sender that is gone ends the studio too.
            let _ = stop.recv();
            let _ = end.send(true);
        });
        let kept = self.kept.map(|kept| Arc::new(Mutex::new(kept)));
        if let Some(kept) = &kept {
            // With the files that were opened before it serves.
            let saved = shared.save(&mut kept.lock().unwrap_or_else(PoisonError::into_inner));
            saved.map_err(std::io::Error::other)?;
            runtime.spawn(keep(shared.clone(), kept.clone()));
        }
        let served = runtime.block_on(async move {
            let address: SocketAddr = self.listener.local_addr()?;
            let guard = Guard::new(address.port(), self.token);
            let app = app(guard, self.shared);
            let listener = TcpListener::from_std(self.listener)?;
            tokio::select! {
                served = connections::serve(listener, app) => served,
                _ = ended.wait_for(|ended| *ended) => Ok(()),
            }
        });
        shared.session().cancel_all();
        let saved = kept.map_or(Ok(()), |kept| {
            shared.save(&mut kept.lock().unwrap_or_else(PoisonError::into_inner))
        });
        // Events are open as long as a page is.
        runtime.shutdown_background();
        served?;
        saved.map_err(std::io::Error::other)
    }
}

/// Writes the session after its changes.
async fn keep(shared: Arc<Shared>, kept: Arc<Mutex<Kept>>) {
    let mut changes = shared.changes.subscribe();
    while changes.changed().await.is_ok() {
        // Changes come in groups.
        tokio::time::sleep(std::time::Duration::from_millis(300)).await;
        changes.mark_unchanged();
        let (shared, kept) = (shared.clone(), kept.clone());
        let saved = tokio::task::spawn_blocking(move || {
            // The page and the end of the studio tell what is wrong.
            let _ = shared.save(&mut kept.lock().unwrap_or_else(PoisonError::into_inner));
        });
        let _ = saved.await;
    }
}

fn app(guard: Guard, shared: Arc<Shared>) -> Router {
    let guard = Arc::new(guard);
    Router::new()
        .route("/", get(calls::enter))
        .route("/{token}/", get(calls::index))
        .route("/{token}/{file}", get(calls::file))
        .route("/{token}/api/session", post(calls::session))
        .route("/{token}/api/open/{name}", post(calls::open))
        .route("/{token}/api/reload", post(calls::reload))
        .route("/{token}/api/events", get(calls::events))
        .fallback(calls::nothing)
        .layer(axum::middleware::from_fn_with_state(
            guard.clone(),
            guard::check,
        ))
        .with_state((guard, shared))
}
