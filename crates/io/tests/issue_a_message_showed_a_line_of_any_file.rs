//! `/etc/shadow` as a record printed a line with a password's hash; names with control characters and formulas went to
//! terminals and spreadsheets.

use std::fs;
use std::path::Path;

use enmm_io::{load_case, load_case_with, parse_case};

const SECRET: &str = "root:$6$hash:19000:0:99999:7:::\ndaemon:*:19000:0:99999:7:::\n\n[section]\npassword = a b\n";

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases").join(name);
    fs::read_to_string(path).expect("an example")
}

/// Asserts that a message shows no word of the file.
fn is_silent(told: &str) {
    for word in ["root", "hash", "daemon", "19000", "section", "password"] {
        assert!(!told.contains(word), "{word} in {told}");
    }
}

#[test]
fn no_reader_shows_a_line_of_a_file_that_is_none_of_its_kind() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("case.toml"), example("block_on_incline.toml")).expect("written");
    let incline = |file: &str| load_case_with(&path("case.toml"), &[format!("domain.geometry_file={file:?}")]);
    for file in ["a.csv", "a.dxf", "a.wkt", "a.json", "a.geojson"] {
        fs::write(path(file), SECRET).expect("written");
        is_silent(&incline(file).expect_err("no geometry").to_string());
        fs::write(path(file), "\"root password\"").expect("written");
        is_silent(&incline(file).expect_err("no geometry").to_string());
    }
    for (file, text) in [
        ("b.geojson", "{\"type\": \"password hash\", \"root\": 1}"),
        ("b.dxf", "12345\nroot\npassword\n"),
        ("b.csv", "user,x,y,trace\nroot,hash,1,2\n"),
    ] {
        fs::write(path(file), text).expect("written");
        is_silent(&incline(file).expect_err("no geometry").to_string());
    }
    fs::write(path("plain"), SECRET).expect("written");
    is_silent(&load_case(&path("plain")).expect_err("no case").to_string());
    let shaken = example("shaken_slope.toml").replace("synthetic_record.csv", "plain");
    is_silent(&parse_case(&shaken, "shaken.toml", folder.path()).expect_err("no record").to_string());
    fs::write(path("plain"), format!("# {SECRET}")).expect("written");
    is_silent(&parse_case(&shaken, "shaken.toml", folder.path()).expect_err("no record").to_string());
}

#[test]
fn a_slip_in_a_record_or_a_table_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let shaken = example("shaken_slope.toml");
    for (text, shown) in
        [("0,0\n1,0.1g\n", "\"0.1g\""), ("0,0 m\n1.2.3,0\n", "\"1.2.3\""), ("0,0;0,1\n", "\"0,0;0,1\"")]
    {
        fs::write(folder.path().join("synthetic_record.csv"), text).expect("written");
        let told = parse_case(&shaken, "shaken.toml", folder.path()).expect_err("no record").to_string();
        assert!(told.contains(shown), "{told}");
    }
}

#[test]
fn names_that_do_harm_are_refused() {
    let case = example("block_on_incline.toml");
    let refused = |case: String| parse_case(&case, "case.toml", Path::new("")).expect_err("a bad name").to_string();
    let monitor = |name: &str| format!("{case}\n[[monitor]]\nname = \"{name}\"\npoint = [1, 1]\n");
    for (name, told) in [
        ("=HYPERLINK(1)", "begins with `=`"),
        ("+1", "begins with `+`"),
        (" -1", "begins with `-`"),
        ("@cmd", "begins with `@`"),
        ("a\\u001b[2J", "control character '\\u{1b}'"),
        ("a\\nb", "control character '\\n'"),
        ("a\\u00adb", "control character '\\u{ad}'"),
        ("a\\u2028b", "control character '\\u{2028}'"),
        ("a\\U000E0041b", "control character '\\u{e0041}'"),
        (&"a".repeat(256), "has 256 letters, must have at most 255"),
    ] {
        let message = refused(monitor(name));
        assert!(message.contains("monitor[") && message.contains(told), "{message}");
    }
    let set = |name: &str| format!("{case}\n[[joint_set]]\nname = \"{name}\"\nangle_deg = 30\nspacing = 1\n");
    let message = refused(set("=cmd()"));
    assert!(message.contains("joint_set[0].name") && message.contains("begins with `=`"), "{message}");
    let message = refused(set("a\\u202eb"));
    assert!(message.contains("control character"), "{message}");
    let title = case.lines().find(|line| line.starts_with("title")).expect("a title");
    let message = refused(case.replace(title, "title = \"a\\u001b[2J\""));
    assert!(message.contains("title") && message.contains("control character"), "{message}");
    let law = refused(case.clone() + "\n[joint_law.\"=1+1\"]\nfriction_deg = 30\n");
    assert!(law.contains("joint_law") && law.contains("begins with `=`"), "{law}");
    let rock = refused(case.clone() + "\n[rock.\"@a\"]\ndensity = 1\nyoung = 1e9\npoisson = 0.2\nblocks = [[1, 1]]\n");
    assert!(rock.contains("rock") && rock.contains("begins with `@`"), "{rock}");
}
