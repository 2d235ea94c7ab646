//! Claim: tables of usual kinds are read, and wrong ones refused with line, value, limit and remedy.

use enmm_field::{Scanline, Table};

fn planes(text: &str) -> Vec<[f64; 2]> {
    let table = Table::parse("field.csv", text).expect("a table");
    table.rows.iter().map(|row| row.plane().map(|angle| (angle * 1e6).round() / 1e6)).collect()
}

#[test]
fn usual_tables_are_read() {
    // Commas; DIPS with lines before the heads and units; FracMan's poles; strikes; semicolons and tabs.
    assert_eq!(planes("Dip,Dip Direction\n30,120\n90,0\n"), [[30.0, 120.0], [90.0, 0.0]]);
    let dips =
        "* Dips file\nSurvey of the pit, 2024\n\nID,Dip [deg],Dip Direction [deg],Quantity,Set\n1,65.5,300,2,J1\n";
    assert_eq!(planes(dips), [[65.5, 300.0]]);
    assert_eq!(planes("PoleTrend\tPolePlunge\n300\t60\n"), [[30.0, 120.0]]);
    assert_eq!(planes("strike;dip\n30;40\n"), [[40.0, 120.0]]);
    assert_eq!(planes("\u{feff}dip_dir;DIP (°)\n-60;40\n\n# a remark\n"), [[40.0, 300.0]]);
    let table = Table::parse("f", dips).expect("a table");
    assert_eq!((table.rows[0].quantity, table.rows[0].set.as_deref()), (2.0, Some("J1")));
    assert_eq!(table.notes.len(), 2, "{:?}", table.notes);
}

#[test]
fn wrong_tables_are_refused_with_line_and_remedy() {
    let cases: [(&str, &[&str]); 9] = [
        ("dip,dip direction\n30,120\n95,10\n", &["f.csv:3: dip is 95°, must be from 0 to 90", "correct"]),
        ("dip,dip direction\n120,30\n", &["f.csv:2: dip is 120°", "the other way round"]),
        ("dip,dip direction\n30,400\n", &["f.csv:2: dip direction is 400°, must be from -360 to 360"]),
        ("dip,dip direction\n30,120\n4O,10\n", &["f.csv:3: dip: \"4O\" is no number; correct it"]),
        ("dip;dip direction\n30,5;120\n", &["f.csv:2: dip: \"30,5\"", "write a decimal point"]),
        ("dip,dip direction\n30\n", &["f.csv:2: dip direction: is missing; write it"]),
        ("id,dip\n1,30\n", &["f.csv:1: a column is missing: the columns are id, dip", "`dip direction`"]),
        ("a,b\n1,2\n", &["f.csv: has no line with heads", "name them in a line above the rows"]),
        ("dip,dip direction,quantity\n30,120,0\n", &["f.csv:2: quantity is 0, must be above 0"]),
    ];
    for (text, parts) in cases {
        let message = Table::parse("f.csv", text).expect_err(text).to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    assert!(Table::parse("f.csv", "dip,strike\n").expect_err("empty").to_string().contains("no row"));
}

#[test]
fn rows_take_the_weight_of_their_line() {
    let text = "dip,dip direction,traverse\n90,0,T1\n90,90,T2\n";
    let table = Table::parse("f.csv", text).expect("a table");
    let line = |text: &str| Scanline::parse(text).expect("a line");
    let weights = |lines: &[Scanline]| -> Vec<f64> {
        table.weighted(lines).expect("weights").0.iter().map(|(_, weight)| *weight).collect()
    };
    assert_eq!(weights(&[]), [1.0, 1.0]);
    let both = weights(&[line("T1=60/0"), line("T2=90/0")]);
    assert!((both[0] - 2.0).abs() < 1e-12 && (both[1] - 1.0).abs() < 1e-12, "{both:?}");
    let (_, blind) = table.weighted(&[line("0/0")]).expect("weights");
    assert_eq!(blind, 1);
    let message = table.weighted(&[line("T1=60/0")]).expect_err("refused").to_string();
    assert!(
        message.contains("f.csv:3: traverse \"T2\"") && message.contains("--traverse T2=TREND/PLUNGE"),
        "{message}"
    );
    let message = table.weighted(&[line("T1=60/0"), line("T2=0/0"), line("T3=0/0")]).expect_err("refused").to_string();
    assert!(message.contains("no row is on a traverse \"T3\""), "{message}");
    let message = table.weighted(&[line("60/0"), line("0/0")]).expect_err("refused").to_string();
    assert!(message.contains("two traverses are given for all rows"), "{message}");
    // A name goes before the line for all rows.
    assert!((weights(&[line("60/0"), line("T2=90/0")])[1] - 1.0).abs() < 1e-12);
}

/// Joints at 1, 3 and 5 m of a line at 60° to their normal are 2·cos 60° = 1 m apart.
#[test]
fn spacings_are_normal_to_the_joints() {
    let text = "dip,dip direction,traverse,distance [m]\n90,0,T1,5\n90,0,T1,1\n90,0,T1,3\n90,0,T2,9\n";
    let table = Table::parse("f.csv", text).expect("a table");
    let lines = [Scanline::parse("T1=60/0").expect("a line"), Scanline::parse("T2=0/0").expect("a line")];
    let spacing = table.spacing(&lines, &table.rows[0].pole, &[0, 1, 2, 3]).expect("a spacing");
    assert!((spacing - 1.0).abs() < 1e-12, "{spacing}");
    assert_eq!(table.spacing(&lines, &table.rows[0].pole, &[0, 3]), None);
    assert_eq!(table.spacing(&[], &table.rows[0].pole, &[0, 1]), None);
}
