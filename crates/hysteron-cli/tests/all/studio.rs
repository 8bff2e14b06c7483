//! `hysteron studio` as a process: its address, its end, and what is there after it was killed.
#![cfg(all(unix, feature = "studio"))]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

struct Studio {
    process: Child,
    port: u16,
    token: String,
}

impl Studio {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_hysteron"))
            .args(["studio", "--no-open", "--port", "0"])
            .args(arguments)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
        let address = lines.next().unwrap().unwrap();
        let (port, token) = address
            .strip_prefix("http://127.0.0.1:")
            .and_then(|rest| rest.split_once("/?token="))
            .unwrap();
        Self {
            process,
            port: port.parse().unwrap(),
            token: token.into(),
        }
    }

    /// The answer to a request.
    fn ask(&self, body: &str) -> String {
        let Self { port, token, .. } = self;
        let mut stream = TcpStream::connect(("127.0.0.1", *port)).unwrap();
        let own = format!("127.0.0.1:{port}");
        write!(
            stream,
            "POST /{token}/api/session HTTP/1.1\r\nHost: {own}\r\nOrigin: http://{own}\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n\
             {body}",
            body.len()
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// SIGKILL, which no process can answer.
    fn kill(&mut self) {
        self.process.kill().unwrap();
        self.process.wait().unwrap();
    }

    fn overview(&self) -> String {
        let answer = self.ask("{\"request\":\"overview\"}");
        let (_, body) = answer.split_once("\r\n\r\n").unwrap();
        body.to_owned()
    }
}

fn with_recording() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run.csv"), "T,y\n1,2\n2,3\n1,1\n").unwrap();
    folder
}

#[test]
fn it_prints_its_address_and_ends_cleanly() {
    let folder = with_recording();
    let mut studio = Studio::start(folder.path(), &["run.csv"]);
    assert!(studio.token.len() >= 32, "{}", studio.token);
    let overview = studio.overview();
    assert!(overview.contains("\"name\":\"run.csv\""), "{overview}");
    let id = studio.process.id().to_string();
    let told = Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert!(told.success());
    assert!(studio.process.wait().unwrap().success());
    assert!(TcpStream::connect(("127.0.0.1", studio.port)).is_err());
}

/// Killed at any moment: the session file is whole, and at most what was done within the last
/// moment is lost.
#[test]
fn a_killed_studio_goes_on_from_its_session() {
    let folder = with_recording();
    let kept = folder.path().join("kept.json");
    // It is written soon after a change; a minute is for a machine with much other work.
    let until_saved = |text: &str| {
        let saved = || std::fs::read_to_string(&kept).unwrap_or_default();
        let there = (0..600).any(|_| {
            std::thread::sleep(Duration::from_millis(100));
            saved().contains(text)
        });
        assert!(there, "{}", saved());
    };
    let use_for = |studio: &Studio, what: &str| {
        studio.ask(&format!(
            "{{\"request\":\"use\",\"file\":1,\"purpose\":\"{what}\"}}"
        ));
    };
    let mut studio = Studio::start(
        folder.path(),
        &["--session", "kept.json", "--max-memory", "1G", "run.csv"],
    );
    use_for(&studio, "look");
    until_saved("\"look\"");
    // Killed at rest, and around the time at which it writes, 300 ms after a change.
    for wait in [0, 290, 300, 305, 310] {
        let before = studio.overview();
        studio.kill();
        studio = Studio::start(
            folder.path(),
            &["--session", "kept.json", "--max-memory", "1G"],
        );
        assert_eq!(studio.overview(), before);
        use_for(&studio, "look");
        std::thread::sleep(Duration::from_millis(wait));
    }
    studio.kill();
    // The next one to write in this folder removes what killed ones left.
    studio = Studio::start(
        folder.path(),
        &["--session", "kept.json", "--max-memory", "1G"],
    );
    use_for(&studio, "validate");
    until_saved("\"validate\"");
    studio.kill();
    let names = std::fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    // The lock file of one that was killed stays; it holds nobody out.
    assert_eq!(names, ["kept.json", "kept.json.lock", "run.csv"]);
}
