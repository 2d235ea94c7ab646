//! Every value of a case that cannot be used is refused in one line: file, line, key, what, value, limit, remedy.

use crate::support::{CASE, assert_refused, edited, error_of};
use enmm_io::{load_case, parse_case};
use std::path::Path;

#[test]
fn unknown_key_names_the_nearest_known_key() {
    assert_refused(
        "young = 5e10",
        "yung = 5e10",
        "LINE: rock.granite.yung: unknown key \"yung\", did you mean `young`? Known keys: blocks, cohesion, \
         density, dilation_deg, fracture, friction_deg, hoek_brown, plane, plane_of_weakness, poisson, region, \
         tension, young; rename or remove it",
    );
}

#[test]
fn unknown_section_names_the_nearest_known_section() {
    assert_refused(
        "[mesh]",
        "[mehs]",
        "LINE: mehs: unknown key \"mehs\", did you mean `mesh`? Known keys: base_motion, bolt, bolt_pattern, \
         bridge, cut, domain, drain, ensemble, fix, flow, fmu, fracture, free_field, gravity, head, in_situ, \
         initial_velocity, joint, joint_law, joint_monitor, joint_set, law_region, layers, line, load, mesh, monitor, \
         output, port, quiet, rain, random, random_correlation, report, rock, section, skin, solver, stage, \
         tessellation, \
         title, transform, water; rename or remove it",
    );
}

#[test]
fn unknown_key_is_found_at_any_depth() {
    let error = error_of(&edited("from = \"rough\"", "form = \"rough\""));
    assert!(error.contains("stage[1].switch_law[0].form: unknown key \"form\", did you mean `from`?"), "{error}");
    let error = error_of(&edited("y_reference = 5.0", "yreference = 5.0"));
    assert!(error.contains("in_situ.yreference: unknown key \"yreference\", did you mean `y_reference`?"), "{error}");
}

#[test]
fn wrong_type_says_expected_and_found() {
    let size = "size = 1.0";
    assert_refused(
        size,
        "size = \"1.0\"",
        "LINE: mesh.size: is the string \"1.0\", must be a number; write `size = 1.0`",
    );
    assert_refused(size, "size = true", "LINE: mesh.size: is the boolean true, must be a number; write `size = 1.0`");
    assert_refused(
        size,
        "size = 2026-01-01",
        "LINE: mesh.size: is the date 2026-01-01, must be a number; write `size = 1.0`",
    );
    assert_refused(
        "seed = 7",
        "seed = 7.5",
        "LINE: joint_set[0].seed: is the number 7.5, must be a whole number; write `seed = 1`",
    );
    assert_refused(
        "title = \"Two",
        "title = 3 # \"Two",
        "1: title: is the integer 3, must be a string; write `title = \"3\"`",
    );
    assert_refused(
        "[5.0, 0.0],",
        "[5.0, \"a\"],",
        "LINE: joint[1].points[0][1]: is the string \"a\", must be a number; write `1.0`",
    );
    assert_refused("[5.0, 0.0],", "[5.0],", "LINE: joint[1].points[0]: has 1 values, must have 2; write `[1.0, 1.0]`");
}

/// A key that may be of two types names both, and the words that a list may have.
#[test]
fn wrong_type_names_all_types_and_words() {
    let kinds = "model, deformed, history, energy, displacement, joints, joint_stress, stress, velocity, covers, \
                 displacement_contours, mean_stress_contours, strength, flow, lines, spectra";
    for (value, shown) in [("3", "the integer 3"), ("\"model\"", "the string \"model\"")] {
        assert_refused(
            "frame_interval = 0.5",
            &format!("pictures = {value}"),
            &format!(
                "LINE: output.pictures: is {shown}, must be true or false, or an array of some of the strings {kinds}; \
                 write `pictures = true`"
            ),
        );
    }
}

/// The remedy has the user's own value where it leaves no doubt.
#[test]
fn wrong_type_is_quoted_back_in_the_right_one() {
    let friction = "friction_deg = 35.0";
    for (to, shown, value) in
        [("\"35\"", "35", "35"), ("\"35,5\"", "35,5", "35.5"), ("\" 3.5e1 \"", " 3.5e1 ", "3.5e1")]
    {
        assert_refused(
            friction,
            &format!("friction_deg = {to}"),
            &format!(
                "LINE: joint_law.clean.friction_deg: is the string \"{shown}\", must be a number; write \
                 `friction_deg = {value}`"
            ),
        );
    }
    assert_refused(
        "seed = 7",
        "seed = 7.0",
        "LINE: joint_set[0].seed: is the number 7.0, must be a whole number; write `seed = 7`",
    );
}

/// A unit in the value is worked out, and a word that is like none of the known ones gets no guess.
#[test]
fn units_and_far_words_are_answered() {
    let young = "young = 5e10";
    for (to, remedy) in [("20 GPa", "20e9"), ("20GPa", "20e9"), ("350 MPa", "350e6"), ("1,5 kPa", "1.5e3")] {
        let message =
            format!("LINE: rock.granite.young: is the string {to:?}, must be a number; write `young = {remedy}`");
        assert_refused(young, &format!("young = {to:?}"), &message);
    }
    assert_refused(
        young,
        "young = \"20 bananas\"",
        "LINE: rock.granite.young: is the string \"20 bananas\", must be a number; write `young = 1e10`",
    );
    assert_refused(
        "kind = \"static\"",
        "kind = \"quick\"",
        "LINE: stage[0].kind: is \"quick\", must be one of static, dynamic",
    );
    let error = error_of(&edited("[[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]", "[[0, 0], [5, 5], [10, 10]]"));
    assert_eq!(
        error,
        "slope.toml:4: domain.outline: its 3 points lie on one line, a loop has an area; add a point beside it"
    );
}

#[test]
fn slips_of_the_hand_are_found_where_they_are() {
    assert_refused("friction_deg = 35.0", "friction_deg = 35,0", "LINE: the number 35,0 has a comma; write 35.0");
    assert_refused(
        "outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]",
        "outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]",
        "LINE: `[` is not closed before line 5; add `]`",
    );
}

#[test]
fn wrong_brackets_of_a_section_say_which_to_write() {
    assert_refused(
        "[[monitor]]",
        "[monitor]",
        "LINE: monitor: is a table of 2 keys, must be an array of tables; write `[[monitor]]` with `name = \"name\", \
         point = [1.0, 1.0]`",
    );
    assert_refused(
        "[gravity]",
        "[[gravity]]",
        "LINE: gravity: is an array of 1 values, must be a table; write `[gravity]`",
    );
    assert_refused(
        "[rock.granite]",
        "[rock]",
        "36: rock.density: is the integer 2650, must be a table; write `[rock.NAME]` with `density = 2700.0, young = \
         1e10, poisson = 0.25`",
    );
}

#[test]
fn integer_is_a_number() {
    let integer = parse_case(&edited("size = 1.0", "size = 1"), "slope.toml", Path::new("")).unwrap();
    assert_eq!(integer.case, parse_case(CASE, "slope.toml", Path::new("")).unwrap().case);
}

#[test]
fn choice_names_the_nearest_choice() {
    assert_refused(
        "kind = \"static\"",
        "kind = \"statc\"",
        "LINE: stage[0].kind: is \"statc\", did you mean \"static\"? It must be one of static, dynamic",
    );
}

#[test]
fn missing_key_says_what_to_add() {
    assert_refused(
        "[mesh]\nsize = 1.0\n",
        "[mesh]\n",
        "LINE: mesh.size: is missing (Side of a triangle (m)); add `size = 1.0`",
    );
    assert_refused(
        "pressure = 1e4\n",
        "",
        "81: load[1]: a load of kind pressure needs `pressure`, which is not given; add `pressure`",
    );
}

#[test]
fn missing_section_says_what_to_add() {
    for (section, message) in [
        (
            "mesh",
            "1: mesh: is missing (The regular triangular mesh of mathematical covers); add `[mesh]` with `size = 1.0`",
        ),
        (
            "rock",
            "1: rock: is missing (Rocks by name); add `[rock.NAME]` with `density = 2700.0, young = 1e10, \
             poisson = 0.25`",
        ),
        ("stage", "1: stage: is missing (Stages in order); add `[[stage]]` with `name = \"name\", kind = \"static\"`"),
        ("domain", "1: domain: is missing (Rock outline and joint traces from files); add `[domain]`"),
    ] {
        let mut table: toml::Table = CASE.parse().unwrap();
        table.remove(section);
        assert_eq!(error_of(&table.to_string()), format!("slope.toml:{message}"));
    }
}

#[test]
fn number_that_is_not_finite_is_refused() {
    for (text, shown) in [("nan", "nan"), ("inf", "inf"), ("-inf", "-inf"), ("1e400", "1e400")] {
        let message = format!("LINE: mesh.size: is {shown}, must be a finite number of at most 1.8e308; correct it");
        assert_refused("size = 1.0", &format!("size = {text}"), &message);
    }
}

#[test]
fn strength_out_of_range_says_value_and_limit() {
    for (from, to, message) in [
        (
            "poisson = 0.25",
            "poisson = 0.5",
            "rock.granite.poisson: is 0.5, must be greater than -1 and less than 0.5; rock has 0.1 to 0.4",
        ),
        (
            "young = 5e10",
            "young = 0",
            "rock.granite.young: is 0 Pa, must be at least 1 and at most 1e15; rock masses have 1e9 to 1e11 Pa",
        ),
        (
            "friction_deg = 35.0",
            "friction_deg = 90",
            "joint_law.clean.friction_deg: is 90 degrees, must be at least 0 and less than 90; rock joints have 15 \
             to 50",
        ),
        (
            "tension = 1e3",
            "tension = -1e3",
            "joint_law.rough.tension: is -1000 Pa, must be at least 0 and at most 1e12; the tensile strength is \
             written positive",
        ),
    ] {
        assert_refused(from, to, &format!("LINE: {message}"));
    }
}

#[test]
fn poisson_ratio_of_one_half_needs_plane_stress() {
    let marl = "poisson = 0.3\nplane = \"stress\"";
    assert!(parse_case(&edited(marl, "poisson = 0.5\nplane = \"stress\""), "slope.toml", Path::new("")).is_ok());
    assert!(error_of(&edited(marl, "poisson = 0.5")).contains("rock.marl.poisson: is 0.5, must be"));
}

#[test]
fn solver_value_out_of_range_says_value_and_limit() {
    for (from, to, message) in [
        (
            "dt_safety = 0.8",
            "dt_safety = 1.1",
            "solver.dt_safety: is 1.1, must be greater than 0 and at most 1; 0.9 is the default",
        ),
        (
            "sweeps_max = 12",
            "sweeps_max = 0",
            "solver.sweeps_max: is 0, must be at least 1 and at most 1000; 100 is the default",
        ),
        (
            "sweeps_max = 12",
            "sweeps_max = -1",
            "solver.sweeps_max: is -1, must be at least 0 and at most 4294967295; correct it",
        ),
        (
            "memory_limit = 1000000000",
            "memory_limit = 0",
            "solver.memory_limit: is 0 bytes, must be at least 1 and at most 18446744073709551615; 8589934592 (8 GiB) \
             is the default",
        ),
    ] {
        assert_refused(from, to, &format!("LINE: {message}"));
    }
}

#[test]
fn time_or_place_out_of_range_says_value_and_limit() {
    for (from, to, message) in [
        (
            "duration = 5.0",
            "duration = 0",
            "stage[1].duration: is missing or 0 s, must be greater than 0 and at most 1e9; add `duration = 5.0`, the \
             simulated time of the stage",
        ),
        (
            "ramp = 1.0",
            "ramp = 11.0",
            "stage[0].ramp: is 11 s, must be at least 0 and at most 10; it ends within the stage's duration",
        ),
        (
            "[5.0, 0.0],",
            "[5.0, 2e9],",
            "joint[1].points[0]: y is 2e9 m, must be a finite number of at most 1e9 m in magnitude; correct it or \
             move the origin",
        ),
    ] {
        assert_refused(from, to, &format!("LINE: {message}"));
    }
}

#[test]
fn reference_that_does_not_exist_names_the_nearest_name() {
    let laws = "Known: clean, rough; or add [joint_law.NAME]";
    for (from, to, key) in [
        ("joint_law = \"clean\"", "joint_law = \"cleen\"", "domain.joint_law"),
        ("[[stage.law]]\nlaw = \"clean\"", "[[stage.law]]\nlaw = \"cleen\"", "stage[1].law[0].law"),
        ("to = \"clean\"", "to = \"cleen\"", "stage[1].switch_law[0].to"),
    ] {
        let error = error_of(&edited(from, to));
        let message = format!("{key}: no joint law is named \"cleen\", did you mean \"clean\"? {laws}");
        assert!(error.ends_with(&message), "{error}");
    }
    assert_refused(
        "law = \"rough\"",
        "law = \"ruogh\"",
        &format!("LINE: joint[1].law: no joint law is named \"ruogh\", did you mean \"rough\"? {laws}"),
    );
    assert_refused(
        "free = [\"wedge\"]",
        "free = [\"wegde\"]",
        "LINE: stage[1].free[0]: no fixity is named \"wegde\", did you mean \"wedge\"? Known: base, wedge; or add \
         [[fix]] \
         with this `name`",
    );
}

#[test]
fn joint_without_a_law_is_refused_unless_there_is_one_default() {
    assert_refused(
        "joint_law = \"clean\"\n",
        "",
        "3: domain.joint_law: is missing, joint[0] names no law and there are several (clean, rough); add \
         `joint_law` or \
         the name",
    );
    let mut table: toml::Table = CASE.parse().unwrap();
    table.remove("joint_law");
    table["domain"].as_table_mut().unwrap().remove("joint_law");
    table["joint"].as_array_mut().unwrap().truncate(1);
    let error = error_of(&table.to_string());
    let message = "slope.toml:1: joint_law: joint[0] needs a joint law, but there is none; add `[joint_law.NAME]` with \
                   `friction_deg = 30.0`";
    assert_eq!(error, message);
}

#[test]
fn only_law_is_the_default() {
    let mut case = parse_case(CASE, "slope.toml", Path::new("")).unwrap().case;
    assert_eq!(case.default_joint_law(), Some("clean"));
    case.domain.joint_law = None;
    assert_eq!(case.default_joint_law(), None);
    case.joint_laws.retain(|name, _| name == "rough");
    assert_eq!(case.default_joint_law(), Some("rough"));
}

#[test]
fn fixity_has_exactly_one_place() {
    let place = "box = [0.0, 0.0, 1.0, 5.0]\n";
    let limit = "must have exactly 1 of point, edge, box, block; keep or add one";
    let line = 1 + CASE[..CASE.find("[[fix]]\nname = \"wedge\"").unwrap()].matches('\n').count();
    assert_refused(place, "", &format!("{line}: fix[1]: has 0 places (none), {limit}"));
    assert_refused(
        place,
        &format!("{place}block = [1.0, 1.0]\n"),
        &format!("{line}: fix[1]: has 2 places (box, block), {limit}"),
    );
    assert_refused(
        place,
        "box = [1.0, 0.0, 1.0, 5.0]\n",
        "LINE: fix[1].box: xmin is 1 m, must be less than xmax, which is 1 m; the order is [xmin, ymin, xmax, ymax]",
    );
}

#[test]
fn values_that_would_have_no_effect_are_refused() {
    for (from, to, message) in [
        (
            "pressure = 1e4\n",
            "pressure = 1e4\nforce = [0.0, 1.0]\n",
            "load[1].force: a load of kind pressure has edge, pressure, not `force`; remove it",
        ),
        (
            "damping = 0.05",
            "ramp = 0.05",
            "stage[1].ramp: is 0.05, but only static stages have it and this one is dynamic; remove it",
        ),
        (
            "ramp = 1.0",
            "damping = 0.05",
            "stage[0].damping: is 0.05, but only dynamic stages have it and this one is static; remove it",
        ),
        (
            "axes = \"x\"",
            "stiffness = 1e9",
            "fix[1].stiffness: `box` is held without springs; remove `stiffness`, or hold `point` or `edge`",
        ),
        (
            "point = [3.0, 3.0]\n",
            "point = [3.0, 3.0]\nactive = false\n",
            "fix[2].active: is false, and without a name no stage can activate the fixity; add `name` or remove \
             `active`",
        ),
        (
            "trace_length = 4.0\n",
            "",
            "joint_set[0].trace_length_sd: is 1 m, but joints without `trace_length` do not end; add `trace_length`",
        ),
        (
            "free = [\"wedge\"]",
            "free = [\"wedge\"]\nfix = [\"wedge\"]",
            "stage[1].free[0]: \"wedge\" is also in `fix` of this stage, it can be in one only; remove it from the \
             other",
        ),
        (
            "to = \"clean\"",
            "to = \"rough\"",
            "stage[1].switch_law[0].to: is \"rough\", the law to replace; name another law or remove it",
        ),
        (
            "friction_deg = 20.0\ncohesion = 0.0\ntension = 0.0\n",
            "",
            "stage[1].law[0]: changes nothing; give `friction_deg`, `cohesion` or `tension`, or remove it",
        ),
    ] {
        let error = error_of(&edited(from, to));
        assert!(error.ends_with(&format!(": {message}")), "{error}");
    }
}

#[test]
fn table_needs_rows_whose_times_increase() {
    let table = "table = [[0.0, 0.0], [1.0, 1.0]]";
    assert_refused(
        table,
        "table = []",
        "LINE: load[0].table: has no rows, at least 1 is needed; add `[time, factor]` or leave the table out",
    );
    assert_refused(
        table,
        "table = [[0.5, 0.0], [0.5, 1.0]]",
        "LINE: load[0].table[1]: time is 0.5 s, must be greater than 0.5 s of the row before; sort the rows by time",
    );
}

#[test]
fn names_are_unique_and_not_empty() {
    assert_refused(
        "name = \"slide\"",
        "name = \"settle\"",
        "LINE: stage[1].name: \"settle\" is already the name of stage[0], names must differ; rename one",
    );
    assert_refused(
        "name = \"crest\"",
        "name = \" \"",
        "LINE: monitor[0].name: is \" \", a monitor needs at least one letter; give it a name",
    );
}

#[test]
fn at_most_one_rock_is_the_background() {
    assert_refused(
        "region = [[0.0, 0.0], [10.0, 0.0], [10.0, 2.0]]\nblocks = [[9.0, 1.0]]\n",
        "",
        "40: rock.marl: neither this rock nor rock \"granite\" has `region` or `blocks`, at most 1 rock can be the \
         background; add `region` or `blocks` to one of them",
    );
}

#[test]
fn degenerate_shapes_are_refused() {
    assert_refused(
        "outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]\n",
        "",
        "3: domain.outline: there is no outline; give `outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]` or a \
         `geometry_file` with one",
    );
    assert_refused(
        "outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]",
        "outline = [[0.0, 0.0], [10.0, 0.0]]",
        "LINE: domain.outline: has 2 points, a loop needs at least 3; add points or remove it",
    );
    assert_refused(
        "points = [[0.0, 2.0], [10.0, 3.0]]",
        "points = [[0.0, 2.0]]",
        "LINE: joint[0].points: has 1 points, a joint trace needs at least 2; add points or remove it",
    );
    assert_refused(
        "region = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]]",
        "region = [[0.0, 0.0], [10.0, 10.0], [5.0, 5.0]]",
        "LINE: joint_set[0].region: its 3 points lie on one line, a loop has an area; add a point beside it",
    );
    assert_refused(
        "edge = [[0.0, 0.0], [10.0, 0.0]]",
        "edge = [[0.0, 0.0], [0.0, 0.0]]",
        "LINE: fix[0].edge: both ends are [0.0, 0.0], a segment needs two different points; move one",
    );
}

#[test]
fn text_that_is_not_toml_names_the_line() {
    assert_refused("size = 1.0", "size = = 1.0", "LINE: not TOML: extra `=`, expected nothing; correct the line");
    assert_refused("[gravity]", "[mesh]", "LINE: not TOML: `mesh` stands twice in its table; remove one");
}

#[test]
fn file_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none.toml");
    let error = load_case(&path).unwrap_err().to_string();
    let reason = "cannot read the file (No such file or directory (os error 2)); check its path and permissions";
    assert_eq!(error, format!("{}: {reason}", path.display()));
    std::fs::write(&path, b"title = \"\xff\"").unwrap();
    let error = load_case(&path).unwrap_err().to_string();
    let reason = "byte 9 is not UTF-8 text, which input files must be; save the file as UTF-8 text";
    assert_eq!(error, format!("{}: {reason}", path.display()));
    assert!(load_case(folder.path()).unwrap_err().to_string().contains("cannot read the file"));
}

#[test]
fn error_of_the_builder_is_located_at_the_longest_known_key() {
    let source = parse_case(CASE, "slope.toml", Path::new("")).unwrap().source;
    let line = |part: &str| 1 + CASE[..CASE.find(part).unwrap()].matches('\n').count();
    for (key, part) in [
        ("domain.outline", "outline ="),
        ("domain.holes[0]", "holes ="),
        ("joint[1].points", "points = [\n"),
        ("joint[1].points[1]", "    [5.0, 5.0]"),
        ("joint[1]", "[[joint]]\npoints = [\n"),
        ("fix[0].point", "[[fix]]"),
        ("rock.granite.unknown", "[rock.granite]"),
        ("solver.integrator", "[solver]"),
        ("foundation.depth", "title"),
    ] {
        let expected = format!("slope.toml:{}: {key}: crosses itself", line(part));
        assert_eq!(source.locate(key, "crosses itself").to_string(), expected);
    }
}

/// Strengths of Hoek and Brown: ranges, and what does not go together.
#[test]
fn hoek_brown_says_its_limits_and_what_excludes_it() {
    let mass = "sigma_ci = 50e6, mi = 10.0, gsi = 45.0, d = 0.7, associated = true }";
    for (from, to, key, message) in [
        ("sigma_ci = 50e6", "sigma_ci = 50", "hoek_brown.sigma_ci", "is 50 Pa, must be at least 10000 and at most"),
        ("gsi = 45.0, ", "", "hoek_brown", "gsi"),
        (mass, &format!("{mass}\ncohesion = 1e5"), "cohesion", "is 100000 beside hoek_brown, at most one of both"),
        (mass, &format!("{mass}\nfriction_deg = 30"), "friction_deg", "is 30 beside hoek_brown"),
        (mass, &format!("{mass}\nplane = \"stress\""), "plane", "hoek_brown needs plane strain"),
        (mass, &format!("{mass}\ndilation_deg = 5"), "dilation_deg", "has no effect beside hoek_brown.associated"),
        (mass, &format!("{mass}\ntension = 9e9"), "tension", "the Hoek–Brown surface ends at s·sigma_ci/mb"),
    ] {
        let error = error_of(&edited(from, to));
        assert!(error.contains(&format!("rock.mass.{key}")) && error.contains(message), "{to}: {error}");
    }
    let error =
        error_of(&edited("young = 1e9\npoisson = 0.3\nplane", "young = 1e9\ntension = 1e5\npoisson = 0.3\nplane"));
    assert!(error.contains("add friction_deg, cohesion or hoek_brown, or remove it"), "{error}");
}

/// Planes of weakness: what they need, their strengths, and their direction in one way.
#[test]
fn planes_of_weakness_say_their_limits() {
    let young = "young = 5e10";
    let table = |keys: &str| format!("{young}\ncohesion = 1e6\nplane_of_weakness = {{ {keys} }}");
    let cases = [
        (format!("{young}\nplane_of_weakness = {{ angle_deg = 30, friction_deg = 20 }}"), "rock that never yields"),
        (table("friction_deg = 20"), "has no direction; add `angle_deg`"),
        (table("angle_deg = 30, dip_deg = 30, friction_deg = 20"), "keep one of them"),
        (table("dip_deg = 30, friction_deg = 20"), "its side is missing"),
        (table("angle_deg = 30, dips = \"left\", friction_deg = 20"), "belongs to `dip_deg`"),
        (table("angle_deg = 30, friction_deg = 0"), "has friction_deg 0 and cohesion 0"),
        (table("angle_deg = 30, friction_deg = 20, dilation_deg = 25"), "at least 0 and at most 20"),
        (table("angle_deg = 30, friction_deg = 45, cohesion = 1e5, tension = 2e5"), "ends at cohesion/tan(friction"),
        (table("angle_deg = 30, friction_deg = 90"), "less than 90"),
    ];
    for (to, message) in cases {
        let error = error_of(&edited(young, &to));
        assert!(error.contains("plane_of_weakness") && error.contains(message), "{to}: {error}");
    }
}

/// Skins: what they need, and what does not go together.
#[test]
fn skins_say_their_limits() {
    let skin = |keys: &str| format!("[[skin]]\nthickness = 0.1\nyoung = 15e9\n{keys}\n[mesh]");
    for (keys, message) in [
        ("line = [[0, 0]]", "skin[0].line: has 1 points, must have at least 2"),
        ("line = [[0, 0], [0, 0]]", "skin[0].line[1]: is the same as the point before"),
        ("line = [[0, 0], [1, 0]]\nactive = false", "skin[0].active: is false, and without a name"),
        ("line = [[0, 0], [1, 0]]\ntension = 3e6\nrupture_strain = 1e-5", "skin[0].rupture_strain: is 1e-5"),
        ("line = [[0, 0], [9, 0]]\ndistance = 1e-9", "skin[0].distance: gives 10001 points"),
        ("line = [[0, 0], [1, 0]]\ntension = -1", "skin[0].tension: is -1 Pa"),
    ] {
        let error = error_of(&edited("[mesh]", &skin(keys)));
        assert!(error.contains(message), "{keys}: {error}");
    }
}
