//! Claim: a rock bridge breaks as a whole by the forces of its section, on any mesh, and lets go while a crack crosses
//! it (theory §7, Bridges by section).

use enmm::model::assemble::Breaking;
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{Simulation, State};

use crate::common::{run_stage, simulation, step_to};

/// Weight (N/m) of the overhang, and the moment (N) at its root.
const WEIGHT: f64 = 2.0 * 2600.0 * 9.81;
/// Stress (Pa) of the outermost fibre there.
const FIBRE: f64 = 6.0 * WEIGHT;

/// An overhang of 2 m by 1 m whose root is a bridge of some tensile strength (Pa).
fn overhang(size: f64, angle: f64, tension: f64, stage: &str) -> String {
    format!(
        "title = \"overhang\"\n[domain]\noutline = [[-1, 0], [2, 0], [2, 1], [-1, 1]]\n[mesh]\nsize = {size}\n\
         angle_deg = {angle}\norigin = [0.0137, 0.0071]\n[[bridge]]\npoints = [[0, 0], [0, 1]]\nlaw = \"rock\"\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0.25\n[joint_law.rock]\nfriction_deg = 45\n\
         cohesion = 20e6\nresidual_cohesion = 0\ntension = {tension:?}\nnormal_stiffness = 1e13\n\
         shear_stiffness = 1e13\n[[fix]]\nblock = [-0.5, 0.5]\n[[stage]]\nname = \"weight\"\n{stage}\n"
    )
}

const AT_REST: &str = "kind = \"static\"\nduration = 0.6";
const AT_ONCE: &str = "kind = \"dynamic\"\nduration = 0.05\ndamping = 0";

/// The weight hangs on the section, whatever the mesh: its forces are those of equilibrium within the unbalanced ratio
/// of a stage at rest (1e-4), and its moment within the angle by which the overhang sags.
#[test]
fn a_section_has_the_forces_of_equilibrium_on_any_mesh() {
    for (size, angle) in [(2.0, 0.0), (1.0, 15.0), (0.5, 30.0), (0.25, 45.0)] {
        let mut simulation = simulation(&overhang(size, angle, 50e6, AT_REST));
        run_stage(&mut simulation);
        let [normal, shear, moment] = simulation.workspace().sections[0].resultants().map(|force| force / WEIGHT);
        println!("h {size}, {angle}°: N {normal:.2e}, V {shear:.6}, M {moment:.6} of the weight");
        assert!(normal.abs() < 1e-3, "{normal}");
        assert!((shear.abs() - 1.0).abs() < 1e-3 && (moment.abs() - 1.0).abs() < 1e-3, "{shear} {moment}");
    }
}

/// Gravity that acts at once doubles the moment of a beam; elements of half and all of the thickness see 1.96 to 2.00.
#[test]
fn gravity_at_once_breaks_a_bridge_of_less_than_twice_the_stress_at_rest() {
    for (size, angle) in [(1.0, 0.0), (0.5, 30.0)] {
        let broken = [0.95, 1.03].map(|share| {
            let mut simulation = simulation(&overhang(size, angle, 2.0 * share * FIBRE, AT_ONCE));
            step_to(&mut simulation, 0.03);
            simulation.state().counters.broken
        });
        assert!((broken[0] - 1.0).abs() < 1e-9 && broken[1] == 0.0, "h {size}: {broken:?} m broken");
    }
}

/// Node by node, as bridges broke before, two nodes over the root hold three times the moment.
#[test]
fn node_by_node_a_coarse_mesh_holds_what_no_section_holds() {
    let holds = |breaks: &str| {
        let text = overhang(1.0, 0.0, 0.5 * FIBRE, AT_REST).replace("cohesion = 20e6", breaks);
        let mut simulation = simulation(&text.replace("breaks", "cohesion = 20e6\nbreaks"));
        step_to(&mut simulation, 0.6);
        simulation.state().counters.broken == 0.0
    };
    assert!(holds("breaks = \"by node\"") && !holds("breaks = \"by section\""));
}

fn release(state: &State) -> Option<f64> {
    state.sections[0].map(|release| release.left)
}

/// The crack takes l/(0.4 c_R), c_R being 1976 m/s; what the bonds then no longer store is energy of fracture, and the
/// ledger explains the rest within what the leapfrog's own error is allowed (claim A4).
#[test]
fn a_section_lets_go_while_a_crack_crosses_it() {
    let mut simulation = simulation(&(overhang(0.5, 15.0, FIBRE, AT_ONCE) + "[solver]\ndt_max = 1e-5\n"));
    while release(simulation.state()).is_none() {
        simulation.advance(true).unwrap_or_else(|e| panic!("{e}"));
    }
    let start = simulation.time();
    assert_eq!(simulation.state().counters.broken, 0.0);
    let mut left = 1.0;
    while left > 0.0 {
        simulation.advance(true).unwrap_or_else(|e| panic!("{e}"));
        let next = release(simulation.state()).expect("a release");
        assert!(next < left, "{next} after {left}");
        left = next;
    }
    let (time, dt) = (simulation.time() - start, simulation.model().dt);
    let shear = (12e9f64 / 2600.0).sqrt();
    let crack = 1.0 / (0.4 * shear * (0.87 + 1.12 * 0.25) / 1.25);
    println!("{:.1} steps, {time:.4e} s of {crack:.4e} s, {} J/m", time / dt, simulation.state().ledger.fracture);
    assert!(time >= crack - dt && time < crack + 2.0 * dt, "{time} of {crack}");
    assert!((simulation.state().counters.broken - 1.0).abs() < 1e-9);
    let report = simulation.advance(true).unwrap_or_else(|e| panic!("{e}"));
    let ledger = &report.ledger;
    assert!(ledger.fracture > 0.0 && ledger.contact_dissipation() > -0.02 * ledger.fracture, "{ledger:?}");
    assert!(report.ledger.residual_relative().abs() < 1e-3, "{}", report.ledger.residual_relative());
}

/// A state that is saved while a section lets go goes on to the same bits, on other threads too.
#[test]
fn a_state_in_the_middle_of_a_release_goes_on_to_the_same_bits() {
    let text = overhang(0.25, 15.0, FIBRE, AT_ONCE);
    let mut one = simulation(&text);
    while release(one.state()).is_none_or(|left| left > 0.5) {
        one.advance(false).unwrap_or_else(|e| panic!("{e}"));
    }
    let bytes = encode(Keeper::Model, one.state(), "hash").expect("bytes");
    let end = |mut simulation: Simulation| {
        (0..200).for_each(|_| _ = simulation.advance(false).unwrap_or_else(|e| panic!("{e}")));
        let mut state = simulation.state().clone();
        state.counters.searches = 0;
        assert_eq!(release(&state), Some(0.0));
        encode(Keeper::Model, &state, "").expect("bytes")
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    let other = pool.install(|| {
        let mut other = simulation(&text);
        other.restore(decode(Keeper::Model, &bytes, "hash").expect("a state"));
        end(other)
    });
    assert!(end(one) == other);
}

/// A block on a bench of rock with a bridge of 1 m under it, and lines of the case beside.
fn bench(height: f64, law: &str, lines: &str) -> Simulation {
    simulation(&format!(
        "title = \"bench\"\n[domain]\noutline = [[-2, -2], [3, -2], [3, 0], [1, 0], [1, {height}], [0, {height}], \
         [0, 0], [-2, 0]]\njoint_law = \"joint\"\n[mesh]\nsize = 0.7\nangle_deg = 8\n[[bridge]]\n\
         points = [[0, 0], [1, 0]]\nlaw = \"rock\"\n{lines}\n[rock.rock]\ndensity = 2600\nyoung = 30e9\n\
         poisson = 0.25\n[joint_law.joint]\nfriction_deg = 30\n[joint_law.rock]\nfriction_deg = 45\n\
         cohesion = 5e6\nresidual_cohesion = 0\n{law}\n[[fix]]\nedge = [[-2, -2], [3, -2]]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1\n"
    ))
}

/// What each part of the bridge is: its length, and how it breaks.
fn parts(simulation: &Simulation) -> Vec<(f64, Breaking)> {
    let bridges = simulation.built().bridges.iter();
    bridges.map(|bridge| ((1e6 * bridge.length).round() * 1e-6, bridge.breaking)).collect()
}

/// E' is 32 GPa: with σt 1 MPa and G_I 125 J/m² the characteristic length is 4 m.
#[test]
fn a_bridge_breaks_by_section_where_its_rock_is_brittle_and_deep() {
    let whole = |law: &str| parts(&bench(2.0, law, ""))[0].1;
    assert_eq!(whole("tension = 1e6"), Breaking::BySection);
    assert_eq!(whole("tension = 1e6\ntension_energy = 124.9"), Breaking::BySection);
    assert_eq!(whole("tension = 1e6\ntension_energy = 125.1"), Breaking::Soft);
    assert_eq!(whole("tension = 1e6\ntension_energy = 125.1\nbreaks = \"by section\""), Breaking::BySection);
    assert_eq!(whole("tension = 1e6\nbreaks = \"by node\""), Breaking::Asked);
    assert_eq!(whole("tension = 0"), Breaking::WithoutTension);
    let at = |height: f64| parts(&bench(height, "tension = 1e6", ""))[0].1;
    assert_eq!([at(0.49), at(0.51)], [Breaking::Shallow, Breaking::BySection]);
    let bending = bench(2.0, "tension = 1e6\ntension_energy = 125", "").built().bridges[0].bending;
    assert!((bending - (1.0 + 1.0 / (0.85 + 2.3 / 4.0))).abs() < 1e-9, "{bending}");
}

/// A joint that crosses a bridge parts it: each part is a section between the two blocks that it holds together.
#[test]
fn a_joint_across_a_bridge_parts_it() {
    let law = "tension = 1e6";
    let through = bench(2.0, law, "[[joint]]\npoints = [[0.3, -2], [0.3, 2]]");
    let above = bench(2.0, law, "[[joint]]\npoints = [[0.3, 0], [0.3, 2]]");
    let short = bench(2.0, law, "[[joint]]\npoints = [[0.3, -0.3], [0.3, 0]]");
    let two = vec![(0.3, Breaking::BySection), (0.7, Breaking::BySection)];
    assert_eq!(parts(&through), two);
    assert_eq!(parts(&above), two);
    assert_eq!(parts(&short), vec![(1.0, Breaking::BySection)]);
    for simulation in [through, above, short] {
        let lengths = simulation.built().bridges.iter().map(|bridge| bridge.length);
        let (state, _) = simulation.look_ahead();
        assert_eq!(state.sections.len(), lengths.len());
    }
}

/// Contacts of a bridge in parts belong to the part that they hold, and cover it.
#[test]
fn contacts_of_a_bridge_cover_its_sections() {
    for lines in ["", "[[joint]]\npoints = [[0.3, 0], [0.3, 2]]", "[[joint]]\npoints = [[0.3, -2], [0.3, 2]]"] {
        let simulation = bench(2.0, "tension = 1e6", lines);
        let (_, workspace) = simulation.look_ahead();
        for (k, section) in simulation.model().sections.list.iter().enumerate() {
            let own = workspace.contacts.iter().filter(|contact| contact.section().is_some_and(|s| s.index() == k));
            let bonded: f64 = own.map(|contact| contact.bonded).sum();
            // Of corners that hardly overlap a least length counts, 1e-3 of a node segment.
            assert!((bonded / section.length - 1.0).abs() < 1e-3, "{lines}: {bonded} m of {} m", section.length);
        }
    }
}
