//! Getters. What the model computes for all outputs at once is kept until it moves.

use std::ffi::CString;

use enmm::cosimulation::{EventKind, PORT_QUANTITIES, PortState, TOTALS, Totals};
use enmm::model::{
    BLOCK_QUANTITIES, ENERGIES, INLET_QUANTITIES, JOINT_MONITOR_QUANTITIES, MONITOR_QUANTITIES,
    MONITOR_STRESS_QUANTITIES,
};

use crate::log::Status;
use crate::phase::{Call, Phase};
use crate::table::{Causality, Quantity, Table, Total, Type};

use super::{Failure, Instance};

/// Values that have been computed since the model last moved.
#[derive(Debug, Default)]
pub(super) struct Cache {
    totals: Option<Totals>,
    ports: Vec<[Option<PortState>; 2]>,
    snapshot: Vec<u8>,
    pub(super) text: CString,
}

impl Cache {
    /// Forgets everything but the bytes and the text that the importer may still read.
    pub(super) fn clear(&mut self) {
        self.totals = None;
        self.ports.clear();
    }
}

impl Instance {
    /// Reads variables of one type into `values`, which has room for exactly their elements.
    pub fn get(&mut self, references: &[u32], kind: Type, values: &mut [f64]) -> Status {
        let legal = self.allow(Call::Get);
        let counted = legal.and_then(|()| self.check_count(references, kind, values.len()));
        let outcome = counted.and_then(|()| self.prepare(references));
        let outcome = outcome.and_then(|()| {
            let mut rest = values;
            for &reference in references {
                let v = self.variable(reference, kind)?;
                let (quantity, causality) = (v.quantity, v.causality);
                let (own, others) = rest.split_at_mut(v.size());
                rest = others;
                match causality {
                    Causality::Parameter | Causality::Input => own.copy_from_slice(self.values.get(reference)),
                    Causality::Independent | Causality::Output | Causality::Local => self.read(quantity, own),
                }
            }
            Ok(())
        });
        self.end(outcome)
    }

    /// Whether a call with these variables and so many values is legal now, before an entry point makes room for them;
    /// if not, the call has failed.
    pub fn expects(&mut self, call: Call, references: &[u32], kind: Type, given: usize) -> Status {
        let outcome = self.allow(call).and_then(|()| self.check_count(references, kind, given));
        self.end(outcome)
    }

    /// Reads first time derivatives of outputs: those of motions, and 0 for outputs that are only known themselves, as
    /// the standard wants for an order beyond that of an output.
    pub fn get_derivatives(&mut self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Status {
        let legal = self.allow(Call::GetDerivative);
        let outcome = legal.and_then(|()| self.check_count(references, Type::Real, values.len()));
        let outcome = outcome.and_then(|()| {
            let mut rest = values;
            for (&reference, &order) in references.iter().zip(orders) {
                let v = self.variable(reference, Type::Real)?;
                if order != 1 || v.causality != Causality::Output {
                    let name = &v.name;
                    return Err(format!("{name}: has no derivative of order {order}; outputs have one, of order 1"));
                }
                let (derivative, (own, others)) = (Table::derivative(v.quantity), rest.split_at_mut(v.size()));
                rest = others;
                match derivative {
                    Some(derivative) => self.read(derivative, own),
                    None => own.fill(0.0),
                }
            }
            Ok(())
        });
        self.end(outcome)
    }

    /// Reads the snapshot, once for each reference; the bytes stay until the next call of this function.
    pub fn get_binary(&mut self, references: &[u32]) -> Result<&[u8], Status> {
        let legal = self.allow(Call::Get).and_then(|()| self.check_count(references, Type::Binary, references.len()));
        let outcome = legal.and_then(|()| self.prepare(references)).and_then(|()| {
            let bytes = self.model.serialize(&self.model.save());
            self.cache.snapshot = bytes.map_err(|error| format!("snapshot: {error}"))?;
            Ok(())
        });
        match self.end(outcome) {
            Status::Ok => Ok(&self.cache.snapshot),
            status => Err(status),
        }
    }

    /// Outputs and time have no start value, which is all that can be read before initialization mode. There outputs
    /// are those of the equilibrium under the parameters and inputs that hold.
    fn prepare(&mut self, references: &[u32]) -> Result<(), Failure> {
        let mut variables = references.iter().filter_map(|&reference| self.table.get(reference));
        match self.phase {
            Phase::Instantiated => variables.find(|v| v.start.is_none()).map_or(Ok(()), |v| {
                let name = &v.name;
                Err(format!(
                    "{name}: has no start value, and none before initialization mode; enter that, then read it"
                ))
            }),
            Phase::Initialization if variables.any(|v| matches!(v.causality, Causality::Output | Causality::Local)) => {
                self.start_model()
            }
            _ => Ok(()),
        }
    }

    fn read(&mut self, quantity: Quantity, values: &mut [f64]) {
        match quantity {
            Quantity::Time => values[0] = self.time,
            Quantity::Port(k, place) => values[0] = (PORT_QUANTITIES[place].get)(self.port(k, place)),
            Quantity::Monitor(k, place) => {
                values[0] = (MONITOR_QUANTITIES[place].get)(&self.model.simulation().monitor(k));
            }
            Quantity::MonitorStress(k, place) => {
                let stress = self.model.simulation().monitor_stress(k);
                values[0] = stress.map_or(f64::NAN, |stress| (MONITOR_STRESS_QUANTITIES[place].get)(&stress));
            }
            Quantity::JointMonitor(k, place) => {
                values[0] = (JOINT_MONITOR_QUANTITIES[place].get)(&self.model.simulation().joint_monitors()[k]);
            }
            Quantity::Total(total) => values[0] = self.total(total),
            Quantity::Inlet(kind, k, place) => {
                values[0] = (INLET_QUANTITIES[place].get)(&self.model.inlet(kind, k).unwrap_or_default());
            }
            Quantity::Blocks(place) => {
                let states = self.model.blocks();
                let get = BLOCK_QUANTITIES[place].get;
                // Parts that rock has not broken into yet have nothing.
                values.fill(0.0);
                values.iter_mut().zip(states).for_each(|(value, state)| *value = get(state));
            }
            Quantity::Block(block, place) => {
                let simulation = self.model.simulation();
                let own = simulation.block_labelled(block as u32);
                values[0] = own.map_or(0.0, |own| (BLOCK_QUANTITIES[place].get)(&simulation.blocks()[own.index()]));
            }
            Quantity::Snapshot
            | Quantity::Parameter(_)
            | Quantity::Threads
            | Quantity::ResultsFolder
            | Quantity::InterpolateInputs
            | Quantity::Gravity(_)
            | Quantity::BaseAcceleration(_)
            | Quantity::WaterLevel
            | Quantity::StrengthFactor
            | Quantity::PortForce(..)
            | Quantity::PortMoment(_)
            | Quantity::PortTraction(..)
            | Quantity::PortPressure(_)
            | Quantity::PortVelocity(..)
            | Quantity::BlockForce(_)
            | Quantity::BlockMoment
            | Quantity::Head(_)
            | Quantity::Rain(_)
            | Quantity::Drain(_) => {} // not outputs
        }
    }

    /// State of a port for one of its quantities: stresses are worked out only where they are asked for.
    fn port(&mut self, k: usize, place: usize) -> &PortState {
        let (ports, model) = (&mut self.cache.ports, &self.model);
        ports.resize(model.ports().len(), [None; 2]);
        if PORT_QUANTITIES[place].name.starts_with("stress") {
            ports[k][1].get_or_insert_with(|| model.port_state(k))
        } else {
            ports[k][0].get_or_insert_with(|| model.port_motion(k))
        }
    }

    fn total(&mut self, total: Total) -> f64 {
        let model = &self.model;
        let last = model.simulation().state().events.list.len().checked_sub(1).and_then(|k| model.events().nth(k));
        match total {
            Total::InternalDt => model.internal_step(),
            Total::EventCount => model.events().len() as f64,
            Total::LastEventTime => last.map_or(0.0, |event| self.experiment.start + event.time),
            Total::PartCount => model.inputs().block_force.len() as f64,
            Total::CutCount => model.cuts().len() as f64,
            Total::CutLength => model.cuts().map(|cut| (cut.ends[1] - cut.ends[0]).norm()).sum(),
            Total::LastEventKind => last.map_or(0.0, |event| kind_number(event.kind)),
            Total::LastEventSubject => {
                last.filter(|event| event.subject != u32::MAX).map_or(-1.0, |event| f64::from(event.subject))
            }
            Total::Energy(k) => (ENERGIES[k].get)(&self.cache.totals.get_or_insert_with(|| model.totals()).ledger),
            Total::Extreme(k) => (TOTALS[k].get)(self.cache.totals.get_or_insert_with(|| model.totals())),
        }
    }
}

fn kind_number(kind: EventKind) -> f64 {
    match kind {
        EventKind::Detached => 1.0,
        EventKind::Slipped => 2.0,
        EventKind::Failed => 3.0,
        EventKind::Overlapped => 4.0,
        EventKind::Broken => 5.0,
        EventKind::Cut => 6.0,
    }
}
