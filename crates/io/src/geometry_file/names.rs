//! Names that a file gives to its lines: loops, joint laws, and layers of a drawing that it was converted from.

use enmm::model::Case;

/// Words for loops, in any letter case.
const LOOPS: [&str; 3] = ["outline", "hole", "island"];
/// Names of the property or column with the law, as [`tidy`] gives them.
const LAW: [&str; 2] = ["law", "joint_law"];
/// That of the layer of a drawing, as `ogr2ogr` and QGIS write it.
const LAYER: &str = "layer";

/// A kind of loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ring {
    /// Outer loop of the rock.
    Outline,
    /// Loop cut out of it.
    Hole,
    /// Loop of rock inside a hole or beside the outline.
    Island,
}

impl Ring {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Outline, Self::Hole, Self::Island];

    /// The loop that a name stands for.
    pub fn named(name: &str) -> Option<Self> {
        let which = LOOPS.iter().position(|word| name.trim().eq_ignore_ascii_case(word))?;
        Self::ALL.get(which).copied()
    }
}

/// Use of a property or a column by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// It holds the joint law, or the word for a loop.
    Law,
    /// It holds the layer.
    Layer,
}

impl Purpose {
    /// The purpose of a name.
    pub fn named(name: &str) -> Option<Self> {
        match tidy(name).as_str() {
            name if LAW.contains(&name) => Some(Self::Law),
            LAYER => Some(Self::Layer),
            _ => None,
        }
    }
}

/// A name without spaces around it, in small letters and with one sign between its words.
pub fn tidy(name: &str) -> String {
    name.trim().to_lowercase().replace([' ', '-'], "_")
}

/// Part of the section that a line is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Part {
    /// A loop.
    Ring(Ring),
    /// A joint of this law, with the key that names it, or of the default one.
    Joint(Option<(String, String)>),
    /// A joint on a layer without a law of its name.
    Lawless(String),
}

impl Part {
    /// Whether another part has the same loop or law, whichever key names it.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Joint(Some((law, _))), Self::Joint(Some((other, _)))) => law == other,
            _ => self == other,
        }
    }

    /// The part that a line with this law is, or else one on this layer; both with their keys.
    pub fn of(law: Option<(String, String)>, layer: Option<(String, String)>, laws: &Laws) -> Self {
        let word = law.as_ref().or(layer.as_ref()).and_then(|(name, _)| Ring::named(name));
        match (word, law, layer) {
            (Some(ring), ..) => Self::Ring(ring),
            (None, Some((law, key)), _) => Self::Joint(Some((law.trim().to_owned(), key))),
            (None, None, Some((layer, key))) => match laws.of_layer(&layer) {
                Some(law) => Self::Joint(Some((law, key))),
                None => Self::Lawless(layer),
            },
            (None, None, None) => Self::Joint(None),
        }
    }
}

/// Joint laws that layers can name.
pub enum Laws<'a> {
    /// Those of a case.
    Of(&'a Case),
    /// Any: there is no case yet.
    Any,
}

impl Laws<'_> {
    /// The law with the name of a layer: exactly, or else the only one in other letter case.
    pub fn of_layer(&self, layer: &str) -> Option<String> {
        let layer = layer.trim();
        let Self::Of(case) = self else { return Some(layer.to_owned()) };
        if case.joint_laws.contains_key(layer) {
            return Some(layer.to_owned());
        }
        let mut alike = case.joint_laws.keys().filter(|law| law.to_lowercase() == layer.to_lowercase());
        let only = alike.next()?;
        alike.next().is_none().then(|| only.clone())
    }
}
