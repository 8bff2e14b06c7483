//! A socket.

use super::wires::Wires;
use std::io::{self, Write};
use std::net::{Shutdown, TcpStream, ToSocketAddrs};
use std::sync::Arc;
use std::time::Duration;

/// Longest time to connect.
const PATIENCE: Duration = Duration::from_secs(5);

pub(super) fn open(address: &str) -> io::Result<Wires> {
    let mut fault = io::Error::new(io::ErrorKind::NotFound, "it has no address");
    for found in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&found, PATIENCE) {
            Ok(socket) => {
                // A drive must not wait for the next one.
                socket.set_nodelay(true)?;
                return Wires::new(socket.try_clone()?, Ending(socket), Arc::default());
            }
            Err(error) => fault = error,
        }
    }
    Err(fault)
}

/// The writing end of a socket. The reader has the socket too: with this end, both are closed.
struct Ending(TcpStream);

impl Write for Ending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Drop for Ending {
    fn drop(&mut self) {
        let _ = self.0.shutdown(Shutdown::Both);
    }
}
