//! A socket.

use super::wires::Wires;
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
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
                return Wires::new(socket.try_clone()?, socket, Arc::default());
            }
            Err(error) => fault = error,
        }
    }
    Err(fault)
}
