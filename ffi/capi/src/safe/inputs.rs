//! Inputs that the façade does not know in the form that hosts give them.

use engine::cosimulation::PortKind;
use engine::geometry::Vector;

use super::failure::{Failure, Outcome};
use super::model::Model;

impl Model {
    /// Sets force and moment of several blocks, or of none; `loads` holds Fx, Fy and M of each block of `ids`.
    ///
    /// # Errors
    /// The first value that the façade refuses.
    pub fn set_block_forces(&mut self, ids: &[u32], loads: [&[f64]; 3]) -> Outcome {
        let [fx, fy, moment] = loads;
        let forces = (0..ids.len()).map(|k| (ids[k], Vector::new(fx[k], fy[k]), moment[k]));
        self.inner.set_block_forces(forces)?;
        Ok(())
    }

    /// Sets fluid pressure on a port of one kind.
    ///
    /// # Errors
    /// A port of another kind, or a value that the façade refuses.
    pub fn set_pressure(&mut self, port: u32, kind: PortKind, pressure: f64) -> Outcome {
        if let Some(found) = self.inner.ports().get(port as usize)
            && found.kind != kind
        {
            let must = if kind == PortKind::Joint { "a port of joints" } else { "a port of a boundary" };
            return Err(Failure::invalid(format!("port: is {:?}, must be {must}; use its own input", found.name)));
        }
        Ok(self.inner.set_pressure(port as usize, pressure)?)
    }
}
