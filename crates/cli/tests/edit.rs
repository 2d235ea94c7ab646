//! `enmm edit` shows the model at each save, keeps the last one after an error, and writes nothing beside the case.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::Child;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::{Place, case};

/// The program as it serves a case, ended with the test.
struct Editor {
    program: Child,
    address: String,
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

impl Editor {
    fn of(place: &Place) -> Self {
        let mut program = place.start(&["edit", "case.toml"]);
        let mut line = String::new();
        BufReader::new(program.stdout.as_mut().expect("output")).read_line(&mut line).expect("a line");
        let address = line.split('/').nth(2).unwrap_or_else(|| panic!("{line}")).to_owned();
        Self { program, address }
    }

    /// Status line and body of an answer.
    fn get(&self, path: &str, host: &str) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.address).expect("a connection");
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("asked");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("answered");
        let head = answer.windows(4).position(|part| part == b"\r\n\r\n").expect("a head");
        let status = String::from_utf8_lossy(&answer[..head]).lines().next().unwrap_or_default().to_owned();
        (status, answer[head + 4..].to_vec())
    }

    fn state(&self) -> Value {
        let (status, body) = self.get("/state?from=0", &self.address);
        assert_eq!(status, "HTTP/1.1 200 OK");
        serde_json::from_slice(&body).expect("JSON")
    }

    /// The state once it is as wanted.
    fn wait(&self, wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let state = self.state();
            if wanted(&state) {
                return state;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "{state}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

fn fact<'a>(state: &'a Value, name: &str) -> &'a str {
    let facts = state["facts"].as_array().expect("facts");
    facts.iter().find(|fact| fact[0] == name).and_then(|fact| fact[1].as_str()).unwrap_or_else(|| panic!("{state}"))
}

#[test]
fn a_save_shows_the_model_and_an_error_keeps_the_last_one() {
    let place = Place::with(&case(1.0));
    let editor = Editor::of(&place);
    let first = editor.wait(|state| state["model"] == 1);
    assert_eq!((fact(&first, "blocks"), &first["error"]), ("3", &Value::Null));
    let page = editor.get("/model?from=1", &editor.address).1;
    assert!(String::from_utf8_lossy(&page).contains("id=\"film\""), "a page with its model in it");
    let bounded = editor.wait(|state| fact(state, "limit analysis") != "…");
    assert!(!fact(&bounded, "limit analysis").is_empty());

    fs::write(place.path("case.toml"), case(1.0).replace("density", "densty")).expect("saved");
    let wrong = editor.wait(|state| state["error"] != Value::Null);
    let message = wrong["error"].as_str().expect("a message");
    assert!(message.starts_with("case.toml:15: rock.granite.densty: unknown key"), "{message}");
    assert_eq!((wrong["model"].as_u64(), fact(&wrong, "blocks")), (Some(1), "3"));
    assert_eq!(editor.get("/model?from=1", &editor.address).1, page);

    let third = "[[joint]]\npoints = [[0, 0.5], [6, 0.5]]\nlaw = \"plane\"\n[rock.granite]";
    fs::write(place.path("case.toml"), case(1.0).replace("[rock.granite]", third).replace("[3, 0.5]", "[3, 0.2]"))
        .expect("saved");
    let mended = editor.wait(|state| state["model"] == 2);
    assert_eq!((fact(&mended, "blocks"), &mended["error"]), ("4", &Value::Null));
    assert_eq!(place.names(), ["case.toml"]);
}

#[test]
fn only_this_machine_is_answered() {
    let place = Place::with(&case(1.0));
    let editor = Editor::of(&place);
    editor.wait(|state| state["model"] == 1);
    assert_eq!(editor.get("/", "example.org").0, "HTTP/1.1 403 Forbidden");
    assert_eq!(editor.get("/case.toml", &editor.address).0, "HTTP/1.1 404 Not Found");
    let (status, page) = editor.get("/", &editor.address);
    assert!(status.ends_with("200 OK") && String::from_utf8_lossy(&page).contains("<title>enmm edit</title>"));
    let missing = place.enmm(&["edit", "none.toml"]);
    missing.assert_bad_input(&["none.toml is no file"]);
}
