//! A number that outputs show: its names, unit, meaning and value, stated once for all files and interfaces.

/// A number that outputs show of a `T`.
#[derive(Debug, Clone, Copy)]
pub struct Quantity<T> {
    /// Name among its like: a field in C and Python, a column of `blocks.csv`, a key in `summary.json`, a number in the
    /// film.
    pub name: &'static str,
    /// Name among all others: a column of `history.csv`, a variable of an FMU.
    pub column: &'static str,
    /// Unit; empty for none.
    pub unit: &'static str,
    /// Description in a line.
    pub text: &'static str,
    /// Whether it counts something.
    pub is_count: bool,
    /// Its value.
    pub get: fn(&T) -> f64,
}

impl<T> Quantity<T> {
    /// A number with a unit.
    pub const fn new(names: [&'static str; 2], unit: &'static str, text: &'static str, get: fn(&T) -> f64) -> Self {
        let [name, column] = names;
        Self { name, column, unit, text, is_count: false, get }
    }

    /// A number that has the same name everywhere.
    pub const fn plain(name: &'static str, unit: &'static str, text: &'static str, get: fn(&T) -> f64) -> Self {
        Self::new([name, name], unit, text, get)
    }

    /// A number of things.
    pub const fn count(names: [&'static str; 2], text: &'static str, get: fn(&T) -> f64) -> Self {
        Self { is_count: true, ..Self::new(names, "", text, get) }
    }
}
