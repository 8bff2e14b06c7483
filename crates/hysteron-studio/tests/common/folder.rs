//! The studio as a folder, and a small server that gives files and nothing else.
#![allow(clippy::unwrap_used)]

use crate::recordings::skip::skipped;
use hysteron_studio::{STATIC_SESSION, static_page};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, OnceLock};

/// The folder, built once; `None` where Rust cannot build for WebAssembly.
pub fn folder() -> Option<&'static Path> {
    static FOLDER: OnceLock<Option<PathBuf>> = OnceLock::new();
    FOLDER.get_or_init(build).as_deref()
}

fn build() -> Option<PathBuf> {
    let machine = [
        "--print",
        "target-libdir",
        "--target",
        "wasm32-unknown-unknown",
    ];
    let found = Command::new("rustc").args(machine).output().ok();
    let found = found.and_then(|found| String::from_utf8(found.stdout).ok());
    if !found.is_some_and(|path| Path::new(path.trim()).is_dir()) {
        assert!(
            std::env::var_os("HYSTERON_NO_SKIP").is_none(),
            "Rust for wasm32-unknown-unknown is missing"
        );
        skipped("Rust for wasm32-unknown-unknown is not there: rustup target add it");
        return None;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hysteron-studio-wasm/build");
    let built = Command::new(script).stderr(Stdio::inherit()).output();
    let built = built.unwrap();
    assert!(built.status.success(), "the session cannot be built");
    let session = String::from_utf8(built.stdout).unwrap();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("studio-page");
    std::fs::create_dir_all(&target).unwrap();
    for file in static_page() {
        std::fs::write(target.join(file.name), file.text.as_bytes()).unwrap();
    }
    std::fs::copy(session.trim(), target.join(STATIC_SESSION)).unwrap();
    Some(target)
}

/// A server of the files in a folder, as a plain host is: no header beyond the type.
pub struct Files {
    pub address: String,
    /// The first line of each request.
    asked: Arc<Mutex<Vec<String>>>,
    folder: &'static Path,
}

impl Files {
    pub fn start(folder: &'static Path) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let asked = Arc::new(Mutex::new(Vec::new()));
        let log = asked.clone();
        // It ends with the test.
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let log = log.clone();
                std::thread::spawn(move || answer(&stream, folder, &log));
            }
        });
        Self {
            address: format!("http://127.0.0.1:{port}/"),
            asked,
            folder,
        }
    }

    /// Files never leave the browser: all that was asked for are files of the folder, each by its
    /// name alone.
    pub fn end(self) {
        let asked = self.asked.lock().unwrap();
        assert!(asked.iter().any(|line| line.contains(STATIC_SESSION)));
        for line in asked.iter() {
            let name = line.strip_prefix("GET /");
            let name = name.and_then(|rest| rest.strip_suffix(" HTTP/1.1"));
            let there = name.is_some_and(|name| name.is_empty() || self.folder.join(name).exists());
            assert!(there, "the page asked for {line}");
        }
    }
}

/// Answers one request, which may have a body: that would be told by [`Files::end`].
fn answer(stream: &TcpStream, folder: &Path, log: &Mutex<Vec<String>>) {
    let mut lines = BufReader::new(stream.take(1 << 16)).lines();
    let mut lines = lines.by_ref().map_while(Result::ok);
    // A browser opens connections ahead, and may close them unused.
    let Some(first) = lines.next() else { return };
    let _ = lines.find(String::is_empty);
    let name = first.split(' ').nth(1).unwrap_or_default().to_owned();
    log.lock().unwrap().push(first);
    let name = match name.trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    let media = match name.rsplit('.').next() {
        Some("html") => "text/html",
        Some("css") => "text/css",
        Some("js") => "text/javascript",
        Some("svg") => "image/svg+xml",
        // Also of WebAssembly: not every host knows it.
        _ => "application/octet-stream",
    };
    let (status, body) = match std::fs::read(folder.join(name)) {
        Ok(body) => ("200 OK", body),
        Err(_) => ("404 Not Found", Vec::new()),
    };
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {media}\r\nContent-Length: {length}\r\n\
         Connection: close\r\n\r\n"
    );
    let mut stream = stream;
    let _ = stream.write_all(head.as_bytes());
    let _ = stream.write_all(&body);
}
