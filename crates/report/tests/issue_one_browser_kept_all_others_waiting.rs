//! `enmm view` answered one browser after the other: an idle connection kept all others waiting, and a film that was a
//! pipe kept it for ever. It answered with any file of that name.

use std::fs;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use enmm_report::{FilmWriter, Server};
use tempfile::tempdir;

use crate::support::head;

/// Serves a film on a thread that ends with the test.
fn serve(film: &Path) -> SocketAddr {
    let server = Server::open(film, 0).expect("a port");
    let address = server.address().expect("an address");
    std::thread::spawn(move || server.run());
    address
}

/// First line of the answer to a request.
fn ask(address: SocketAddr, path: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("a connection");
    stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a limit");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n").expect("asked");
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("answered");
    String::from_utf8_lossy(&answer).lines().next().unwrap_or_default().to_owned()
}

#[test]
fn a_page_comes_while_others_are_idle_or_slow() {
    let folder = tempdir().expect("a folder");
    let address = serve(&folder.path().join("film.bin"));
    let others: Vec<_> = (0..20).map(|_| TcpStream::connect(address).expect("a connection")).collect();
    let mut slow = TcpStream::connect(address).expect("a connection");
    slow.write_all(b"GET").expect("sent");
    let start = Instant::now();
    assert_eq!(ask(address, "/"), "HTTP/1.1 200 OK");
    assert!(start.elapsed() < Duration::from_secs(4), "it waited for an idle one to be given up");
    drop(others);
}

#[test]
fn a_request_has_one_deadline_however_its_bytes_are_spread() {
    let folder = tempdir().expect("a folder");
    let address = serve(&folder.path().join("film.bin"));
    let mut drip = TcpStream::connect(address).expect("a connection");
    let start = Instant::now();
    while drip.write_all(b"G").is_ok() {
        assert!(start.elapsed() < Duration::from_secs(60), "a byte now and then keeps its turn");
        std::thread::sleep(Duration::from_millis(200));
    }
}

#[test]
fn only_a_film_is_served() {
    let folder = tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("secret"), "root:x:0:0\n").expect("written");
    fs::create_dir(path("folder")).expect("made");
    let served = |film: &str| ask(serve(&path(film)), "/film?from=0");
    assert_eq!(served("yet to come"), "HTTP/1.1 200 OK");
    assert_eq!(served("secret"), "HTTP/1.1 403 Forbidden");
    assert_eq!(served("folder"), "HTTP/1.1 403 Forbidden");
    if cfg!(unix) {
        assert!(Command::new("mkfifo").arg(path("pipe")).status().expect("mkfifo runs").success());
        assert_eq!(served("pipe"), "HTTP/1.1 403 Forbidden");
        assert_eq!(served("/dev/zero"), "HTTP/1.1 403 Forbidden");
    }
    let film = FilmWriter::create(&path("film.bin"), &head(), &[]);
    drop(film);
    assert_eq!(served("film.bin"), "HTTP/1.1 200 OK");
}
