//! What holds for the keys of a case: unit, range, hint, usual values and label, at the field of the key.
//!
//! Validation, the JSON Schema, the key reference, warnings about odd values and the report of `enmm report` read it.

mod range;
pub(crate) mod shared;
pub(crate) mod unit;

pub use range::{Plain, Range, rounded};
pub use unit::Unit;

use std::collections::BTreeMap;

use crate::key::{Check, Key, fail};

/// Defines a table of a case. A key may have a rule behind its type: `pub size: f64 => LENGTH.label("Size")`. A
/// `default struct` is a table whose keys may all be left out; `pub x: f64 = 1.0 => …` names a default that is not that
/// of the type.
macro_rules! keys {
    (
        $(#[$meta:meta])*
        $vis:vis default struct $table:ident {
            $($(#[$key_meta:meta])* $key_vis:vis $key:ident: $type:ty $(= $default:expr)? $(=> $rule:expr)?),* $(,)?
        }
    ) => {
        $crate::keys::keys! {
            @or Self::default();
            $(#[$meta])*
            #[serde(default)]
            $vis struct $table { $($(#[$key_meta])* $key_vis $key: $type $(=> $rule)?),* }
        }

        impl Default for $table {
            fn default() -> Self {
                Self { $($key: $crate::keys::keys!(@value $($default)?)),* }
            }
        }
    };
    (@value) => { Default::default() };
    (@value $default:expr) => { $default };
    (
        $(@or $default:expr;)?
        $(#[$meta:meta])*
        $vis:vis struct $table:ident {
            $($(#[$key_meta:meta])* $key_vis:vis $key:ident: $type:ty $(=> $rule:expr)?),* $(,)?
        }
    ) => {
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[cfg_attr(feature = "schema", schemars(transform = $crate::keys::Described($table::KEYS)))]
        #[serde(deny_unknown_fields)]
        $(#[$meta])*
        $vis struct $table {
            $($(#[$key_meta])* $key_vis $key: $type,)*
        }

        impl $table {
            /// Rules of the keys that have numbers.
            pub const KEYS: &[$crate::keys::Rule] = &[$($($rule.of_key(stringify!($key)),)?)*];

            /// Rule of a key.
            pub const fn rule(key: &str) -> $crate::keys::Rule {
                $crate::keys::rule_of(Self::KEYS, key)
            }

            /// Checks the numbers of the table `key` against their rules.
            ///
            /// # Errors
            /// The first number that is out of range.
            pub fn check(&self, key: &$crate::key::Key) -> $crate::key::Check {
                let default: Option<Self> = None$(.or(Some($default)))?;
                $($(
                    let rule = const { $rule.of_key(stringify!($key)) };
                    rule.check(key, &self.$key, default.as_ref().map(|table| &table.$key))?;
                )?)*
                let _ = (key, default);
                Ok(())
            }
        }
    };
}
pub(crate) use keys;

/// Defines the words that values of keys may be, one list for each.
macro_rules! words {
    ($(
        $(#[$meta:meta])*
        $vis:vis enum $name:ident { $($(#[$word_meta:meta])* $word:ident = $text:literal),* $(,)? }
    )*) => {$(
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        $(#[$meta])*
        $vis enum $name {
            $($(#[$word_meta])* #[serde(rename = $text)] $word,)*
        }

        impl $name {
            /// The word in a case.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$word => $text),*
                }
            }
        }
    )*};
}
pub(crate) use words;

/// What holds for the numbers of one key.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    /// The key, as the user writes it.
    pub key: &'static str,
    /// Unit of the numbers.
    pub unit: Unit,
    /// Values that are taken.
    pub range: Range,
    /// Remedy for a value out of range.
    hint: &'static str,
    /// Magnitudes that are usual, and words that say so.
    pub usual: Option<([f64; 2], &'static str)>,
    /// A value for those who have none.
    pub example: Option<f64>,
    /// Head of the column in the report; empty for keys that it leaves out.
    pub label: &'static str,
    /// Whether 0 means that the key has no effect, so that the report leaves it out.
    pub is_none_at_zero: bool,
    /// Names and units of the numbers of a row, if the key holds rows.
    columns: Option<[(&'static str, &'static str); 2]>,
}

impl Rule {
    const fn new(range: Range, unit: Unit) -> Self {
        let (key, hint, label) = ("", "", "");
        Self { key, unit, range, hint, usual: None, example: None, label, is_none_at_zero: false, columns: None }
    }

    /// Sets the key, unless it is written in another way than its field.
    pub const fn of_key(self, key: &'static str) -> Self {
        if self.key.is_empty() { self.written(key) } else { self }
    }

    /// Sets the key as the user writes it.
    pub const fn written(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// Sets the values that are taken.
    pub const fn in_range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// Sets the remedy for a value out of range; without one it is what is usual.
    pub const fn hint(self, hint: &'static str) -> Self {
        Self { hint, ..self }
    }

    /// Sets the magnitudes outside which a value is doubted, and words that say what is usual.
    pub const fn usual(self, range: [f64; 2], words: &'static str) -> Self {
        Self { usual: Some((range, words)), ..self }
    }

    /// Sets a value for those who have none.
    pub const fn example(self, value: f64) -> Self {
        Self { example: Some(value), ..self }
    }

    /// Sets the head of the column in the report.
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// Leaves 0 out of the report.
    pub const fn none_at_zero(self) -> Self {
        Self { is_none_at_zero: true, ..self }
    }

    const fn columns(self, columns: [(&'static str, &'static str); 2]) -> Self {
        Self { columns: Some(columns), ..self }
    }

    /// Checks the numbers of the key in a table. Where the rule has no remedy, it is the default.
    ///
    /// # Errors
    /// The first number that is out of range: the value, the limit and the remedy.
    pub fn check<T: Numbers>(&self, table: &Key, numbers: &T, default: Option<&T>) -> Check {
        let Some((mut place, value)) = numbers.first(&|value| !self.range.holds(value)) else { return Ok(()) };
        let column = self.columns.and_then(|columns| Some(columns[place.pop()? % columns.len()]));
        let key = place.iter().fold(table.field(self.key), |key, index| key.index(*index));
        let space = |unit: &str| if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let default = default.and_then(|numbers| numbers.first(&|_| true));
        let hint = match (self.hint, self.usual, default) {
            ("", Some((_, words)), _) => words.to_owned(),
            ("", None, Some((_, value))) => format!("{} is the default", Plain(value)),
            (hint, ..) => hint.to_owned(),
        };
        let (value, range) = (Plain(value), self.range);
        if let Some((name, unit)) = column {
            let (unit, most) = (space(unit), Plain(range.high()));
            let limit = format!("must be a finite number of at most {most}{unit} in magnitude");
            return fail(&key, format!("{name} is {value}{unit}, {limit}; {hint}"));
        }
        let finite = if value.0.is_finite() { "" } else { "a finite number, " };
        fail(&key, format!("is {value}{}, must be {finite}{range}; {hint}", space(self.unit.name)))
    }
}

/// Rule of a key; of one that is not there, a constant does not compile.
pub const fn rule_of(rules: &[Rule], key: &str) -> Rule {
    let mut k = 0;
    while !is_same(rules[k].key.as_bytes(), key.as_bytes()) {
        k += 1;
    }
    rules[k]
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    match (a, b) {
        ([], []) => true,
        ([x, a @ ..], [y, b @ ..]) => *x == *y && is_same(a, b),
        _ => false,
    }
}

/// Default of keys of tables that need other keys.
pub(crate) const fn one() -> f64 {
    1.0
}

/// Default of switches of such tables.
pub(crate) const fn yes() -> bool {
    true
}

/// Numbers of a key: one, none, or a list of them.
pub trait Numbers {
    /// The first number for which `wrong` holds, with its place in each list.
    fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)>;
}

macro_rules! numbers {
    ($($type:ty),*) => {
        $(impl Numbers for $type {
            fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
                wrong(*self as f64).then(|| (Vec::new(), *self as f64))
            }
        })*
    };
}
numbers!(f64, u32, u64, usize);

impl<T: Numbers> Numbers for Option<T> {
    fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
        self.as_ref()?.first(wrong)
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
        first_of(self, wrong)
    }
}

impl<T: Numbers> Numbers for BTreeMap<String, T> {
    fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
        self.values().find_map(|number| number.first(wrong))
    }
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn first(&self, wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
        first_of(self, wrong)
    }
}

fn first_of(list: &[impl Numbers], wrong: &dyn Fn(f64) -> bool) -> Option<(Vec<usize>, f64)> {
    list.iter().enumerate().find_map(|(k, item)| {
        let (mut place, value) = item.first(wrong)?;
        place.insert(0, k);
        Some((place, value))
    })
}

/// Rules whose units, labels, examples and ranges go into the schema of a table.
#[cfg(feature = "schema")]
pub(crate) struct Described(pub &'static [Rule]);

#[cfg(feature = "schema")]
impl schemars::transform::Transform for Described {
    fn transform(&mut self, schema: &mut schemars::Schema) {
        for rule in self.0 {
            let Some(property) = schema.pointer_mut(&format!("/properties/{}", rule.key)) else { continue };
            for (name, text) in [("unit", rule.unit.name), ("title", rule.label)] {
                if !text.is_empty() {
                    property[name] = text.into();
                }
            }
            if let Some(example) = rule.example {
                property["examples"] = [example].as_slice().into();
            }
            let mut number = property;
            while let Some(inner) =
                ["items", "additionalProperties"].into_iter().find(|name| number.get(name).is_some())
            {
                number = &mut number[inner];
            }
            if let Some(number) = number.as_object_mut() {
                rule.range.describe(number);
            }
        }
    }
}
