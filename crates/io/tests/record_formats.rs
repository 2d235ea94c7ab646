//! Records as agencies publish them: PEER, K-NET, ESM, CSMIP and COSMOS files, whole, cut off and spoilt.

use std::fmt::Write;

use crate::common::random::Random;
use crate::records::{G, base, line, load, peak, refused, rows, sine, wave};

/// Values eight on a line, each as wide as the format says.
fn lines_of(values: &[f64], per_line: usize, write: impl Fn(f64) -> String) -> String {
    values
        .chunks(per_line)
        .fold(String::new(), |text, line| text + &line.iter().map(|value| write(*value)).collect::<String>() + "\n")
}

fn values(count: usize, amplitude: f64) -> Vec<f64> {
    (0..count).map(|k| amplitude * libm::sin(0.1 * k as f64)).collect()
}

fn peer(quantity: &str, numbers: &str, values: &[f64]) -> String {
    let body = lines_of(values, 5, |value| format!("{value:15.7E}"));
    format!("PEER NGA STRONG MOTION DATABASE RECORD\nNowhere-01, 1/2/1999, Station, 090\n{quantity}\n{numbers}\n{body}")
}

#[test]
fn peer_files_are_read_in_both_forms_of_the_fourth_line() {
    let values = values(203, 0.3);
    for numbers in ["NPTS=   203, DT=   .0100 SEC", "  203   0.0100  NPTS, DT", "NPTS= 203  DT= 1.0E-2 SEC,"] {
        let text = peer("ACCELERATION TIME SERIES IN UNITS OF G", numbers, &values);
        let loaded = base("RSN1_NS.AT2", text, "").expect(numbers);
        assert_eq!(rows(&loaded).len(), 203);
        assert!((rows(&loaded)[202][0] - 2.02).abs() < 1e-9);
        assert!((rows(&loaded)[10][1] - G * values[10]).abs() < 1e-6);
        assert!(
            line(&loaded.case)
                .contains("RSN1_NS.AT2 (PEER), acceleration in g as its head says, 203 rows, 0 to 2.02 s"),
            "{}",
            line(&loaded.case)
        );
    }
    // In such a file the unit is certain, and `scale` a factor besides.
    let text = peer("ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 203, DT= .01 SEC", &values);
    let twice = base("r.AT2", text, "scale = 2.0").expect("read");
    assert!((peak(&twice) - 0.6 * G).abs() < 0.01, "{}", peak(&twice));
    // The content decides, whatever the name.
    let text = peer("VELOCITY TIME SERIES IN UNITS OF CM/S", "NPTS= 203, DT= .01 SEC", &values);
    let loaded = load("v.txt", text, "[[base_motion]]\nvelocity = \"v.txt\"").expect("read");
    assert!((rows(&loaded)[10][1] - 0.01 * values[10]).abs() < 1e-8);
    // Such files begin with a residue, and a base is at rest before it moves.
    let moved: Vec<f64> = values.iter().map(|value| value + 1e-3).collect();
    let text = peer("VELOCITY TIME SERIES IN UNITS OF CM/S", "NPTS= 203, DT= .01 SEC", &moved);
    let loaded = load("v.VT2", &text, "[[base_motion]]\nvelocity = \"v.VT2\"").expect("read");
    assert_eq!(rows(&loaded)[0][1], 0.0);
    assert!(line(&loaded.case).contains("(PEER, first velocity of 1.0e-5 m/s taken as 0)"), "{}", line(&loaded.case));
    let text = peer("VELOCITY TIME SERIES IN UNITS OF CM/S", "NPTS= 203, DT= .01 SEC", &values[15..]);
    let told = refused(load("v.VT2", text.replace("203", "188"), "[[base_motion]]\nvelocity = \"v.VT2\""));
    assert!(told.starts_with("v.VT2:5: base_motion[0].table[0]: starts with 0.0029"), "{told}");
    let text = peer("DISPLACEMENT TIME SERIES IN UNITS OF CM", "NPTS= 203, DT= .01 SEC", &values);
    assert!(wave("d.DT2", text, "displacement = \"d.DT2\"").is_ok());
    let fused = "-.1000000E-02-.2000000E-02\n 0.30000E-02-0.40000D-02\n";
    let text = format!("PEER\nx\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS= 4, DT= .01\n{fused}");
    assert_eq!(
        rows(&base("a.at2", text, "").expect("read")).iter().map(|row| (row[1] / G * 1e3).round()).collect::<Vec<_>>(),
        [-1.0, -2.0, 3.0, -4.0]
    );
}

#[test]
fn peer_files_that_are_cut_off_or_wrong_are_refused_with_their_line() {
    let values = values(203, 0.3);
    let head = "ACCELERATION TIME SERIES IN UNITS OF G";
    let with = |numbers: &str| peer(head, numbers, &values);
    let whole = with("NPTS= 203, DT= .01 SEC");
    let cut: String = whole.lines().take(30).fold(String::new(), |text, line| text + line + "\n");
    for (text, keys, told) in [
        (cut, "", "r.AT2:30: the file ends after 130 values of 203 (NPTS): it is cut off"),
        (with("NPTS= 204, DT= .01 SEC"), "", "r.AT2:45: the file ends after 203 values of 204 (NPTS)"),
        (with("NPTS= 200, DT= .01 SEC"), "", "r.AT2:45: here is value 201 of 200 (NPTS)"),
        (with("NPTS= 203, DT= 0.0 SEC"), "", "r.AT2:4: the time between values is 0 s, must be above 0"),
        (with("NPTS= 203, DT= -.01 SEC"), "", "r.AT2:4: the time between values is -0.01 s"),
        (with("NPTS= many, DT= .01 SEC"), "", "r.AT2:4: the numbers of NPTS and DT are missing"),
        (whole.replacen("0.0000000E0", "NaN        ", 1), "", "r.AT2:5: \"NaN\" is not finite"),
        (whole.replacen("0.0000000E0", "0.00000x0E0", 1), "", "r.AT2:5: \"0.00000x0E0\" is no number"),
        (String::new(), "", "r.AT2:1: the file ends in .at2 like PEER files, and its head is not theirs"),
        (sine("", |_, t, a| format!("{t},{a}")), "", "r.AT2:1: the file ends in .at2 like PEER files"),
        (
            with("NPTS= 203, DT= .01 SEC"),
            "record = { dt = 0.02 }",
            "record.dt: is 0.02 s, and the head of the file says 0.01 s",
        ),
        (
            with("NPTS= 203, DT= .01 SEC"),
            "record = { columns = [1, 2] }",
            "record.columns: belongs to a file with columns, and this one is PEER",
        ),
        (
            peer("ACCELERATION TIME SERIES IN UNITS OF COUNTS", "NPTS= 203, DT= .01", &values),
            "",
            "has a head without a unit that is known",
        ),
        (
            peer("VELOCITY TIME SERIES IN UNITS OF CM/S", "NPTS= 203, DT= .01", &values),
            "",
            "holds velocity by its head, and acceleration",
        ),
    ] {
        let refused = refused(base("r.AT2", text, keys));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
}

fn knet(values: &[i64], duration: &str) -> String {
    let body = values.chunks(8).fold(String::new(), |text, line| {
        text + &line.iter().map(|value| format!("{value:9}")).collect::<String>() + "\n"
    });
    format!(
        "Origin Time       2001/02/03 04:05:00\nLat.              40.0\nLong.             140.0\nDepth. (km)       10\n\
         Mag.              6.0\nStation Code      ABC001\nStation Lat.      40.1\nStation Long.     140.1\n\
         Station Height(m) 10\nRecord Time       2001/02/03 04:05:20\nSampling Freq(Hz) 100Hz\n\
         Duration Time(s)  {duration}\nDir.              N-S\nScale Factor      3920(gal)/6182761\n\
         Max. Acc. (gal)   100.000\n\
         Last Correction   2001/02/03 04:05:05\nMemo.             \n{body}"
    )
}

#[test]
fn knet_counts_times_the_scale_factor_are_gal() {
    let counts: Vec<i64> = (0..300).map(|k| 8009 + (2e5 * libm::sin(0.3 * f64::from(k))) as i64).collect();
    let loaded = base("ABC.NS", knet(&counts, "3"), "").expect("read");
    let factor = 0.01 * 3920.0 / 6_182_761.0;
    assert!(rows(&loaded).iter().zip(&counts).all(|(row, count)| (row[1] - factor * *count as f64).abs() < 1e-12));
    assert_eq!(rows(&loaded)[299][0], 2.99);
    assert!(
        line(&loaded.case).contains("ABC.NS (K-NET ASCII), acceleration in gal as its head says"),
        "{}",
        line(&loaded.case)
    );
    // The offset of the recorder, 5.08 gal, is what `baseline` takes away.
    let level = base("ABC.NS", knet(&counts, "3"), "baseline = \"constant\"").expect("read");
    assert!(rows(&level)[0][1].abs() < 0.051, "{}", rows(&level)[0][1]);
    for (text, told) in [
        (knet(&counts, "4"), "ABC.NS:55: the file ends after 300 values of 400 (duration times frequency)"),
        (knet(&counts, "3").replace("(gal)/6182761", "/0"), "ABC.NS:14: the scale factor must be as in"),
        (knet(&counts, "3").replace("100Hz", "0Hz"), "ABC.NS:11: the sampling frequency must be above 0 Hz"),
        ("Origin Time       2001\n1 2 3\n".to_owned(), "ABC.NS:1: the file ends in .ns like K-NET ASCII files"),
    ] {
        let refused = refused(base("ABC.NS", text, ""));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
}

fn esm(units: &str, kind: &str, values: &[f64]) -> String {
    let body = lines_of(values, 1, |value| format!("{value:.6}"));
    format!(
        "EVENT_NAME: NOWHERE\nEVENT_ID: XX-2000-0001\nEVENT_DATE_YYYYMMDD: 20000101\nEVENT_TIME_HHMMSS: 010203\n\
         STATION_NAME: FORL\u{cc}\nDATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: 20000101_010210.000\n\
         SAMPLING_INTERVAL_S: 0.005000\nNDATA: {}\nDURATION_S: 1.000\nSTREAM: HNE\nUNITS: {units}\n\
         PGA_CM/S^2: 120.0\nBASELINE_CORRECTION: BASELINE REMOVED\n\
         HEADER_FORMAT: DYNA 1.2\nDATA_TYPE: {kind}\nUSER1:\nUSER2:\n{body}",
        values.len()
    )
}

#[test]
fn esm_files_are_read_with_names_of_places_in_either_encoding() {
    let values = values(201, 120.0);
    let text = esm("cm/s^2", "ACCELERATION", &values);
    let western: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [text.as_bytes(), &western] {
        let loaded = base("XX.HNE.ASC", bytes, "").expect("read");
        assert!((rows(&loaded)[200][0] - 1.0).abs() < 1e-12);
        assert!((rows(&loaded)[15][1] - 0.01 * values[15]).abs() < 1e-8);
        assert!(
            line(&loaded.case).contains("(ESM ASCII), acceleration in cm/s² as its head says, 201 rows, 0 to 1 s"),
            "{}",
            line(&loaded.case)
        );
    }
    let velocity = esm("cm/s", "VELOCITY", &values);
    assert!(
        refused(base("r.asc", &velocity, "")).contains("holds velocity by its head, and acceleration is asked for")
    );
    assert!(load("r.asc", &velocity, "[[base_motion]]\nvelocity = \"r.asc\"").is_ok());
    for (from, to, told) in [
        ("NDATA: 201", "NDATA: 202", "r.asc:218: the file ends after 201 values of 202 (NDATA)"),
        ("UNITS: cm/s^2", "UNITS: counts", "r.asc:11: the head has no unit that is known in UNITS"),
        ("UNITS: cm/s^2", "SITE: A", "r.asc:1: the head has no unit"),
        ("SAMPLING_INTERVAL_S: 0.005000", "SAMPLING_INTERVAL_S: 0", "r.asc:7: the time between values is 0 s"),
        ("SAMPLING_INTERVAL_S: 0.005000", "SAMPLING_INTERVAL_S:", "r.asc:7: the time between values is missing"),
    ] {
        let refused = refused(base("r.asc", text.replace(from, to), ""));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
}

/// A channel of a file of the California Geological Survey.
fn channel(number: usize, accelerations: &[f64]) -> String {
    let part = |what: &str, unit: &str, format: &str, values: &[f64]| {
        let count = values.len();
        let body = lines_of(values, 8, |value| format!("{value:10.6}"));
        format!("{count:5} points of {what} data equally spaced at  .020 sec, in {unit}  ({format})\n{body}")
    };
    let smaller = |by: f64| accelerations.iter().map(|value| by * value).collect::<Vec<_>>();
    format!(
        "Corrected accelerogram    Nowhere\nChan  {number}:  90 Deg\nPeak  acceleration =  150.0 cm/s/s at   1.0 sec\n\
         {}{}{}/&  ----------  End of data for channel {number:2}  ----------\n",
        part("accel", "cm/sec2.", "8f10.6", accelerations),
        part("veloc", "cm/sec.", "8f10.7", &smaller(0.1)),
        part("displ", "cm.", "8f10.7", &smaller(0.01)),
    )
}

#[test]
fn channels_of_volume_two_have_acceleration_velocity_and_displacement() {
    // Values of 150 cm/s² fill their fields of ten signs and touch.
    let values = values(100, 150.0);
    let one = channel(1, &values);
    assert!(
        one.contains("149.")
            && one.lines().any(|line| line.split_whitespace().any(|word| word.matches('.').count() > 1))
    );
    for (key, factor) in [("acceleration", 0.01), ("velocity", 1e-3), ("displacement", 1e-4)] {
        let loaded = wave("CE1.V2", &one, &format!("{key} = \"CE1.V2\"")).expect(key);
        let typed = loaded.typed.quiets[0].table.as_ref().expect("rows");
        assert_eq!((typed.len(), typed[99][0]), (100, 1.98));
        assert!(typed.iter().zip(&values).all(|(row, value)| (row[1] - factor * value).abs() < 1e-7), "{key}");
    }
    let two = one.clone() + &channel(2, &values.iter().map(|value| 2.0 * value).collect::<Vec<_>>());
    let told = refused(base("CE1.V2", &two, ""));
    assert!(told.ends_with("has 2 channels of acceleration; choose one, such as `record = { channel = 1 }`"), "{told}");
    let loaded = base("CE1.V2", &two, "record = { channel = 2 }").expect("read");
    assert!((rows(&loaded)[16][1] - 0.02 * values[16]).abs() < 1e-7);
    assert!(
        line(&loaded.case).contains("CE1.V2 (CSMIP V2, channel 2), acceleration in cm/s²"),
        "{}",
        line(&loaded.case)
    );
    for (text, keys, told) in [
        (two, "record = { channel = 3 }", "record.channel: is 3, must be at least 1 and at most 2"),
        (
            one.replace("  100 points of accel", "  120 points of accel"),
            "",
            "CE1.V2:17: the file ends after 100 values of 120",
        ),
        (one.replace("in cm/sec2.", "in units."), "", "CE1.V2:4: the line names no unit that is known"),
        (one.replace(" .020 sec", " .000 sec"), "", "CE1.V2:4: the time between values is 0 s"),
    ] {
        let refused = refused(base("CE1.V2", text, keys));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
}

/// A channel of a COSMOS file, with its quantity and unit, and its time between values among the reals.
fn cosmos(quantity: &str, unit: &str, dt: &str, values: &[f64]) -> String {
    let mut reals = String::new();
    for line in 0..20 {
        for column in 0..5 {
            let place = 5 * line + column;
            let text = if place == 33 { dt.to_owned() } else { "-999.000000".to_owned() };
            write!(reals, "{text:>15}").expect("text");
        }
        reals.push('\n');
    }
    let body = lines_of(values, 8, |value| format!("{value:10.5}"));
    format!(
        "Corrected {quantity}    (Format v01.20 with 13 text lines) Src: 052t\nNowhere\n\
         Values used when parameter or data value is unknown/unspecified:   -999 -999.0\n \
         100  Integer-header values follow on 10 lines, Format= (10I8)\n{} \
         100 Real-header values follow on 20 lines, Format= (5F15.6)\n{reals}   \
         1 Comment line(s) follow, each starting with a \"|\":\n| Sensor\n\
         {} {quantity} pts, approx  1 secs, units={unit},Format=(8F10.5)\n{body}\
         End-of-data for Chan  1 {quantity}\n",
        "       2       1       4     120       1    -999    -999    -999    -999    -999\n".repeat(10),
        values.len(),
    )
}

#[test]
fn cosmos_files_have_one_quantity_after_another() {
    let values = values(200, 95.0);
    let text = cosmos("acceleration", "cm/sec2 (04)", "0.005000", &values)
        + &cosmos("velocity", "cm/sec (05)", "0.005000", &values);
    let loaded = base("CE1.V2c", &text, "").expect("read");
    assert!(rows(&loaded).iter().zip(&values).all(|(row, value)| (row[1] - 0.01 * value).abs() < 1e-7));
    assert!((rows(&loaded)[199][0] - 0.995).abs() < 1e-12);
    assert!(
        line(&loaded.case).contains("(COSMOS V2), acceleration in cm/s² as its head says, 200 rows, 0 to 0.995 s"),
        "{}",
        line(&loaded.case)
    );
    let loaded = load("CE1.V2c", &text, "[[base_motion]]\nvelocity = \"CE1.V2c\"").expect("read");
    assert!((rows(&loaded)[16][1] - 0.01 * values[16]).abs() < 1e-7);
    for (from, to, told) in [
        ("0.005000", "0.500000", "by which the record lasts 100 s, and it says approx 1 s"),
        ("0.005000", "-999.000", "has no time between values in its head; give it, such as `record = { dt = 0.01 }`"),
        ("units=cm/sec2 (04)", "units=counts (50)", "raw counts are not corrected records"),
        ("200 acceleration pts", "208 acceleration pts", "the file ends after 200 values of 208"),
    ] {
        let refused = refused(base("CE1.V2c", text.replace(from, to), ""));
        assert!(refused.contains(told), "{told}\n{refused}");
    }
    let unknown = text.replace("0.005000", "-999.000");
    let loaded = base("CE1.V2c", unknown, "record = { dt = 0.005 }").expect("read");
    assert!((rows(&loaded)[199][0] - 0.995).abs() < 1e-12);
    assert!(
        refused(load("CE1.V2c", text, "[[base_motion]]\ndisplacement = \"CE1.V2c\"")).contains("has no displacement")
    );
}

#[test]
fn spoilt_records_are_read_or_refused_and_never_panic() {
    let values = values(60, 90.0);
    let good = [
        peer("ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 60, DT= .01 SEC", &values),
        knet(&[8009; 100], "1"),
        esm("cm/s^2", "ACCELERATION", &values),
        channel(1, &values) + &channel(2, &values),
        cosmos("acceleration", "cm/sec2 (04)", "0.005000", &values),
        sine("Time (ms), Acc (g)\n", |_, t, a| format!("{t},{a}")),
    ];
    let mut random = Random::new(11);
    let mut below = |count: usize| random.below(count as u32) as usize;
    let mut read = 0;
    for round in 0..600 {
        let mut bytes = good[round % good.len()].clone().into_bytes();
        for _ in 0..below(4) {
            let at = below(bytes.len());
            match below(4) {
                0 => bytes.truncate(at.max(1)),
                1 => bytes[at] = b"0-9.,;(eE=:/\n \xff"[below(15)],
                2 => drop(bytes.drain(at..(at + 9).min(bytes.len()))),
                _ => bytes.insert(at, b"1-.e("[below(5)]),
            }
        }
        read += usize::from(base("r.csv", &bytes, "").is_ok());
    }
    assert!((100..600).contains(&read), "{read}");
}
