//! Shows a film that still grows, to browsers on this machine only.
//!
//! Two answers are all there is: the page, and the bytes of the film from an offset. A request must name this machine
//! as its host, so that a page from elsewhere cannot read a film through a name that it controls.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::page::live_page;

/// Bytes of a request that are read; ours are much shorter.
const REQUEST_MAX: u64 = 16 * 1024;
/// Bytes of a film in one answer.
const PIECE: u64 = 8 * 1024 * 1024;
/// How long a browser may take over its request and over our answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// A server for one film.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    film: PathBuf,
}

impl Server {
    /// Listens on this machine at a port, or at one that is free for port 0. The film may come later.
    ///
    /// # Errors
    /// When the system refuses it, as for a port that is in use.
    pub fn open(film: &Path, port: u16) -> io::Result<Self> {
        Ok(Self { listener: TcpListener::bind((Ipv4Addr::LOCALHOST, port))?, film: film.to_owned() })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// When the system refuses it.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Answers requests without end; a browser that goes away in the middle is no error.
    ///
    /// # Errors
    /// When no further browser can connect.
    pub fn run(&self) -> io::Result<()> {
        loop {
            let (stream, _) = self.listener.accept()?;
            let _ = self.answer(stream);
        }
    }

    fn answer(&self, mut stream: TcpStream) -> io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let Some(request) = Request::read(&stream)? else { return refuse(&mut stream, "400 Bad Request") };
        let port = self.address()?.port();
        if ![format!("127.0.0.1:{port}"), format!("localhost:{port}")].contains(&request.host) {
            return refuse(&mut stream, "403 Forbidden");
        }
        match request.path.split_once("?from=") {
            None if request.path == "/" => send(&mut stream, "text/html; charset=utf-8", live_page().as_bytes()),
            Some(("/film", from)) => match from.parse() {
                Ok(from) => match self.film_from(from)? {
                    Some(bytes) => send(&mut stream, "application/octet-stream", &bytes),
                    None => refuse(&mut stream, "416 Range Not Satisfiable"),
                },
                Err(_) => refuse(&mut stream, "400 Bad Request"),
            },
            _ => refuse(&mut stream, "404 Not Found"),
        }
    }

    /// A piece of the film; none behind its end, when a run has begun it again.
    fn film_from(&self, from: u64) -> io::Result<Option<Vec<u8>>> {
        let mut bytes = Vec::new();
        let mut film = match File::open(&self.film) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok((from == 0).then_some(bytes)),
            opened => opened?,
        };
        if film.metadata()?.len() < from {
            return Ok(None);
        }
        film.seek(SeekFrom::Start(from))?;
        film.take(PIECE).read_to_end(&mut bytes)?;
        Ok(Some(bytes))
    }
}

/// Request of a browser.
struct Request {
    path: String,
    host: String,
}

impl Request {
    /// Reads a GET request; none when it is another or too long.
    fn read(stream: &TcpStream) -> io::Result<Option<Self>> {
        let mut lines = BufReader::new(stream.take(REQUEST_MAX)).lines();
        let first = lines.next().transpose()?.unwrap_or_default();
        let path = first.strip_prefix("GET ").and_then(|rest| rest.split(' ').next()).map(str::to_owned);
        let mut host = String::new();
        for line in lines {
            let line = line?;
            if line.is_empty() {
                return Ok(path.map(|path| Self { path, host }));
            }
            if let Some((_, value)) = line.split_once(':').filter(|(name, _)| name.eq_ignore_ascii_case("host")) {
                value.trim().clone_into(&mut host);
            }
        }
        Ok(None)
    }
}

fn send(stream: &mut TcpStream, kind: &str, body: &[u8]) -> io::Result<()> {
    let length = body.len();
    write!(stream, "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n")?;
    write!(stream, "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n")?;
    stream.write_all(body)
}

fn refuse(stream: &mut TcpStream, status: &str) -> io::Result<()> {
    write!(stream, "HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
}
