//! A studio that runs in this process, and plain HTTP.
#![allow(clippy::unwrap_used)]

use hysteron_studio::Server;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;

pub struct Studio {
    pub address: String,
    pub port: u16,
    pub token: String,
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<std::io::Result<()>>>,
}

impl Studio {
    pub fn start(budget: u64, files: &[&Path]) -> Self {
        Self::keeping(budget, files, None)
    }

    /// A studio that keeps its session in a file.
    pub fn keeping(budget: u64, files: &[&Path], kept: Option<&Path>) -> Self {
        let mut server = Server::bind(0, budget).unwrap();
        if let Some(kept) = kept {
            server.keep(kept).unwrap();
        }
        for file in files {
            server.open(file).unwrap();
        }
        let address = server.address().unwrap();
        let (stop, stopped) = channel();
        let thread = std::thread::spawn(move || server.run(stopped));
        let (host, token) = address.split_once("/?token=").unwrap();
        Self {
            port: host.rsplit_once(':').unwrap().1.parse().unwrap(),
            token: token.into(),
            address,
            stop: Some(stop),
            thread: Some(thread),
        }
    }

    /// Sends a call as it is written; returns status, headers and body.
    pub fn call(&self, head: &str, body: &[u8]) -> (u16, String, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        let head = head
            .replace("PORT", &self.port.to_string())
            .replace("TOKEN", &self.token);
        let length = match head.to_lowercase().contains("content-length") {
            true => String::new(),
            false => format!("Content-Length: {}\r\n", body.len()),
        };
        let text = format!(
            "{}\r\n{length}Connection: close\r\n\r\n",
            head.replace('\n', "\r\n")
        );
        stream.write_all(text.as_bytes()).unwrap();
        // A refused body may be cut off.
        let _ = stream.write_all(body);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head
            .split(' ')
            .nth(1)
            .and_then(|status| status.parse().ok());
        (status.unwrap_or(0), head.into(), body.into())
    }

    pub fn end(mut self) {
        self.stop.take().unwrap().send(()).unwrap();
        self.thread.take().unwrap().join().unwrap().unwrap();
        assert!(!self.answers().unwrap_or(false), "the port is still open");
    }

    /// Whether this very studio answers: its port may belong to another program by now.
    fn answers(&self) -> std::io::Result<bool> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port))?;
        stream.set_read_timeout(Some(std::time::Duration::from_secs(10)))?;
        let (token, port) = (&self.token, self.port);
        let call = format!("GET /{token}/ HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n");
        stream.write_all(call.as_bytes())?;
        let mut first = [0; 12];
        stream.read_exact(&mut first)?;
        Ok(first == *b"HTTP/1.1 200")
    }
}
