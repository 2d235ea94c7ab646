//! Records of ground motion in columns: units that heads name, columns that are not ours, times that no stage reaches,
//! waves, baselines, and files that cannot be used.

use std::fs;

use enmm::model::Case;
use enmm_io::{CaseError, LoadedCase, parse_case};

/// Standard gravity (m/s²).
pub const G: f64 = 9.80665;

const CASE: &str = r#"
title = "Shaken block"
domain = { outline = [[0, 0], [10, 0], [10, 5], [0, 5]] }
mesh = { size = 2.0 }
[rock.r]
density = 2650
young = 2e9
poisson = 0.25
[[stage]]
name = "rest"
kind = "static"
duration = 5.0
[[stage]]
name = "quake"
kind = "dynamic"
duration = 4.0
"#;

/// Reads a case with a ground motion of a file.
pub fn load(name: &str, text: impl AsRef<[u8]>, motion: &str) -> Result<LoadedCase, CaseError> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(name), text).expect("written");
    parse_case(&format!("{CASE}{motion}\n"), "case.toml", folder.path())
}

pub fn base(name: &str, text: impl AsRef<[u8]>, keys: &str) -> Result<LoadedCase, CaseError> {
    load(name, text, &format!("[[base_motion]]\nfile = {name:?}\n{keys}"))
}

pub fn wave(name: &str, text: impl AsRef<[u8]>, keys: &str) -> Result<LoadedCase, CaseError> {
    load(name, text, &format!("[[quiet]]\nedge = [[0, 0], [10, 0]]\n{keys}"))
}

pub fn rows(loaded: &LoadedCase) -> &[[f64; 2]] {
    let case = &loaded.case;
    let table = case.base_motions.first().map_or_else(|| &case.quiets[0].table, |base| &base.table);
    table.as_ref().expect("rows")
}

/// The line of the only ground motion.
pub fn line(case: &Case) -> String {
    let [motion] = <[_; 1]>::try_from(case.ground_motions()).expect("one motion");
    motion.text()
}

/// The error without the folder of the test.
pub fn refused(read: Result<LoadedCase, CaseError>) -> String {
    let told = read.expect_err("refused").to_string();
    let [before, after] = told.split_once("/tmp/").map_or([told.as_str(), ""], |(a, b)| [a, b]);
    let inside = after.split_once('/').map_or(after, |(_, rest)| rest);
    format!("{before}{inside}")
}

/// Peak of the rows with the factor of the case (m/s²).
pub fn peak(loaded: &LoadedCase) -> f64 {
    loaded.case.base_motions[0].scale * rows(loaded).iter().map(|row| row[1].abs()).fold(0.0, f64::max)
}

/// Two seconds of a sine of 2 Hz as rows that `row` writes, of number, time (s) and value from −1 to 1.
pub fn sine(head: &str, row: impl Fn(usize, f64, f64) -> String) -> String {
    let of = |k: usize| row(k, 0.01 * k as f64, libm::sin(std::f64::consts::TAU * 2.0 * 0.01 * k as f64));
    (0..=200).fold(head.to_owned(), |text, k| text + &of(k) + "\n")
}

// ---------------------------------------------------------------------------------------------------------------------
// Heads that say what the columns are.

#[test]
fn a_record_in_cm_s2_was_read_as_fifty_g() {
    for head in [
        "Time (s),Acc (cm/s2)",
        "t,a\ns,gal",
        "# acceleration in cm/s/s",
        "t;acc [cm/s^2]",
        "t_s acc_cm_s2",
        "# unit: cm/sec²",
    ] {
        let text = sine(&format!("{head}\n"), |_, t, a| format!("{t},{}", 490.3325 * a));
        let loaded = base("r.csv", text, "").expect(head);
        assert!((peak(&loaded) - 0.5 * G).abs() < 0.02, "{head}: {}", peak(&loaded));
        let told = line(&loaded.case);
        assert!(
            told.contains(
                "as its head says, 201 rows, 0 to 2 s, peak 4.89 m/s² (0.499 g), acts in quake from 0 to 2 s"
            ),
            "{told}"
        );
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{head}");
    }
}

#[test]
fn a_record_in_g_moved_nothing() {
    let text = sine("Time (s),Acc (g)\n", |_, t, a| format!("{t},{}", 0.5 * a));
    let told = line(&base("r.csv", &text, "").expect("read").case);
    assert!(
        told.starts_with("base_motion[0]: ")
            && told.contains("r.csv (columns 1 and 2), acceleration in g as its head says"),
        "{told}"
    );
    assert!(told.contains("peak 4.89 m/s² (0.499 g)"), "{told}");
    // Where `scale` converts already, as it had to before heads were read, it goes on doing so, to the bit.
    let scaled = base("r.csv", &text, "scale = 9.81").expect("read");
    assert_eq!(
        (rows(&scaled)[1][1], scaled.case.base_motions[0].scale),
        (0.5 * libm::sin(0.04 * std::f64::consts::PI), 9.81)
    );
    assert!(
        line(&scaled.case).contains("in g as its head says, converted by `scale`, 201 rows times 9.81"),
        "{}",
        line(&scaled.case)
    );
    // A factor that is neither 1 nor the unit may mean either.
    let told = refused(base("r.csv", &text, "scale = 4.905"));
    assert!(
        told.starts_with("case.toml:19: base_motion[0].scale: is 4.905, and the head of the file names g"),
        "{told}"
    );
    let halved = base("r.csv", &text, "scale = 0.5\nrecord = { unit = \"g\" }").expect("read");
    assert!((peak(&halved) - 0.25 * G).abs() < 0.01, "{}", peak(&halved));
    // Without a head the small peak is warned of.
    let text = sine("", |_, t, a| format!("{t},{}", 0.05 * a));
    let [warning] = <[String; 1]>::try_from(base("r.csv", &text, "").expect("read").warnings).expect("one");
    assert!(
        warning.contains("m/s² (0.00509 g), below 0.01 g: it is read in m/s² as no unit is named; state another"),
        "{warning}"
    );
    let stated = base("r.csv", &text, "record = { unit = \"g\" }").expect("read");
    assert!(line(&stated.case).contains("acceleration in g as `record.unit` says"), "{}", line(&stated.case));
}

#[test]
fn an_index_before_the_time_was_read_as_the_time() {
    let write = |k: usize, t: f64, a: f64| format!("{k},{t},{}", 0.5 * a);
    for head in ["i,t,a", "# no, time (s), acc", "index;t;a"] {
        let loaded = base("r.csv", sine(&format!("{head}\n"), write), "scale = 9.81").expect(head);
        assert_eq!(rows(&loaded).last().expect("rows")[0], 2.0);
        assert!(line(&loaded.case).contains("(columns 2 and 3)"), "{}", line(&loaded.case));
        assert_eq!(loaded.warnings, Vec::<String>::new());
    }
    let told = refused(base("r.csv", sine("", write), "scale = 9.81"));
    assert!(
        told.contains("case.toml:18: base_motion[0].file: ") && told.contains("counts 0, 1, 2, … beside two more"),
        "{told}"
    );
    assert!(told.ends_with("such as `record = { columns = [2, 3] }`"), "{told}");
    let named = base("r.csv", sine("", write), "scale = 9.81\nrecord = { columns = [2, 3] }").expect("read");
    assert_eq!(rows(&named).len(), 201);
    // An index and no time.
    let two = sine("n,a\n", |k, _, a| format!("{k} {a}"));
    assert!(refused(base("r.csv", &two, "")).contains("record = { columns = [2], dt = 0.01 }"));
    let spaced = base("r.csv", &two, "record = { columns = [2], dt = 0.01 }").expect("read");
    assert_eq!(rows(&spaced)[200][0], 2.0);
    let bare = base("r.csv", sine("", |k, _, a| format!("{k} {a}")), "").expect("read");
    assert!(bare.warnings.iter().any(|warning| warning.contains("the times count 0, 1, 2, …")), "{:?}", bare.warnings);
    let seconds =
        "[[stage]]\nname = \"after\"\nkind = \"dynamic\"\nduration = 400.0\n[[base_motion]]\nfile = \"r.csv\"\n";
    let stated = load("r.csv", sine("", write), &format!("{seconds}record = {{ columns = [1, 3] }}\nscale = 9.81"));
    assert_eq!(stated.expect("read").warnings, Vec::<String>::new());
    let bare =
        load("r.csv", sine("", |k, _, a| format!("{k} {a}")), &format!("{seconds}record = {{ time_unit = \"s\" }}"));
    assert_eq!(bare.expect("read").warnings, Vec::<String>::new());
}

#[test]
fn times_in_milliseconds_were_read_as_seconds() {
    let write = |_: usize, t: f64, a: f64| format!("{},{}", 1e3 * t, 5.0 * a);
    for head in ["time_ms,a", "t (ms),a", "Time [msec],acc", "t,a\n(ms),(m/s2)"] {
        let loaded = base("r.csv", sine(&format!("{head}\n"), write), "").expect(head);
        assert!((rows(&loaded)[200][0] - 2.0).abs() < 1e-12, "{head}");
        assert!(line(&loaded.case).contains("columns 1 and 2, times in ms"), "{}", line(&loaded.case));
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{head}");
    }
    let bare = base("r.csv", sine("", write), "").expect("read");
    let [warning] = <[String; 1]>::try_from(bare.warnings).expect("one");
    assert!(warning.contains("lasts to 2000 s, and its dynamic stages end after 4 s"), "{warning}");
    assert!(warning.contains("state `record = { time_unit = \"ms\" }`"), "{warning}");
    let stated = base("r.csv", sine("", write), "record = { time_unit = \"ms\" }").expect("read");
    assert_eq!(rows(&stated)[200][0], 2.0);
    let told = refused(base("r.csv", sine("time_ms,a\n", write), "record = { time_unit = \"s\" }"));
    assert!(told.contains("record.time_unit: is \"s\", and the head of the file says \"ms\""), "{told}");
    assert!(refused(base("r.csv", sine("t (min),a\n", write), "")).contains("must be s or ms"));
}

#[test]
fn records_that_their_stage_leaves_out_passed_without_a_word() {
    let late = sine("", |_, t, a| format!("{},{}", 5.0 + t, 5.0 * a));
    let loaded = base("r.csv", &late, "").expect("read");
    assert!(
        line(&loaded.case).contains("5 to 7 s, peak 4.99 m/s² (0.509 g), acts in no stage"),
        "{}",
        line(&loaded.case)
    );
    let [warning] = <[String; 1]>::try_from(loaded.warnings).expect("one");
    assert!(warning.contains("begins at 5 s, and its dynamic stages end after 4 s: it moves nothing"), "{warning}");
    let long = sine("", |_, t, a| format!("{},{}", 3.0 * t, 5.0 * a));
    let loaded = base("r.csv", &long, "").expect("read");
    assert!(line(&loaded.case).contains("acts in quake from 0 to 4 s"), "{}", line(&loaded.case));
    assert!(
        loaded.warnings[0].contains("lasts to 6 s, and its dynamic stages end after 4 s: what comes later"),
        "{:?}",
        loaded.warnings
    );
    // A second dynamic stage goes on with it, and zeros at the end leave nothing out.
    let more = "[[stage]]\nname = \"after\"\nkind = \"dynamic\"\nduration = 3.0\n[[base_motion]]\nfile = \"r.csv\"";
    let loaded = load("r.csv", &long, more).expect("read");
    assert!(
        line(&loaded.case).contains("acts in quake from 0 to 4 s, in after from 0 to 2 s"),
        "{}",
        line(&loaded.case)
    );
    let quiet = late.replace("5,", "0,").lines().next().map(|_| "0,0\n1,3\n2,0\n60,0\n").expect("rows");
    assert_eq!(base("r.csv", quiet, "").expect("read").warnings, Vec::<String>::new());
}

#[test]
fn more_columns_than_two_are_chosen_by_the_head_or_warned_of() {
    let three = |head: &str| sine(head, |_, t, a| format!("{t},{},{}", 0.1 * a, 3.0 * a));
    let loaded = base("r.csv", three("time (s),v (m/s),a (m/s2)\n"), "").expect("read");
    assert_eq!((peak(&loaded) / 3.0 * 100.0).round(), 100.0);
    assert_eq!(loaded.warnings, Vec::<String>::new());
    let loaded =
        load("r.csv", three("time (s),v (m/s),a (m/s2)\n"), "[[base_motion]]\nvelocity = \"r.csv\"").expect("read");
    assert!(
        line(&loaded.case).contains("(columns 1 and 2), velocity in m/s as its head says"),
        "{}",
        line(&loaded.case)
    );
    for head in ["t,ns,ew\n", ""] {
        let loaded = base("r.csv", three(head), "").expect("read");
        let [warning, ..] = loaded.warnings.as_slice() else { panic!("no warning") };
        assert!(warning.contains("has 3 columns, of which 1 is read as time and 2 as value"), "{warning}");
        assert!(warning.contains("`record = { columns = [1, 3] }`"), "{warning}");
        let chosen = base("r.csv", three(head), "record = { columns = [1, 3] }").expect("read");
        assert_eq!(chosen.warnings, Vec::<String>::new());
    }
    for (columns, told) in [
        ("[1, 4]", "record.columns: has 4, must be at least 1 and at most 3"),
        ("[2, 2]", "must be two different columns"),
        ("[2]", "has one column, and no `dt`"),
        ("[0, 2]", "record.columns[0]: is 0, must be at least 1 and at most 1000"),
    ] {
        let refused = refused(base("r.csv", three(""), &format!("record = {{ columns = {columns} }}")));
        assert!(refused.contains(told), "{refused}");
    }
}

#[test]
fn heads_that_contradict_the_case_or_themselves_are_refused() {
    let text = |head: &str| sine(&format!("{head}\n"), |_, t, a| format!("{t},{a}"));
    for (head, keys, told) in [
        ("t,a (g)", "record = { unit = \"gal\" }", "record.unit: is gal, and the head of the file says g"),
        ("t,v (cm/s)", "", "is in cm/s by its head, a unit of velocity, and acceleration is asked for"),
        ("t,velocity", "", "holds velocity by its head, and acceleration is asked for; name it by `velocity = \"…\"`"),
        ("t,a (counts)", "", "has values in a unit that is not known, by its head"),
        ("# Acc. (g), filtered, in cm/s2", "", "names g and cm/s² in its head; state which"),
        ("t,a", "record = { unit = \"furlong\" }", "\"furlong\" is no unit that is known, must be one of g, "),
        ("t,a", "record = { unit = \"cm/s\" }", "is cm/s, a unit of velocity, and the record is one of acceleration"),
        ("t,a", "record = { channel = 2 }", "record.channel: belongs to a file with channels"),
        ("t,a", "record = { dt = 0.01 }", "record.dt: is for values without times, and the file has 2 columns"),
        ("t,a", "table = [[0, 0], [1, 1]]", "base_motion[0].table: the rows are also in"),
        ("t,a", "velocity = \"r.csv\"", "base_motion[0].velocity: `file` names a file too, only one can be"),
    ] {
        let refused = refused(base("r.csv", text(head), keys));
        assert!(refused.contains(told), "{head}: {refused}");
    }
    let told = refused(wave("r.csv", text("t,a (g)"), "wave = [0.1, 0]\nfile = \"r.csv\""));
    assert!(told.contains("is in g by its head, a unit of acceleration, and velocity is asked for"), "{told}");
    let told = refused(wave("r.csv", text("t,v (cm/s)"), "wave = [0.1, 0]\nfile = \"r.csv\""));
    assert!(told.contains("a `file` of a wave has factors on `wave`; name it by `velocity = \"…\"`"), "{told}");
    let told = refused(load("r.csv", "", "[[base_motion]]\ntable = [[0, 0], [1, 1]]\nrecord = { dt = 0.1 }"));
    assert!(told.contains("base_motion[0].record: says how a file is read, and the rows are in `table`"), "{told}");
}

#[test]
fn peaks_that_no_earthquake_has_are_warned_of() {
    for (amplitude, told) in
        [(0.09, "below 0.01 g"), (0.11, ""), (29.0, ""), (30.0, "above 3 g"), (0.0, "has no motion")]
    {
        let warnings = base("r.csv", sine("", |_, t, a| format!("{t},{}", amplitude * a)), "").expect("read").warnings;
        assert_eq!(warnings.len(), usize::from(!told.is_empty()), "{amplitude}: {warnings:?}");
        assert!(warnings.iter().all(|warning| warning.contains(told)), "{warnings:?}");
    }
    for (key, amplitude, told) in [
        ("velocity", 0.004, "below 0.005 m/s"),
        ("velocity", 6.0, "above 5 m/s"),
        ("displacement", 0.0004, "below 0.0005 m"),
        ("displacement", 11.0, "above 10 m"),
    ] {
        let text = sine("", |_, t, a| format!("{t},{}", amplitude * a));
        let warnings = wave("r.csv", text, &format!("{key} = \"r.csv\"")).expect("read").warnings;
        assert!(warnings.iter().any(|warning| warning.contains(told)), "{told}: {warnings:?}");
    }
    let table = "[[base_motion]]\ntable = [[0, 0], [1, 50], [2, 0]]";
    let warnings = load("r.csv", "", table).expect("read").warnings;
    assert!(
        warnings[0].contains("base_motion[0]: the peak of the table is 50 m/s² (5.1 g), above 3 g"),
        "{warnings:?}"
    );
}

#[test]
fn one_column_takes_its_time_step_from_the_case_or_a_comment() {
    let values = sine("# a station\n", |_, _, a| format!("{a}"));
    let told = refused(base("r.txt", &values, ""));
    assert!(
        told.starts_with("r.txt:2: the line has fewer than 2 columns") && told.ends_with("for values alone"),
        "{told}"
    );
    let loaded = base("r.txt", &values, "record = { dt = 0.01, unit = \"g\" }").expect("read");
    assert_eq!((rows(&loaded)[200][0], rows(&loaded).len()), (2.0, 201));
    assert!(
        line(&loaded.case).contains("r.txt (column 1), acceleration in g as `record.unit` says"),
        "{}",
        line(&loaded.case)
    );
    let stated = base("r.txt", values.replace("# a station", "# a (m/s2), dt = 10 ms"), "").expect("read");
    assert_eq!(rows(&stated)[200][0], 2.0);
    for (dt, told) in [("0", "is 0 s, must be greater than 0"), ("-1", "is -1 s"), ("nan", "dt")] {
        assert!(refused(base("r.txt", &values, &format!("record = {{ dt = {dt} }}"))).contains(told), "{dt}");
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Waves and baselines.

#[test]
fn a_wave_is_made_of_acceleration_velocity_or_displacement() {
    use std::f64::consts::TAU;
    // Displacement d = A (1 − cos ωt)/ω², whose velocity and acceleration are known.
    let (amplitude, omega) = (2.0, TAU * 2.0);
    let text = |value: &dyn Fn(f64) -> f64| {
        (0..=200).fold(String::new(), |text, k| {
            let t = 0.01 * f64::from(k);
            text + &format!("{t},{}\n", value(t))
        })
    };
    let velocity = |t: f64| amplitude * libm::sin(omega * t) / omega;
    let of = |key: &str, text: String| wave("r.csv", text, &format!("{key} = \"r.csv\"")).expect(key);
    for (key, text, error) in [
        ("acceleration", text(&|t| amplitude * libm::cos(omega * t)), 3e-3),
        ("velocity", text(&velocity), 0.0),
        ("displacement", text(&|t| amplitude * (1.0 - libm::cos(omega * t)) / omega / omega), 3e-3),
    ] {
        let loaded = of(key, text);
        let quiet = &loaded.case.quiets[0];
        assert_eq!((quiet.wave, quiet.kind, quiet.scale), (Some([1.0, 0.0]), None, 1.0));
        let peak = amplitude / omega;
        let worst = rows(&loaded).iter().map(|row| (row[1] - velocity(row[0])).abs()).fold(0.0, f64::max);
        assert!(worst <= error * peak, "{key}: {}", worst / peak);
    }
}

#[test]
fn the_record_of_an_outcrop_is_halved_and_other_waves_are_not() {
    let text = sine("t,a (g)\n", |_, t, a| format!("{t},{}", 0.2 * a));
    let value = |keys: &str| {
        let loaded = wave("r.csv", &text, &format!("acceleration = \"r.csv\"\n{keys}")).expect(keys);
        (rows(&loaded)[10][1], line(&loaded.case))
    };
    let (whole, told) = value("motion = \"incident\"");
    assert!(!told.contains("halved"), "{told}");
    assert_eq!(value("").0, whole);
    let (half, told) = value("motion = \"outcrop\"\nscale = 1.5\nrecord = { unit = \"g\" }");
    assert_eq!(half, 0.5 * whole);
    assert!(told.contains("201 rows times 1.5, 0 to 2 s, peak 2.94 m/s² (0.299 g)"), "{told}");
    assert!(
        told.contains("made a velocity with peak 0.2") && told.contains("halved as the motion of an outcrop"),
        "{told}"
    );
    // Factors on an amplitude, as before, may be those of an outcrop too.
    let factors = "wave = [0.2, 0]\ntable = [[0, 0], [1, 1], [2, 0]]";
    let quiets = |more: &str| wave("r.csv", "", &format!("{factors}\n{more}")).expect("read").case.quiets;
    let peak = |more: &str| quiets(more)[0].table.as_ref().expect("rows")[1];
    assert_eq!(
        [peak(""), peak("motion = \"incident\""), peak("motion = \"outcrop\"")],
        [[1.0, 1.0], [1.0, 1.0], [1.0, 0.5]]
    );
    let told = refused(wave("r.csv", "", "motion = \"outcrop\""));
    assert!(told.contains("quiet[0].motion: belongs to a wave, and the boundary has none"), "{told}");
    assert!(refused(wave("r.csv", "", "kind = \"velocity\"")).contains("quiet[0].table: is missing"));
}

#[test]
fn baselines_end_at_rest_and_say_what_they_changed() {
    // An offset and a drift: both would carry the base away.
    let text = sine("", |_, t, a| format!("{t},{}", 3.0 * a + 0.2 + 0.05 * t));
    let ends = |case: &Case| case.ground_motions()[0].ends;
    let read = |keys: &str| base("r.csv", &text, keys).expect(keys).case;
    let plain = ends(&read(""));
    assert!((plain[0] - 0.5).abs() < 1e-6 && plain[1] > 0.8, "{plain:?}");
    assert_eq!(ends(&read("baseline = \"none\"")), plain);
    let constant = ends(&read("baseline = \"constant\""));
    assert!(constant[0] == 0.0 && constant[1].abs() > 0.01, "{constant:?}");
    let case = read("baseline = \"linear\"");
    assert_eq!(ends(&case), [0.0, 0.0]);
    let told = line(&case);
    assert!(told.contains("baseline linear: final velocity 0 m/s, final displacement 0 m (before 0.5 m/s, "), "{told}");
    // A straight line is all of a record that is one.
    let ramp = base("r.csv", "0,1\n1,3\n2,5\n", "baseline = \"linear\"").expect("read");
    assert!(rows(&ramp).iter().all(|row| row[1].abs() < 1e-12), "{:?}", rows(&ramp));
    for key in ["acceleration", "velocity", "displacement"] {
        let loaded = wave("r.csv", &text, &format!("{key} = \"r.csv\"\nbaseline = \"linear\"")).expect(key);
        assert_eq!(ends(&loaded.case), [0.0, 0.0], "{key}");
    }
    let drifting =
        wave("r.csv", sine("", |_, t, a| format!("{t},{}", 3.0 * a + 8.0)), "acceleration = \"r.csv\"").expect("read");
    assert!(
        drifting.warnings.iter().any(|warning| warning.contains("above 5 m/s: it drifts unless its baseline")),
        "{:?}",
        drifting.warnings
    );
}

#[test]
fn a_displacement_of_the_base_becomes_a_velocity() {
    let text = sine("t,d (mm)\n", |_, t, a| format!("{t},{}", 40.0 * a));
    let loaded = base("r.csv", &text, "kind = \"displacement\"").expect("read");
    let told = line(&loaded.case);
    assert!(told.contains("displacement in mm as its head says, 201 rows, 0 to 2 s, peak 0.0399 m"), "{told}");
    assert!(told.contains("made a velocity with peak 0.50"), "{told}");
    assert_eq!(rows(&loaded)[0], [0.0, 0.0]);
    let again = LoadedCase::of(loaded.case.clone(), "case.toml").expect("plain data");
    assert_eq!((again.hash, again.case), (loaded.hash, loaded.case));
}

// ---------------------------------------------------------------------------------------------------------------------
// Files that are none.

#[test]
fn files_without_a_record_are_refused_with_their_line() {
    for (name, bytes, told) in [
        ("r.csv", &b""[..], "r.csv:1: the file has no numbers"),
        ("r.csv", b"\n\n# only words\n", "r.csv:1: the file has no numbers"),
        ("r.csv", b"0,0\n0.1,nan\n", "r.csv:2: \"nan\" is not finite"),
        ("r.csv", b"nan,0\n0.1,1\n", "r.csv:1: \"nan\" is not finite"),
        ("r.csv", b"0,0\n0.1,inf\n", "r.csv:2: \"inf\" is not finite"),
        ("r.csv", b"t,a\nunits,g\n0,1\n", "r.csv:2: a column is no number"),
        ("r.csv", b"0,1\n0.1\n", "r.csv:2: the line has fewer than 2 columns"),
        (
            "r.csv",
            b"0,1\n0.1,2\n0.1,3\n",
            "r.csv:3: base_motion[0].table[2]: time is 0.1 s, must be greater than 0.1 s",
        ),
        ("r.csv", b"0,1\n", "has 1 row, at least 2 are needed"),
        ("r.mseed", b"000001D \0\0\x01", "it is binary, and records are read as text"),
    ] {
        let refused = refused(base(name, bytes, ""));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
    // Marks of other programs are passed over.
    let loaded = base("r.csv", "\u{feff}sep=;\nt;a\n0;0\n0.1;2\n0.2;0\n", "").expect("read");
    assert_eq!(rows(&loaded), [[0.0, 0.0], [0.1, 2.0], [0.2, 0.0]]);
}

/// A first row with a slip was taken for a heading, and left out without a word.
#[test]
fn a_first_row_with_a_slip_is_no_heading() {
    let rows = "0.02, 5\n0.04, 5\n";
    let keys = "axis = \"x\"\nkind = \"acceleration\"\nstage = \"quake\"";
    for first in ["O, 5", "0.0o, 5", "t0 1e3"] {
        let told = refused(base("r.csv", format!("{first}\n{rows}"), keys));
        assert!(told.contains("r.csv:1") && told.contains("heading with `#`"), "{first}: {told}");
    }
    let marked = base("r.csv", format!("\u{feff}0, 5\n{rows}"), keys).expect("a record");
    assert_eq!(self::rows(&marked), [[0.0, 5.0], [0.02, 5.0], [0.04, 5.0]]);
    let headed = base("r.csv", format!("Zeit;Wert\n{rows}"), keys).expect("a record");
    assert!(line(&headed.case).contains("line 1 is taken for a heading"), "{}", line(&headed.case));
}
