//! Setters: all values of a call are checked before the first of them holds.

use crate::log::Status;
use crate::phase::Call;
use crate::table::{Causality, Quantity, Type, Variable};
use crate::values::Group;

use super::{Failure, Instance};

impl Instance {
    /// Sets variables of one type; a Boolean is 0 or 1.
    pub fn set(&mut self, references: &[u32], kind: Type, values: &[f64]) -> Status {
        let legal = self.allow(Call::Set);
        let checked = legal.and_then(|()| self.check(references, kind, values));
        let outcome = checked.and_then(|()| self.take_back_start()).and_then(|()| {
            let before = self.values.clone();
            let set = self.store(references, values);
            if set.is_err() {
                self.values = before;
            }
            set
        });
        self.cache.clear();
        self.end(outcome)
    }

    fn check(&self, references: &[u32], kind: Type, values: &[f64]) -> Result<(), Failure> {
        self.check_count(references, kind, values.len())?;
        let mut rest = values;
        for &reference in references {
            let v = self.variable(reference, kind)?;
            let (own, others) = rest.split_at(v.size());
            rest = others;
            self.check_settable(v)?;
            own.iter().try_for_each(|&value| v.check(value))?;
        }
        Ok(())
    }

    /// Whether a variable can be set now.
    pub(super) fn check_settable(&self, v: &Variable) -> Result<(), Failure> {
        match v.causality {
            Causality::Input => Ok(()),
            Causality::Parameter if v.is_tunable => Ok(()),
            Causality::Parameter => self
                .allow(Call::SetParameter)
                .map_err(|failure| format!("{}: {failure}; parameters hold from the end of initialization on", v.name)),
            Causality::Output | Causality::Local | Causality::Independent => {
                Err(format!("{}: cannot be set, only read", v.name))
            }
        }
    }

    fn store(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let mut rest = values;
        let mut groups: Vec<(Group, u32)> = Vec::new();
        for &reference in references {
            let Some(v) = self.table.get(reference) else { continue };
            let (own, others) = rest.split_at(v.size());
            rest = others;
            self.values.set(reference, own);
            groups.extend(Group::of(v.quantity).map(|group| (group, reference)));
        }
        self.tune(references)?;
        groups.sort_unstable();
        groups.dedup_by_key(|(group, _)| *group);
        for (group, reference) in groups {
            let pushed = self.values.push(&self.table, group, &mut self.model);
            let name = |reference| self.table.get(reference).map_or("", |v| v.name.as_str());
            pushed.map_err(|error| format!("{}: {error}", name(reference)))?;
        }
        self.jump_in_event_mode(references)
    }

    /// Gives a model that has started the values of its tunable parameters among the variables; one that has not is
    /// rebuilt at the end of initialization.
    fn tune(&mut self, references: &[u32]) -> Result<(), Failure> {
        if !self.model.is_started() {
            return Ok(());
        }
        let value = |reference: &u32| match self.table.get(*reference)?.quantity {
            Quantity::Parameter(k) => Some((k, self.values.get(*reference)[0])),
            _ => None,
        };
        let tuned: Vec<(usize, f64)> = references.iter().filter_map(value).collect();
        self.model.set_parameters(&tuned).map_err(|error| error.to_string())
    }

    /// The variable with a value reference and a type.
    pub(super) fn variable(&self, reference: u32, kind: Type) -> Result<&Variable, Failure> {
        let count = self.table.variables.len();
        let found = self.table.get(reference);
        let v = found.ok_or_else(|| format!("value reference {reference}: must be less than {count}"))?;
        if v.kind != kind {
            return Err(format!("{}: is of type {:?}, not {kind:?}; use the function of its type", v.name, v.kind));
        }
        Ok(v)
    }

    /// Checks that variables exist, are of a type and have so many values together.
    pub(super) fn check_count(&self, references: &[u32], kind: Type, given: usize) -> Result<(), Failure> {
        let mut count = 0;
        for &reference in references {
            count += self.variable(reference, kind)?.size();
        }
        if count == given {
            return Ok(());
        }
        Err(format!("the number of values is {given}, must be {count}, that of all elements of the variables"))
    }
}
