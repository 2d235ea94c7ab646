//! Results of a problem: rows of computed against exact, and plots.

/// How far a computed value may be from the exact one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// |computed − exact| ≤ this·|exact|.
    Relative(f64),
    /// |computed − exact| ≤ this, in the row's unit.
    Absolute(f64),
    /// |computed| ≤ this: the exact value is zero or a bound.
    AtMost(f64),
    /// Not judged: shown for comparison.
    Shown,
}

/// Where the exact value comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Origin {
    /// A closed form, evaluated with the problem's parameters.
    ClosedForm,
    /// A number printed by others.
    Published(&'static str),
    /// Another numerical solution, computed here.
    Numerical(&'static str),
}

/// One value beside its exact one.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name, with the variant of the problem.
    pub quantity: String,
    /// Unit.
    pub unit: &'static str,
    /// Value of the engine.
    pub computed: f64,
    /// Exact value.
    pub exact: f64,
    /// How far apart they may be.
    pub tolerance: Tolerance,
    /// Why this far.
    pub reason: String,
    /// Where the exact value comes from.
    pub origin: Origin,
}

impl Row {
    /// A row against a closed form.
    pub fn new(quantity: impl Into<String>, unit: &'static str, computed: f64, exact: f64) -> Self {
        let quantity = quantity.into();
        let (tolerance, origin) = (Tolerance::Shown, Origin::ClosedForm);
        Self { quantity, unit, computed, exact, tolerance, reason: String::new(), origin }
    }

    /// Sets the tolerance and why it is as it is.
    pub fn within(self, tolerance: Tolerance, reason: impl Into<String>) -> Self {
        Self { tolerance, reason: reason.into(), ..self }
    }

    /// Sets where the exact value comes from.
    pub fn from(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }

    /// Relative error where the exact value is not zero, else the absolute one.
    pub fn error(&self) -> f64 {
        let difference = self.computed - self.exact;
        if self.exact == 0.0 { difference } else { difference / self.exact.abs() }
    }

    /// Whether the value is near enough; a value that is no number never is.
    pub fn passes(&self) -> bool {
        let difference = (self.computed - self.exact).abs();
        match self.tolerance {
            Tolerance::Relative(share) => difference <= share * self.exact.abs(),
            Tolerance::Absolute(most) => difference <= most,
            Tolerance::AtMost(most) => self.computed.abs() <= most,
            Tolerance::Shown => self.computed.is_finite(),
        }
    }
}

/// A line of a plot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points.
    pub points: Vec<[f64; 2]>,
    /// Marks instead of a line.
    pub marks: bool,
}

impl Series {
    /// Computed points as marks beside the line of an exact function of their first coordinate.
    pub fn beside(name: &str, exact: impl Fn(f64) -> f64, points: Vec<[f64; 2]>) -> Vec<Self> {
        let line = points.iter().map(|p| [p[0], exact(p[0])]).collect();
        vec![
            Self { name: name.to_owned(), points: line, marks: false },
            Self { name: "computed".to_owned(), points, marks: true },
        ]
    }
}

/// A plot of a problem.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Names of both axes with their units.
    pub axes: [String; 2],
    /// Whether each axis is logarithmic.
    pub logarithmic: [bool; 2],
    /// Lines.
    pub series: Vec<Series>,
}

/// Results of a problem.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outcome {
    /// Rows.
    pub rows: Vec<Row>,
    /// Plots.
    pub plots: Vec<Plot>,
}

impl Outcome {
    /// Whether all rows pass and there is one.
    pub fn passes(&self) -> bool {
        !self.rows.is_empty() && self.rows.iter().all(Row::passes)
    }
}
