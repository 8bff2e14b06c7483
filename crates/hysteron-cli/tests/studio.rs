//! `hysteron studio` as a process: its address, and its end.
#![allow(clippy::unwrap_used)]
#![cfg(all(unix, feature = "studio"))]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};

#[test]
fn it_prints_its_address_and_ends_cleanly() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run.csv"), "T,y\n1,2\n2,3\n1,1\n").unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["studio", "--no-open", "--port", "0", "run.csv"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let address = lines.next().unwrap().unwrap();
    let (host, token) = address
        .strip_prefix("http://127.0.0.1:")
        .and_then(|rest| rest.split_once("/?token="))
        .unwrap();
    let port: u16 = host.parse().unwrap();
    assert!(token.len() >= 32, "{token}");
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let body = "{\"request\":\"overview\"}";
    let own = format!("127.0.0.1:{port}");
    write!(
        stream,
        "POST /{token}/api/session HTTP/1.1\r\nHost: {own}\r\nOrigin: http://{own}\r\n\
         Content-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.contains("\"name\":\"run.csv\""), "{answer}");
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    assert!(child.wait().unwrap().success());
    assert!(TcpStream::connect(("127.0.0.1", port)).is_err());
}
