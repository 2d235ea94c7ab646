//! 500 000 joints 1e-7 m apart took minutes to refuse, and a point a thousand times too high ten seconds: the search
//! for ends near lines and the noder compare every line with every other that is near.

use std::fmt::Write;
use std::path::Path;

use enmm_io::{load_case, parse_case};

/// A case with a table of traces.
fn case(folder: &Path, outline: &str, mesh: f64, rows: impl Iterator<Item = [f64; 4]>) -> std::path::PathBuf {
    let mut table = String::from("x1,y1,x2,y2\n");
    rows.for_each(|[a, b, c, d]| writeln!(table, "{a:.9},{b:.9},{c:.9},{d:.9}").expect("text"));
    std::fs::write(folder.join("traces.csv"), table).expect("written");
    let text = format!(
        "title = \"dense\"\n[domain]\noutline = {outline}\ngeometry_file = \"traces.csv\"\n[mesh]\nsize = {mesh}\n\
         [joint_law.joint]\nfriction_deg = 35\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.2\n\
         [[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = 0.1\n"
    );
    let path = folder.join("case.toml");
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn lines_without_room_between_them_are_refused_soon() {
    let folder = tempfile::tempdir().expect("a folder");
    let wide = "[[0, 0], [10, 0], [10, 5], [0, 5]]";
    let thin = "[[0, 0], [0.05, 0], [0.05, 5], [0, 5]]";
    let n = 100_000;
    let at = |k: usize| 1.0 + 1e-7 * k as f64;
    let row = |kind: usize, k: usize| match kind {
        0 => [1.0, at(k), 1.05, at(k)],
        1 => [at(k), 1.0, at(k) + 0.001, 1.01],
        2 => [1.0, 1.0, 1.01 * at(k), 1.01],
        _ => [-1.0, at(k), 2.0, at(k)],
    };
    for (kind, (outline, mesh)) in [(wide, 1.0), (wide, 1.0), (wide, 1.0), (thin, 0.2)].into_iter().enumerate() {
        let path = case(folder.path(), outline, mesh, (0..n).map(|k| row(kind, k)));
        let loaded = load_case(&path).expect("a case");
        let told = loaded.cosimulation().map(drop).expect_err("too dense").to_string();
        assert!(told.contains("lie so close together") && told.contains("take out traces"), "kind {kind}: {told}");
    }
}

#[test]
fn dense_lines_with_room_between_them_are_cut() {
    let folder = tempfile::tempdir().expect("a folder");
    let rows = (0..200).map(|k| [-1.0, 1.0 + 0.01 * f64::from(k), 11.0, 1.0 + 0.01 * f64::from(k)]);
    let path = case(folder.path(), "[[0, 0], [10, 0], [10, 5], [0, 5]]", 1.0, rows);
    let model = load_case(&path).expect("a case").cosimulation().expect("a model");
    assert_eq!(model.block_states().len(), 201);
}

#[test]
fn a_huge_case_names_the_file_for_its_traces() {
    let traces = "[[joint]]\npoints = [[0.0, 1.0], [1.0, 1.0]]\n".repeat(250_000);
    let told = parse_case(&traces, "long.toml", Path::new("")).expect_err("too long").to_string();
    assert!(told.contains("the limit is 8388608") && told.contains("geometry_file"), "{told}");
}
