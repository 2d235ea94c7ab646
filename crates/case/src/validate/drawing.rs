//! Checks of the keys that say how a drawing becomes a section.

use super::checks::Names;
use crate::key::{Check, Key, fail, list};
use crate::{Case, Layer, LayerUse};

impl Case {
    /// Checks `layers`, `transform` and `domain.curve_tolerance`; readers of drawings do so before they open one.
    ///
    /// # Errors
    /// The first value that cannot be used.
    pub fn validate_drawing(&self) -> Check {
        let root = Key::root();
        self.domain.check(&root.field("domain"))?;
        let mut seen: Vec<String> = Vec::new();
        for (name, layer) in &self.layers {
            let key = root.field("layers").field(name);
            if seen.contains(&name.to_lowercase()) {
                return fail(&key, format!("layer {name:?} is there in other letters too; remove one"));
            }
            seen.push(name.to_lowercase());
            self.validate_layer(&key, layer)?;
        }
        self.transform.as_ref().map_or(Ok(()), |transform| transform.check(&root.field("transform")))
    }

    fn validate_layer(&self, key: &Key, layer: &Layer) -> Check {
        match (&layer.law, layer.role) {
            (Some(law), LayerUse::Joint) => Names::of_laws(self).must_hold(&key.field("law"), law)?,
            (Some(_), _) => {
                return fail(&key.field("law"), "has no effect on a layer without joints; write `use = \"joint\"`");
            }
            (None, _) => {}
        }
        let open = || self.bolts.iter().filter(|bolt| bolt.has_no_points()).filter_map(|bolt| bolt.name.as_deref());
        match (&layer.bolt, layer.role) {
            (Some(name), LayerUse::Bolt) if open().any(|other| other == name) => Ok(()),
            (Some(name), LayerUse::Bolt) => {
                let message = format!(
                    "no `[[bolt]]` without `points` is named {name:?}, there are: {}; add one with `name = {name:?}`, \
                     or remove its `points`",
                    list(open())
                );
                fail(&key.field("bolt"), message)
            }
            (None, LayerUse::Bolt) => {
                let message = "a layer of bolts needs `bolt`, the name of a `[[bolt]]` without `points`; add it";
                fail(&key.field("bolt"), message)
            }
            (Some(_), _) => fail(&key.field("bolt"), "has no effect on a layer without bolts; write `use = \"bolt\"`"),
            (None, _) => Ok(()),
        }
    }

    /// Refuses keys of a drawing that nothing has read.
    pub(crate) fn validate_drawing_is_used(&self) -> Check {
        let root = Key::root();
        let keys = [
            (root.field("layers"), !self.layers.is_empty()),
            (root.field("transform"), self.transform.is_some()),
            (root.field("domain").field("curve_tolerance"), self.domain.curve_tolerance.is_some()),
        ];
        keys.iter().find(|(_, given)| *given).map_or(Ok(()), |(key, _)| {
            fail(key, "has no effect without a drawing; add `domain.geometry_file` or remove it")
        })
    }
}
