//! Claims: `enmm check` names what is doubtful about water that flows in joints before a run, and how well and how fast
//! joints conduct it.

use enmm::model::Simulation;
use enmm_io::parse_case;
use enmm_run::check::Check;

/// A slab, 10 m by 2 m, on a level joint under a head, with a joint set in the rock below.
fn slab(head: f64, aperture: f64, more: &str) -> String {
    format!(
        "title = \"slab\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 8], [0, 8]]\n[mesh]\nsize = 1.0\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 6], [10, 6]]\nlaw = \"bedding\"\n[[joint]]\n\
         points = [[4, 0], [4, 6]]\nlaw = \"tight\"\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n\
         [joint_law.bedding]\nfriction_deg = 40\naperture = {aperture:e}\n[joint_law.tight]\nfriction_deg = 40\n\
         aperture = 1e-6\n[flow]\n[[head]]\nname = \"left\"\nedge = [[0, 1], [0, 8]]\nlevel = {:?}\n[[fix]]\n\
         edge = [[0, 0], [10, 0]]\n{more}[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1.0\n",
        6.0 + head
    )
}

fn check(text: &str) -> Check {
    let case = parse_case(text, "slab.toml", "".as_ref()).unwrap_or_else(|error| panic!("{error}")).case;
    let simulation = Simulation::new(case).unwrap_or_else(|error| panic!("{error}"));
    enmm_run::check(&simulation, &[])
}

/// The warning that contains a text.
fn told<'a>(found: &'a Check, text: &str) -> Option<&'a String> {
    found.warnings.iter().find(|warning| warning.contains(text))
}

/// The uplift is γHB/2, the weight ρgBh: they are equal at H = 2·2.6·2 m.
#[test]
fn a_slab_that_water_lifts_is_told() {
    let limit = 2.0 * 2.6 * 2.0;
    let [below, above] = [0.99, 1.01].map(|share| check(&slab(share * limit, 1e-4, "")));
    assert!(told(&below, "lifts block").is_none(), "{:?}", below.warnings);
    let warning = told(&above, "lifts block").expect("a warning");
    let forces: Vec<f64> = warning.split(" N/m").filter_map(|part| part.split(' ').next_back()?.parse().ok()).collect();
    let weight = 2600.0 * 9.81 * 20.0;
    assert!((forces[0] / (1.01 * weight) - 1.0).abs() < 1e-3, "{warning}");
    assert!((forces[1] / weight - 1.0).abs() < 1e-3, "{warning}");
    assert!(warning.contains("drain the joints below it"));
}

/// ρq/μ = ρT·H/(L·μ) with T = γe³/12μ: 500 at the aperture e.
#[test]
fn flow_that_is_turbulent_is_told() {
    let head = 1.0_f64;
    let limit = (500.0 * 1e-3 / 1e3 * 10.0 / head * 12e-3 / 9810.0).cbrt();
    let [below, above] = [0.99, 1.01].map(|share| check(&slab(head, share * limit, "")));
    assert!(told(&below, "Reynolds").is_none(), "{:?}", below.warnings);
    let warning = told(&above, "Reynolds").expect("a warning");
    assert!(warning.contains("ρq/μ of 515") && warning.contains("6.000) m"), "{warning}");
}

/// The tight joint has 1e-6 m: 1e12 are reached at 1e-2 m.
#[test]
fn a_contrast_that_rounding_cannot_bear_is_told() {
    let [below, above] = [0.99e-2, 1.01e-2].map(|aperture| check(&slab(0.01, aperture, "")));
    assert!(told(&below, "differ by a factor").is_none(), "{:?}", below.warnings);
    let warning = told(&above, "differ by a factor").expect("a warning");
    assert!(warning.contains("from 1e-6 to 1.01e-2 m") && warning.contains("1.0e12"), "{warning}");
}

/// K = γe³/(12 μ s), and a joint of the height H drains in H/(γe²/12μ).
#[test]
fn conductivities_of_sets_and_drain_times_of_laws_are_told() {
    let set = "[[joint_set]]\nname = \"bedding planes\"\nangle_deg = 20\nspacing = 1.5\nlaw = \"bedding\"\nseed = 1\n\
               [[joint_set]]\nangle_deg = 100\nspacing = 2.0\nlaw = \"closed\"\nseed = 2\n[joint_law.closed]\n\
               friction_deg = 30\naperture = 0.0\n";
    let found = check(&slab(1.0, 2e-4, set));
    let [conductivity] = &found.conductivities[..] else { panic!("{:?}", found.conductivities) };
    let exact = 9810.0 * 8e-12 / (12e-3 * 1.5);
    assert_eq!((&*conductivity.set, conductivity.aperture), ("bedding planes", 2e-4));
    assert!((conductivity.conductivity / exact - 1.0).abs() < 1e-9, "{conductivity:?}");
    let times: Vec<_> = found.drain_times.iter().map(|law| (&*law.law, law.height, law.time)).collect();
    let exact = |aperture: f64| 8.0 / (9810.0 * aperture * aperture / 12e-3);
    let [("bedding", high, open), ("tight", _, tight)] = times[..] else { panic!("{times:?}") };
    assert!((high - 8.0).abs() < 1e-9 && (open / exact(2e-4) - 1.0).abs() < 1e-9, "{times:?}");
    assert!((tight / exact(1e-6) - 1.0).abs() < 1e-9, "{times:?}");
    assert!(told(&found, "flow").is_none(), "{:?}", found.warnings);
    let dry = "[flow]\n[[head]]\nname = \"left\"\nedge = [[0, 1], [0, 8]]\nlevel = 7.0\n";
    let without =
        slab(1.0, 2e-4, "").replace(dry, "").replace("aperture = 2e-4\n", "").replace("aperture = 1e-6\n", "");
    let still = check(&without);
    assert!(still.flow.is_none() && still.conductivities.is_empty() && still.drain_times.is_empty());
}
