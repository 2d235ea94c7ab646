//! Energy ledger: where the work of every force went (Eq. 18).

use serde::{Deserialize, Serialize};

/// Energies (J per metre of depth). Works are those done on the rock since the start.
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
    /// Work of contact forces.
    pub contact_work: f64,
    /// Work of supports.
    pub support_work: f64,
    /// Energy taken by damping.
    pub damping: f64,
    /// Energy taken by rock that yields.
    pub yielding: f64,
    /// Work of bolts.
    pub bolt_work: f64,
    /// Energy stored in bolts now.
    pub bolt_stored: f64,
    /// Energy that bolts were installed with by their pretension.
    pub bolt_installed: f64,
    /// Work of quiet boundaries and free-field columns: minus what they carry away, plus what their waves bring.
    pub radiation: f64,
    /// Work of loads, and of gravity while it is ramped.
    pub external_work: f64,
    /// Energy that left with excavated blocks, and energy of the start.
    pub baseline: f64,
}

impl Ledger {
    /// Adds the works of another ledger times `share`; energies of now stay.
    pub fn add_works(&mut self, works: &Ledger, share: f64) {
        self.friction += share * works.friction;
        self.contact_work += share * works.contact_work;
        self.support_work += share * works.support_work;
        self.damping += share * works.damping;
        self.yielding += share * works.yielding;
        self.bolt_work += share * works.bolt_work;
        self.radiation += share * works.radiation;
        self.external_work += share * works.external_work;
    }

    /// Energy dissipated by contact springs: dashpots, impacts and the numerical damping of the implicit spring.
    pub fn contact_dissipation(&self) -> f64 {
        -(self.contact_work + self.support_work) - self.stored - self.friction
    }

    /// Energy dissipated by bolts: yielding, rupture, and the numerical damping of the implicit spring.
    pub fn bolt_dissipation(&self) -> f64 {
        self.bolt_installed - self.bolt_work - self.bolt_stored
    }

    /// Energy that appeared from nowhere; zero but for discretisation.
    pub fn residual(&self) -> f64 {
        self.kinetic + self.strain + self.potential + self.damping + self.yielding
            - self.contact_work
            - self.support_work
            - self.bolt_work
            - self.radiation
            - self.external_work
            - self.baseline
    }

    /// The residual over the largest term.
    pub fn residual_relative(&self) -> f64 {
        self.residual() / self.largest().max(f64::MIN_POSITIVE)
    }

    /// The largest term, against which the residual is judged.
    pub fn largest(&self) -> f64 {
        [
            self.kinetic,
            self.strain,
            self.potential,
            self.stored,
            self.friction,
            self.damping,
            self.yielding,
            self.external_work,
            self.contact_work,
            self.bolt_work,
            self.radiation,
        ]
        .into_iter()
        .map(f64::abs)
        .fold(0.0, f64::max)
    }
}
