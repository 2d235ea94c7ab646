//! Claim: monitors of stress, monitors of joints and lines read what closed forms say, and count from the end of the
//! stage that a case names.

use enmm::cosimulation::{Cosimulation, Named};
use enmm::model::Simulation;

use crate::common::{case, refusal, run_all, run_stage, simulation, step, through_bytes};

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 2600.0;

/// Relative to the size of the exact value, or absolute where that is given.
fn is_near(found: f64, exact: f64, tolerance: f64) -> bool {
    (found - exact).abs() <= tolerance
}

/// A column of 2 m by 10 m on rollers, with monitors of stress on its axis and at its foot.
fn column(size: f64) -> String {
    let monitors: String = [0.0, 0.3, 2.0, 5.0, 8.0, 9.9]
        .iter()
        .enumerate()
        .map(|(k, y)| format!("[[monitor]]\nname = \"m{k}\"\npoint = [0.9, {y}]\nstress = true\n"))
        .collect();
    format!(
        "title = \"column\"\n[domain]\noutline = [[0, 0], [2, 0], [2, 10], [0, 10]]\n[mesh]\nsize = {size}\n\
         angle_deg = 7\norigin = [0.0137, 0.0071]\n[rock.rock]\ndensity = {DENSITY}\nyoung = 1e9\npoisson = 0.2\n\
         [[fix]]\nedge = [[0, 0], [2, 0]]\naxes = \"y\"\n[[fix]]\npoint = [1.0, 0.0]\naxes = \"x\"\n{monitors}\
         [[stage]]\n\
         name = \"gravity\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-8\n"
    )
}

/// Stress at depth is the weight above, and the sides are free. Elements have one stress each, which is off by up to
/// half of the weight of a mesh size; the plane through those about a point is nearer by twenty times: 0.1 % of the
/// weight of the column. Next to the foot, whose rollers push at points, 1 % is left of them.
#[test]
fn stress_in_a_column_is_the_weight_above() {
    let whole = DENSITY * GRAVITY * 10.0;
    for size in [0.4, 0.2] {
        let mut column = simulation(&column(size));
        let report = run_stage(&mut column);
        assert!(column.at_rest(&report), "{report:?}");
        for (k, y) in [0.0, 0.3, 2.0, 5.0, 8.0, 9.9].into_iter().enumerate() {
            let found = column.monitor_stress(k).unwrap();
            let exact = [0.0, -DENSITY * GRAVITY * (10.0 - y), 0.0];
            let most = whole * if (1.0..9.0).contains(&y) { 1e-3 } else { 0.01 };
            println!("size {size}, y {y}: {found:?}, exact {exact:?}");
            assert!((0..3).all(|part| is_near(found[part], exact[part], most)), "{found:?}, exact {exact:?}");
        }
    }
}

/// A square with an inclined joint, held all round, under a stress that does not vary.
fn stressed([sxx, syy, sxy]: [f64; 3], gauge: &str) -> String {
    let edges = ["[[0, 0], [4, 0]]", "[[4, 0], [4, 4]]", "[[4, 4], [0, 4]]", "[[0, 4], [0, 0]]"];
    let fixes: String = edges.iter().map(|e| format!("[[fix]]\nedge = {e}\n")).collect();
    format!(
        "title = \"stressed\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 4], [0, 4]]\n[mesh]\nsize = 0.5\n\
         angle_deg = 9\n[[joint]]\npoints = [[-1, 1], [5, 2.5]]\n[rock.rock]\ndensity = 2600\nyoung = 1e9\n\
         poisson = 0.25\n[joint_law.joint]\nfriction_deg = 60\n[gravity]\ny = 0\n[in_situ]\nsxx = {sxx:e}\n\
         syy = {syy:e}\nsxy = {sxy:e}\n{fixes}[[stage]]\nname = \"still\"\nkind = \"static\"\nduration = 1.0\n\
         [[stage]]\nname = \"dig\"\nkind = \"dynamic\"\nduration = 0.01\nexcavate = [[2, 3.5]]\n\
         [[monitor]]\nname = \"rock\"\npoint = [1.1, 2.9]\nstress = true\n[[monitor]]\nname = \"corner\"\n\
         point = [0, 4]\nstress = true\n[[line]]\nname = \"hole\"\nfrom = [2, 3.9]\nto = [2, 0.1]\npoints = 20\n{gauge}"
    )
}

/// A gauge on the joint of [`stressed`].
const GAUGE: &str = "[[joint_monitor]]\nname = \"gauge\"\npoint = [2.0, 1.8]\n";

/// Before the first step the rock has the stress that the case gives, to round-off, and the joint has its traction on
/// the plane: σn = n·σ·n and τ = t·σ·n with t to the right of n, seen across the joint.
#[test]
fn uniform_stress_is_read_in_rock_and_on_a_joint() {
    let (sine, cosine) = {
        let length = 6.0_f64.hypot(1.5);
        (1.5 / length, 6.0 / length)
    };
    for stress @ [xx, yy, xy] in [[-1e6, -2e6, 0.0], [-1.5e6, -1e6, 2e5], [-1.2e6, -1.2e6, -4e5]] {
        let before = simulation(&stressed(stress, GAUGE));
        for k in 0..2 {
            let found = before.monitor_stress(k).unwrap();
            assert!((0..3).all(|part| is_near(found[part], stress[part], 1e-6 * 1e6)), "{found:?}, not {stress:?}");
        }
        // Out of the lower block, and to the right of that.
        let (n, t) = ([-sine, cosine], [cosine, sine]);
        let traction = [xx * n[0] + xy * n[1], xy * n[0] + yy * n[1]];
        let exact = [traction[0] * n[0] + traction[1] * n[1], traction[0] * t[0] + traction[1] * t[1]];
        let gauge = before.joint_monitors()[0];
        println!("{stress:?}: {gauge:?}, exact {exact:?}");
        assert!(is_near(gauge.normal_stress, exact[0], 1e-6 * 1e6), "{gauge:?}, exact {exact:?}");
        assert!(is_near(gauge.shear_stress, exact[1], 1e-6 * 1e6), "{gauge:?}, exact {exact:?}");
        assert_eq!([gauge.opening, gauge.slip], [0.0; 2]);
    }
}

/// Where rock has been excavated there is no value, and in the rock that stays there is; the motion of the point alone
/// stays that of the last instant.
#[test]
fn excavated_rock_has_no_stress_and_its_joint_no_opening() {
    let mut dug = simulation(&stressed([-1e6, -2e6, 0.0], GAUGE));
    run_stage(&mut dug);
    let before = dug.joint_monitors()[0];
    assert!(before.normal_stress < -1e6 && before.opening.abs() < 1e-4, "{before:?}");
    assert!(dug.next_stage().unwrap_or_else(|e| panic!("{e}")));
    let gone = dug.joint_monitors()[0];
    let all = [gone.opening, gone.slip, gone.normal_stress, gone.shear_stress];
    assert!(all.iter().all(|number| number.is_nan()), "{gone:?}");
    assert!(dug.monitor_stress(0).unwrap().iter().all(|part| part.is_nan()));
    let line = dug.line(0);
    let is_upper = |y: f64| y > 1.0 + 0.25 * 3.0;
    for point in &line {
        let is_gone = is_upper(point.place.y);
        assert_eq!([point.displacement.x.is_nan(), point.stress[0].is_nan()], [is_gone; 2], "{point:?}");
    }
    assert!(line.iter().any(|point| is_upper(point.place.y)) && line.iter().any(|point| !is_upper(point.place.y)));
}

/// A block of 2 m by 1 m on a plane that dips by 30° to the right. `friction` (degrees) holds it or not.
fn incline(friction: f64, more: &str) -> String {
    let (sine, cosine) = (0.5, 0.75_f64.sqrt());
    let place = |along: f64, above: f64| [along * cosine + above * sine, -along * sine + above * cosine];
    let outline = [place(0.0, 0.0), place(30.0, 0.0), place(30.0, -2.0), place(0.0, -2.0)];
    let block = [place(2.0, 0.0), place(4.0, 0.0), place(4.0, 1.0), place(2.0, 1.0)];
    let middle = place(3.0, 0.5);
    let gauge = place(2.7, 0.05);
    format!(
        "title = \"incline\"\n[domain]\noutline = {outline:?}\nislands = [{block:?}]\n[mesh]\nsize = 0.5\n\
         angle_deg = 11\n[rock.rock]\ndensity = {DENSITY}\nyoung = 1e10\npoisson = 0.2\n[joint_law.joint]\n\
         friction_deg = {friction}\n[[fix]]\nedge = [{:?}, {:?}]\n[[monitor]]\nname = \"block\"\npoint = {middle:?}\n\
         [[joint_monitor]]\nname = \"base\"\npoint = {gauge:?}\n{more}",
        outline[2], outline[3]
    )
}

/// The base of a block at rest on a plane has its weight over its length: σn = −W cos β/L, τ = W sin β/L to the right;
/// no slip beyond what springs give.
#[test]
fn the_base_of_a_block_at_rest_bears_its_weight() {
    let stage = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n";
    let mut resting = simulation(&incline(45.0, stage));
    let report = run_stage(&mut resting);
    assert!(resting.at_rest(&report), "{report:?}");
    let weight = DENSITY * GRAVITY * 2.0;
    let exact = [-weight * 0.75_f64.sqrt() / 2.0, weight * 0.5 / 2.0];
    let base = resting.joint_monitors()[0];
    println!("{base:?}, exact {exact:?}");
    assert!(is_near(base.normal_stress, exact[0], 1e-4 * exact[0].abs()), "{base:?}, exact {exact:?}");
    assert!(is_near(base.shear_stress, exact[1], 1e-4 * exact[0].abs()), "{base:?}, exact {exact:?}");
    assert!(base.slip.abs() < 1e-5 && base.opening.abs() < 1e-5, "{base:?}");
}

/// A block that slides by 0.4 m: the slip is its displacement, down the plane to the right; it neither opens nor sinks
/// in; shear stress is friction times normal stress, and that is W cos β/L.
#[test]
fn a_sliding_block_slips_by_its_displacement() {
    let stage = "[[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = 0.6\ndamping = 0.02\n";
    let mut sliding = simulation(&incline(20.0, stage));
    run_stage(&mut sliding);
    let (base, moved) = (sliding.joint_monitors()[0], sliding.monitor(0).0);
    let weight = DENSITY * GRAVITY * 2.0;
    let normal = -weight * 0.75_f64.sqrt() / 2.0;
    println!("{base:?}, moved {moved:?} {}, normal {normal}", moved.norm());
    assert!(moved.norm() > 0.2, "{moved:?}");
    assert!(is_near(base.slip, moved.norm(), 1e-3 * moved.norm()), "{base:?}, {moved:?}");
    assert!(base.opening.abs() < 1e-4, "{base:?}");
    assert!(is_near(base.normal_stress, normal, 0.02 * normal.abs()), "{base:?}, exact {normal}");
    let friction = base.shear_stress / -base.normal_stress;
    assert!(is_near(friction, 20.0_f64.to_radians().tan(), 2e-3), "{friction}");
}

/// A block that leaves its base: it opens by what it rises, without stress.
#[test]
fn a_block_that_leaves_has_an_opening_and_no_stress() {
    let stage = "[gravity]\ny = 0\n[[initial_velocity]]\nblock = [3.0, -1.0]\nvelocity = [0.5, 0.8660254037844386]\n\
                 [[stage]]\nname = \"leave\"\nkind = \"dynamic\"\nduration = 0.5\ndamping = 0\n";
    let mut leaving = simulation(&incline(20.0, stage));
    run_stage(&mut leaving);
    let (base, moved) = (leaving.joint_monitors()[0], leaving.monitor(0).0);
    println!("{base:?}, {moved:?}");
    assert!(is_near(base.opening, moved.norm(), 1e-3) && moved.norm() > 0.4, "{base:?}, {moved:?}");
    assert!(base.slip.abs() < 1e-3 && [base.normal_stress, base.shear_stress] == [0.0; 2], "{base:?}");
}

/// Shear stress (Pa) of [`sheared`].
const SHEAR: f64 = 200.0;

/// A block of 3 m by 6 m under shear tractions all round, held at two points without a force: u = (τ/G)·y to the right.
fn sheared() -> String {
    format!(
        "title = \"shear\"\n[domain]\noutline = [[0, 0], [3, 0], [3, 6], [0, 6]]\n[mesh]\nsize = 0.7\nangle_deg = 5\n\
         [rock.rock]\ndensity = {DENSITY}\nyoung = 1e9\npoisson = 0.25\n[gravity]\ny = 0\n[[fix]]\n\
         point = [0, 0]\n[[fix]]\npoint = [3, 0]\naxes = \"y\"\n[[load]]\nkind = \"traction\"\n\
         edge = [[0, 0], [3, 0]]\ntraction = [-{SHEAR}, 0]\n[[load]]\nkind = \"traction\"\n\
         edge = [[0, 6], [3, 6]]\ntraction = [{SHEAR}, 0]\n\
         [[load]]\nkind = \"traction\"\n\
         edge = [[3, 0], [3, 6]]\ntraction = [0, {SHEAR}]\n[[load]]\nkind = \"traction\"\n\
         edge = [[0, 0], [0, 6]]\ntraction = [0, -{SHEAR}]\n[[line]]\nname = \"hole\"\nfrom = [1.5, 6]\nto = [1.5, 0]\n\
         points = 13\n[[stage]]\nname = \"shear\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-9\n"
    )
}

/// A line in simple shear is a straight line: nothing along it, γy across it. The load is so small that the turn of the
/// rock by γ/2, which its stress follows, is below the tolerance.
#[test]
fn a_line_in_simple_shear_is_straight() {
    let mut block = simulation(&sheared());
    let report = run_stage(&mut block);
    assert!(block.at_rest(&report), "{report:?}");
    let shear = SHEAR / (1e9 / (2.0 * 1.25));
    let line = block.line(0);
    assert_eq!(line.len(), 13);
    for (k, point) in line.iter().enumerate() {
        assert_eq!([point.place.x, point.place.y], [1.5, 6.0 - 0.5 * k as f64]);
        let most = 1e-5 * shear * 6.0;
        let exact = shear * point.place.y;
        assert!(is_near(point.displacement.x, exact, most), "{point:?}, exact {exact}");
        assert!(is_near(point.displacement.y, 0.0, most), "{point:?}");
        assert!((0..3).all(|part| is_near(point.stress[part], [0.0, 0.0, SHEAR][part], 1e-5 * SHEAR)), "{point:?}");
    }
}

/// Three blocks on each other that settle under gravity; then the upper one is dug away.
fn relieved(since: &str, stages: usize) -> String {
    let changes = [("gravity", ""), ("dig", "excavate = [[1, 5]]\n"), ("more", "")];
    let stage = |k: usize| {
        let (name, change) = changes[k];
        format!("[[stage]]\nname = {name:?}\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n{change}")
    };
    let stages: String = (0..stages).map(stage).collect();
    format!(
        "title = \"relieved\"\n[domain]\noutline = [[0, 0], [2, 0], [2, 6], [0, 6]]\n[mesh]\nsize = 0.6\n\
         angle_deg = 3\n[[joint]]\npoints = [[-1, 2], [3, 2]]\n[[joint]]\npoints = [[-1, 4], [3, 4]]\n[rock.rock]\n\
         density = {DENSITY}\nyoung = 1e8\npoisson = 0.2\n[joint_law.joint]\nfriction_deg = 35\n[[fix]]\n\
         edge = [[0, 0], [2, 0]]\n[[monitor]]\nname = \"top\"\npoint = [1, 3.9]\n[[joint_monitor]]\n\
         name = \"joint\"\npoint = [1, 2]\n[[line]]\nname = \"axis\"\nfrom = [1, 0]\nto = [1, 3.9]\n{since}{stages}"
    )
}

/// Displacement of top and line, opening and slip of the joint, and its stress.
fn shown(simulation: &Simulation) -> [f64; 6] {
    let joint = simulation.joint_monitors()[0];
    let end = simulation.line(0)[20].displacement.y;
    [simulation.monitor(0).0.y, end, joint.opening, joint.slip, joint.normal_stress, joint.shear_stress]
}

/// Displacements count from the end of the stage that the case names: until then from the start, and then less by those
/// of its end; stresses stay what they are. A saved state keeps from when they count.
#[test]
fn displacements_count_from_the_end_of_a_stage() {
    let since = "[output]\nsince = \"gravity\"\n";
    let [mut plain, mut counted] = ["", since].map(|since| simulation(&relieved(since, 3)));
    run_stage(&mut plain);
    run_stage(&mut counted);
    let before = shown(&plain);
    assert_eq!(before.map(f64::to_bits), shown(&counted).map(f64::to_bits));
    assert!(before[0] < -1e-3, "{before:?}");
    for stage in ["dig", "more"] {
        for simulation in [&mut plain, &mut counted] {
            assert!(simulation.next_stage().unwrap_or_else(|e| panic!("{e}")), "{stage}");
        }
        if stage == "dig" {
            let now = shown(&counted);
            assert_eq!(now[..4], [0.0; 4], "{now:?}");
        }
        step(&mut plain, 7);
        step(&mut counted, 7);
        let mut resumed = through_bytes(&counted, &relieved(since, 3));
        for simulation in [&mut plain, &mut counted, &mut resumed] {
            run_stage(simulation);
        }
        let [all, part] = [&plain, &counted].map(shown);
        assert_eq!(part.map(f64::to_bits), shown(&resumed).map(f64::to_bits), "{stage}");
        for k in 0..4 {
            assert!(is_near(part[k], all[k] - before[k], 1e-15), "{stage} {k}: {part:?}, {all:?} − {before:?}");
        }
        assert_eq!(part[4..], all[4..], "{stage}");
    }
    let [moved, end, ..] = shown(&counted);
    assert!(moved > 1e-3 && is_near(moved, end, 1e-12), "{moved} {end}");
}

#[test]
fn a_stage_to_count_from_has_one_after_it() {
    for (since, stages, reason) in [
        ("gravty", 2, "no stage that another one follows is named \"gravty\", did you mean \"gravity\""),
        ("dig", 2, "no stage that another one follows is named \"dig\""),
    ] {
        let error = refusal(&relieved(&format!("[output]\nsince = \"{since}\"\n"), stages));
        assert!(error.contains("output.since") && error.contains(reason), "{error}");
    }
}

/// Places that no monitor can have are refused with the nearest one.
#[test]
fn monitors_without_a_joint_and_lines_without_rock_are_refused() {
    let stress = [-1e6, -1e6, 0.0];
    let gauge = |keys: &str| stressed(stress, &format!("[[joint_monitor]]\nname = \"gauge\"\n{keys}\n"));
    let line = |keys: &str| stressed(stress, &format!("[[line]]\nname = \"other\"\n{keys}\n"));
    for (text, parts) in [
        (gauge("point = [2, 3.5]"), ["joint_monitor[0].point", "at most one mesh size, 0.5 m"]),
        (gauge("point = [2, 1.75]\njoint = \"beding\""), ["joint_monitor[0].joint", "the case has: joint[0];"]),
        (gauge("point = [2, 1.75]\nlength = 0"), ["joint_monitor[0].length", "must be greater than 0"]),
        (line("from = [1, 1]\nto = [1, 9]"), ["line[1]", "point 9 of 21: there is no rock at (1, 4.2)"]),
        (line("from = [1, 1]\nto = [1, 1]"), ["line[1].to", "a segment needs two different points"]),
        (line("from = [1, 1]\nto = [1, 3]\npoints = 1"), ["line[1].points", "at least 2"]),
        (
            line("from = [1, 1]\nto = [1, 3]\n[[line]]\nname = \"hole\"\nfrom = [1, 1]\nto = [1, 2]"),
            ["line[2].name", "already"],
        ),
    ] {
        let error = refusal(&text);
        assert!(parts.iter().all(|part| error.contains(part)), "{error}\nlacks {parts:?}");
    }
}

/// A gauge stays on its joint when a stage cuts the rock nearer to its point, and a stretch of a joint has the mean of
/// its contacts: over all of it nearly that of the face, and near one end another one where the stress varies.
#[test]
fn a_gauge_stays_on_its_joint_and_has_a_length() {
    let text = |cut: &str| {
        format!(
            "{}{cut}[[joint_monitor]]\nname = \"left\"\npoint = [0.2, 2]\nlength = 0.7\n[[joint_monitor]]\n\
             name = \"all\"\npoint = [1, 2]\njoint = \"joint[0]\"\nlength = 9\n",
            relieved("", 2).replace("point = [1, 2]", "point = [1, 2.05]")
        )
    };
    let cut = "cut = [{ points = [[-1, 2.06], [3, 2.3]], law = \"joint\" }]\n";
    let [mut plain, mut parted] = ["", cut].map(|cut| simulation(&text(cut)));
    let bits =
        |simulation: &Simulation| simulation.joint_monitors().iter().map(|j| format!("{j:?}")).collect::<Vec<_>>();
    run_all(&mut plain);
    run_stage(&mut parted);
    let before = bits(&parted);
    assert!(parted.next_stage().unwrap_or_else(|e| panic!("{e}")));
    let blocks = parted.model().covers.block_count();
    let (uncut, cut) = (plain.built().monitors.joints[0].place, parted.built().monitors.joints[0].place);
    assert_eq!((blocks, uncut, before.len()), (4, cut, 3));
    let [joint, left, all] = plain.joint_monitors() else { panic!("three gauges") };
    // The lengths of contacts at the ends of the face may be off.
    let ratio = all.normal_stress / joint.normal_stress;
    assert!((0.99..1.1).contains(&ratio), "{joint:?}, {all:?}");
    println!("{joint:?}, {left:?}");
    assert!(left.normal_stress != joint.normal_stress && left.normal_stress < 0.0, "{left:?}, {joint:?}");
    let exact = -DENSITY * GRAVITY * 2.0;
    assert!(is_near(joint.normal_stress, exact, 1e-4 * exact.abs()), "{joint:?}, exact {exact}");
}

/// Hosts find gauges by name and read what the model shows; of a monitor that reads no stress they ask in vain.
#[test]
fn hosts_read_monitors_by_name() {
    let text = stressed([-1e6, -2e6, 0.0], GAUGE) + "[[monitor]]\nname = \"still\"\npoint = [1, 1]\n";
    let model = Cosimulation::new(case(&text)).unwrap_or_else(|error| panic!("{error}"));
    let gauge = model.find_name(Named::JointMonitor, "gauge").expect("a gauge");
    assert_eq!((gauge, model.name_count(Named::JointMonitor)), (0, 1));
    assert_eq!(model.joint_monitor_state(gauge).expect("a gauge"), model.simulation().joint_monitors()[0]);
    let rock = model.find_name(Named::Monitor, "rock").expect("a monitor");
    assert_eq!(Some(model.monitor_stress(rock).expect("its stress")), model.simulation().monitor_stress(0));
    let none = model.monitor_stress(2).expect_err("no stress").to_string();
    assert!(none.contains("set `stress = true` at it"), "{none}");
    let absent = model.joint_monitor_state(1).expect_err("no gauge").to_string();
    assert!(absent.contains("less than the number of monitors of joints, 1"), "{absent}");
}
