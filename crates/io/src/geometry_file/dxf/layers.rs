//! The meaning of the layers of a drawing: those that the case names, or those of the names of loops and laws.

use std::collections::BTreeMap;

use super::inserts::Placed;
use crate::geometry_file::Fault;
use crate::geometry_file::names::{Laws, Ring};
use enmm::model::Case;
use enmm::model::case::key::{Key, nearest};
use enmm::model::case::{Invalid, Layer, LayerUse};

/// Name that stands for every layer that a case does not name.
const OTHERS: &str = "*";
/// Layers that a message names.
const NAMED: usize = 40;

/// Place of the lines of a layer in the section.
#[derive(Debug, Clone)]
pub enum Target<'a> {
    /// A loop.
    Loop(Ring),
    /// Joints, of this law or the default one.
    Joint {
        /// Law by name.
        law: Option<String>,
        /// Whether the case says so, or has a law of this name.
        is_known: bool,
    },
    /// The water table.
    Water,
    /// Bolts of this name.
    Bolt(&'a str),
    /// Nothing.
    Ignore,
}

/// Layers of a drawing and of its case.
pub struct Layers<'a> {
    case: &'a Case,
    /// Those that the case names, by small letters.
    named: BTreeMap<String, &'a Layer>,
    /// Number of entities by type, by layer.
    counts: BTreeMap<&'a str, BTreeMap<&'a str, usize>>,
}

impl<'a> Layers<'a> {
    /// Looks up the layers of all entities.
    ///
    /// # Errors
    /// The case names a layer that the drawing does not have, or does not name one that it has.
    pub fn new(case: &'a Case, placed: &'a [Placed]) -> Result<Self, Fault> {
        let mut counts: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
        for entity in placed {
            *counts.entry(entity.layer).or_default().entry(entity.record.kind).or_default() += 1;
        }
        let named = case.layers.iter().map(|(name, layer)| (name.to_lowercase(), layer)).collect();
        let layers = Self { case, named, counts };
        for name in case.layers.keys().filter(|name| *name != OTHERS) {
            if !layers.counts.keys().any(|layer| layer.to_lowercase() == name.to_lowercase()) {
                let near = nearest(name, layers.counts.keys().copied());
                let near = near.map_or_else(String::new, |near| format!(", did you mean {near:?}?"));
                let message =
                    format!("the drawing has nothing on a layer {name:?}{near} Its layers: {}", layers.listed());
                return Err(Fault::case(&Key::root().field("layers").field(name), message));
            }
        }
        match layers.counts.keys().find(|layer| !case.layers.is_empty() && layers.rule(layer).is_none()) {
            Some(layer) => {
                let message = format!(
                    "does not say what layer {layer:?} is; add `[layers.{layer:?}]` with `use = \"joint\"` or \
                     another use, or `[layers.\"*\"]` with `use = \"ignore\"` for all others. Layers of the drawing: \
                     {}",
                    layers.listed()
                );
                Err(Fault::case(&Key::root().field("layers"), message))
            }
            None => Ok(layers),
        }
    }

    fn rule(&self, layer: &str) -> Option<&'a Layer> {
        self.named.get(&layer.to_lowercase()).or_else(|| self.named.get(OTHERS)).copied()
    }

    /// Returns the place of the lines of a layer.
    ///
    /// # Errors
    /// The layer of bolts names none.
    pub fn target(&self, layer: &str) -> Result<Target<'a>, Fault> {
        if self.case.layers.is_empty() {
            if let Some(ring) = Ring::named(layer) {
                return Ok(Target::Loop(ring));
            }
            let law = Laws::Of(self.case).of_layer(layer);
            return Ok(Target::Joint { is_known: law.is_some(), law });
        }
        let Some(rule) = self.rule(layer) else { return Ok(Target::Ignore) };
        Ok(match rule.role {
            LayerUse::Outline => Target::Loop(Ring::Outline),
            LayerUse::Hole => Target::Loop(Ring::Hole),
            LayerUse::Island => Target::Loop(Ring::Island),
            LayerUse::Joint => Target::Joint { law: rule.law.clone(), is_known: true },
            LayerUse::Water => Target::Water,
            LayerUse::Bolt => Target::Bolt(rule.bolt.as_deref().unwrap_or_default()),
            LayerUse::Ignore => Target::Ignore,
        })
    }

    /// Where to put a second outline.
    pub fn remedy_of_second_outline(&self) -> &'static str {
        if self.case.layers.is_empty() {
            "move it to layer \"ISLAND\""
        } else {
            "move it to a layer with `use = \"island\"`, or to one that is ignored"
        }
    }

    /// The error that neither drawing nor case has an outline; `closed` counts closed lines by layer.
    pub fn no_outline(&self, closed: &BTreeMap<String, usize>) -> Fault {
        let loops: Vec<String> = closed.iter().map(|(layer, count)| format!("{layer:?} ({count})")).collect();
        let remedy = match closed.keys().next() {
            Some(layer) => format!(
                "closed lines are on layer {}; write `[layers.{layer:?}]` with `use = \"outline\"` for that of the \
                 rock",
                loops.join(", ")
            ),
            None => "no line is closed; close that of the rock, on layer \"outline\"".to_string(),
        };
        let message =
            format!("the drawing has no outline, nor has the case: {remedy}. Layers of the drawing: {}", self.listed());
        Fault::case(&Key::root().field("domain").field("geometry_file"), message)
    }

    /// Layers with the numbers of their entities: `TERRAIN (1 LWPOLYLINE), FAULTS (3 LINE, 1 ARC)`.
    fn listed(&self) -> String {
        let kinds = |kinds: &BTreeMap<&str, usize>| {
            kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect::<Vec<_>>().join(", ")
        };
        let all: Vec<String> = self.counts.iter().map(|(name, of)| format!("{name} ({})", kinds(of))).collect();
        match all.len() {
            0 => "none".to_string(),
            count if count > NAMED => format!("{} and {} more", all[..NAMED].join(", "), count - NAMED),
            _ => all.join(", "),
        }
    }
}

impl Fault {
    /// The error at a key of the case.
    fn case(key: &Key, message: String) -> Self {
        Self::Case(Invalid { key: key.to_string(), message })
    }
}
