//! Shows pages that still change, to browsers on this machine only.
//!
//! A source answers each path; that of a film has two: the page, and the bytes of the film from an offset. A request
//! must name this machine as its host, so that a page from elsewhere cannot read a film by a name that it controls.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use enmm_io::files::open_result;

use crate::chunk::MAGIC;
use crate::page::live_page;

/// Bytes of a request that are read; ours are much shorter.
const REQUEST_MAX: u64 = 16 * 1024;
/// Bytes of a film in one answer.
const PIECE: u64 = 8 * 1024 * 1024;
/// How long a browser may take over its whole request.
const ASKING: Duration = Duration::from_secs(5);
/// How long it may take over our whole answer.
const ANSWERING: Duration = Duration::from_secs(60);
/// Pause after a connection that could not be taken.
const PAUSE: Duration = Duration::from_millis(50);
/// Browsers that are answered side by side; others wait for their turn.
const CLIENTS_MAX: usize = 64;

/// Answers to the requests of browsers.
pub trait Source: Send + Sync {
    /// The answer to a path, such as `/`, with the number behind `?from=` if it has one.
    fn answer(&self, path: &str, from: Option<u64>) -> Answer;
}

/// An answer of a source.
pub enum Answer {
    /// A body of a type.
    Body {
        /// Its media type.
        kind: &'static str,
        /// Its length (bytes).
        length: u64,
        /// Its bytes.
        body: Box<dyn Read>,
    },
    /// A status without a body, such as `404 Not Found`.
    Status(&'static str),
}

impl Answer {
    /// Status of a path that a source does not have.
    pub const NOT_FOUND: Self = Self::Status("404 Not Found");

    /// An answer that is there as a whole.
    pub fn whole(kind: &'static str, bytes: impl AsRef<[u8]> + 'static) -> Self {
        let length = bytes.as_ref().len() as u64;
        Self::Body { kind, length, body: Box::new(Cursor::new(bytes)) }
    }
}

/// A server for one source.
pub struct Server {
    listener: TcpListener,
    source: Arc<dyn Source>,
}

impl Server {
    /// Listens on this machine at a port, or at one that is free for port 0. The film may come later.
    ///
    /// # Errors
    /// When the system refuses it, as for a port that is in use.
    pub fn open(film: &Path, port: u16) -> io::Result<Self> {
        Self::of(Arc::new(FilmSource { film: film.to_owned() }), port)
    }

    /// Listens on this machine at a port, or at one that is free for port 0, for a source.
    ///
    /// # Errors
    /// As [`Server::open`].
    pub fn of(source: Arc<dyn Source>, port: u16) -> io::Result<Self> {
        Ok(Self { listener: TcpListener::bind((Ipv4Addr::LOCALHOST, port))?, source })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// When the system refuses it.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Answers requests without end, side by side; a browser that goes away in the middle is no error.
    ///
    /// # Errors
    /// When no further browser can connect.
    pub fn run(&self) -> io::Result<()> {
        let turns = Turns::default();
        thread::scope(|scope| {
            loop {
                let turn = turns.take();
                let stream = match self.listener.accept() {
                    Ok((stream, _)) => stream,
                    Err(error) if passes(&error) => {
                        thread::sleep(PAUSE);
                        continue;
                    }
                    Err(error) => return Err(error),
                };
                let answer = move || {
                    let _turn = turn;
                    let _ = self.answer(&stream);
                };
                // A system without a thread to spare ends the connection.
                let _ = thread::Builder::new().spawn_scoped(scope, answer);
            }
        })
    }

    fn answer(&self, stream: &TcpStream) -> io::Result<()> {
        let request = Request::read(Timed { stream, until: Instant::now() + ASKING })?;
        let mut out = Timed { stream, until: Instant::now() + ANSWERING };
        let Some(request) = request else { return refuse(&mut out, "400 Bad Request") };
        let port = self.address()?.port();
        if ![format!("127.0.0.1:{port}"), format!("localhost:{port}")].contains(&request.host) {
            return refuse(&mut out, "403 Forbidden");
        }
        let (path, from) = match request.path.split_once("?from=") {
            None => (request.path.as_str(), None),
            Some((path, from)) => match from.parse() {
                Ok(from) => (path, Some(from)),
                Err(_) => return refuse(&mut out, "400 Bad Request"),
            },
        };
        match self.source.answer(path, from) {
            Answer::Body { kind, length, mut body } => send(&mut out, kind, length, &mut body),
            Answer::Status(status) => refuse(&mut out, status),
        }
    }
}

/// The page of a film, and its bytes.
struct FilmSource {
    film: PathBuf,
}

impl Source for FilmSource {
    fn answer(&self, path: &str, from: Option<u64>) -> Answer {
        match (path, from) {
            ("/", None) => Answer::whole("text/html; charset=utf-8", live_page()),
            ("/film", Some(from)) => match self.film_from(from) {
                Ok(piece) => {
                    Answer::Body { kind: "application/octet-stream", length: piece.length, body: piece.bytes() }
                }
                Err(status) => Answer::Status(status),
            },
            _ => Answer::NOT_FOUND,
        }
    }
}

impl FilmSource {
    /// A piece of the film, nothing of one that is yet to come.
    ///
    /// # Errors
    /// The status of the answer: the offset is behind the end, as when a run has begun the film again, or the file is
    /// no film.
    fn film_from(&self, from: u64) -> Result<Piece, &'static str> {
        const NO_FILM: &str = "403 Forbidden";
        const BEHIND: &str = "416 Range Not Satisfiable";
        let mut file = match open_result(&self.film) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return if from == 0 { Ok(Piece::default()) } else { Err(BEHIND) };
            }
            opened => opened.map_err(|_| NO_FILM)?,
        };
        let mut first = Vec::new();
        let read = (&file).take(MAGIC.len() as u64).read_to_end(&mut first);
        if read.is_err() || !MAGIC.starts_with(&first) {
            return Err(NO_FILM);
        }
        let left = file.metadata().ok().and_then(|found| found.len().checked_sub(from)).ok_or(BEHIND)?;
        file.seek(SeekFrom::Start(from)).map_err(|_| BEHIND)?;
        Ok(Piece { file: Some(file), length: left.min(PIECE) })
    }
}

/// Whether an error of a new connection goes by: its other end has gone, or the process has no file to spare (EMFILE,
/// ENFILE and WSAEMFILE).
fn passes(error: &io::Error) -> bool {
    let is_full = error.raw_os_error().is_some_and(|code| [23, 24, 10024].contains(&code));
    is_full || matches!(error.kind(), io::ErrorKind::ConnectionAborted | io::ErrorKind::Interrupted)
}

/// A piece of a film; nothing without a file.
#[derive(Default)]
struct Piece {
    file: Option<File>,
    length: u64,
}

impl Piece {
    fn bytes(self) -> Box<dyn Read> {
        self.file.map_or_else(|| Box::new(io::empty()) as Box<dyn Read>, |file| Box::new(file.take(self.length)))
    }
}

/// Turns of the browsers that are answered at a time.
#[derive(Default)]
struct Turns {
    taken: Mutex<usize>,
    freed: Condvar,
}

/// The turn of one browser, which is given back when this is dropped.
struct Turn<'a>(&'a Turns);

impl Turns {
    /// Waits until there is a turn, and takes it.
    fn take(&self) -> Turn<'_> {
        let taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let is_full = |taken: &mut usize| *taken >= CLIENTS_MAX;
        *self.freed.wait_while(taken, is_full).unwrap_or_else(PoisonError::into_inner) += 1;
        Turn(self)
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        *self.0.taken.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        self.0.freed.notify_one();
    }
}

/// A connection that fails when it takes longer than until a time, however its other end spreads the bytes.
struct Timed<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl Timed<'_> {
    fn left(&self) -> io::Result<Option<Duration>> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Request of a browser.
struct Request {
    path: String,
    host: String,
}

impl Request {
    /// Reads a GET request; none when it is another or too long.
    fn read(stream: Timed) -> io::Result<Option<Self>> {
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

fn send(out: &mut impl Write, kind: &str, length: u64, body: &mut dyn Read) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nContent-Security-Policy: frame-ancestors 'self'\r\n\
         Connection: close\r\n\r\n"
    );
    out.write_all(head.as_bytes())?;
    io::copy(body, out).map(drop)
}

fn refuse(out: &mut impl Write, status: &str) -> io::Result<()> {
    out.write_all(format!("HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n").as_bytes())
}
