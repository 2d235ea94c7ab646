//! Energy ledger: where the work of every force went (Eq. 18).

use serde::{Deserialize, Serialize};

use super::Quantity;

/// Energies (J per metre of depth). Works are those done on the rock since the start.
#[doc(alias = "energy balance")]
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic energy now.
    pub kinetic: f64,
    /// Strain energy now.
    pub strain: f64,
    /// Potential energy of gravity now, relative to the reference configuration.
    pub potential: f64,
    /// Energy stored in contact and support springs now.
    pub stored: f64,
    /// Energy turned into heat by slip.
    pub friction: f64,
    /// Energy of fracture: what joints that soften took to break.
    pub fracture: f64,
    /// Work of contact forces.
    pub contact_work: f64,
    /// Work of supports.
    pub support_work: f64,
    /// Energy taken by damping.
    pub damping: f64,
    /// Energy taken by rock that yields.
    pub yielding: f64,
    /// Energies of bolts.
    pub bolts: BoltEnergies,
    /// Work of quiet boundaries and free-field columns: minus what they carry away, plus what their waves bring.
    pub radiation: f64,
    /// Work of loads, and of gravity while it is ramped.
    pub external_work: f64,
    /// Energy that left with excavated blocks, and energy of the start.
    pub baseline: f64,
}

/// Energies of bolts (J per metre of depth).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct BoltEnergies {
    /// Work on the rock.
    pub work: f64,
    /// Energy stored now.
    pub stored: f64,
    /// Energy that they were installed with by their pretension.
    pub installed: f64,
}

impl Ledger {
    /// Adds the works of another ledger times `share`; energies of now stay.
    pub fn add_works(&mut self, works: &Ledger, share: f64) {
        self.friction += share * works.friction;
        self.fracture += share * works.fracture;
        self.contact_work += share * works.contact_work;
        self.support_work += share * works.support_work;
        self.damping += share * works.damping;
        self.yielding += share * works.yielding;
        self.bolts.work += share * works.bolts.work;
        self.radiation += share * works.radiation;
        self.external_work += share * works.external_work;
    }

    /// Energy dissipated by contact springs but for slip and fracture: dashpots, impacts and the numerical damping of
    /// the implicit spring.
    pub fn contact_dissipation(&self) -> f64 {
        -(self.contact_work + self.support_work) - self.stored - self.friction - self.fracture
    }

    /// Energy dissipated by bolts: yielding, rupture, and the numerical damping of the implicit spring.
    pub fn bolt_dissipation(&self) -> f64 {
        self.bolts.installed - self.bolts.work - self.bolts.stored
    }

    /// Energy that appeared from nowhere; zero but for discretisation.
    pub fn residual(&self) -> f64 {
        self.kinetic + self.strain + self.potential + self.damping + self.yielding
            - self.contact_work
            - self.support_work
            - self.bolts.work
            - self.radiation
            - self.external_work
            - self.baseline
    }

    /// The residual over the largest term.
    pub fn residual_relative(&self) -> f64 {
        self.residual() / self.largest().max(f64::MIN_POSITIVE)
    }

    /// The largest energy or work, with which the residual is compared: of all of [`ENERGIES`] but those in `COMPOSED`.
    pub fn largest(&self) -> f64 {
        let terms = ENERGIES.iter().filter(|energy| !COMPOSED.contains(&energy.name));
        terms.map(|energy| (energy.get)(self).abs()).fold(0.0, f64::max)
    }
}

/// Energies that the largest term leaves out: sums of others, and those of the start, which no force has moved.
const COMPOSED: [&str; 5] = ["contact_dissipation", "residual", "baseline", "bolt_installed", "bolt_dissipation"];

/// Energies and works as outputs show them: `history.csv` in this order, `summary.json`, the FMUs, and the structures
/// of C and Python. New ones go to the end.
pub const ENERGIES: [Quantity<Ledger>; 19] = [
    energy(["kinetic", "kinetic_energy"], "Kinetic energy", |ledger| ledger.kinetic),
    energy(["strain", "strain_energy"], "Strain energy", |ledger| ledger.strain),
    energy(["potential", "potential_energy"], "Potential energy of gravity, from the undeformed state on", |ledger| {
        ledger.potential
    }),
    energy(["stored", "stored_energy"], "Energy in contact and support springs", |ledger| ledger.stored),
    energy(["friction", "friction_heat"], "Energy turned into heat by slip", |ledger| ledger.friction),
    energy(
        ["contact_dissipation", "contact_dissipation"],
        "Energy that contacts and supports lost in other ways than slip",
        |ledger| ledger.contact_dissipation(),
    ),
    energy(["damping", "damping_loss"], "Energy taken by damping", |ledger| ledger.damping),
    energy(
        ["external_work", "external_work"],
        "Work of loads and inputs, and of gravity while it grows or changes",
        |ledger| ledger.external_work,
    ),
    energy(
        ["residual", "energy_residual"],
        "Energy that appeared from nowhere: the error of the time steps",
        |ledger| ledger.residual(),
    ),
    energy(["yielding", "yielding_loss"], "Energy taken by yielding rock", |ledger| ledger.yielding),
    energy(["bolt_work", "bolt_work"], "Work of bolts on the blocks", |ledger| ledger.bolts.work),
    energy(
        ["radiation", "radiation"],
        "Work of quiet boundaries and free-field columns: less what waves carry away",
        |ledger| ledger.radiation,
    ),
    energy(["baseline", "baseline_energy"], "Energy of the start, less what left with excavated blocks", |ledger| {
        ledger.baseline
    }),
    energy(["contact_work", "contact_work"], "Work of contact forces on the blocks", |ledger| ledger.contact_work),
    energy(["support_work", "support_work"], "Work of supports on the blocks", |ledger| ledger.support_work),
    energy(["bolt_stored", "bolt_stored_energy"], "Energy in bolts", |ledger| ledger.bolts.stored),
    energy(
        ["bolt_installed", "bolt_installed_energy"],
        "Energy that bolts were installed with by their pretension",
        |ledger| ledger.bolts.installed,
    ),
    energy(
        ["bolt_dissipation", "bolt_dissipation"],
        "Energy that bolts lost by yielding and rupture: installed less work and stored",
        |ledger| ledger.bolt_dissipation(),
    ),
    energy(["fracture", "fracture_energy"], "Energy of fracture of joints that soften", |ledger| ledger.fracture),
];

const fn energy(names: [&'static str; 2], text: &'static str, get: fn(&Ledger) -> f64) -> Quantity<Ledger> {
    Quantity::new(names, "J/m", text, get)
}

/// Those whose sum, with these signs, is the residual.
pub const BALANCE: [(&str, f64); 11] = [
    ("kinetic", 1.0),
    ("strain", 1.0),
    ("potential", 1.0),
    ("damping", 1.0),
    ("yielding", 1.0),
    ("contact_work", -1.0),
    ("support_work", -1.0),
    ("bolt_work", -1.0),
    ("radiation", -1.0),
    ("external_work", -1.0),
    ("baseline", -1.0),
];
