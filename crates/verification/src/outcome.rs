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

    /// Sets the tolerance as a share of the exact value, and why it is as it is.
    pub fn relative(self, share: f64, reason: impl Into<String>) -> Self {
        self.within(Tolerance::Relative(share), reason)
    }

    /// Sets the tolerance in the row's unit, and why it is as it is.
    pub fn absolute(self, most: f64, reason: impl Into<String>) -> Self {
        self.within(Tolerance::Absolute(most), reason)
    }

    /// Sets the greatest magnitude, and why it is as it is.
    pub fn at_most(self, most: f64, reason: impl Into<String>) -> Self {
        self.within(Tolerance::AtMost(most), reason)
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
    /// Points that a line joins.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, marks: false }
    }

    /// Points as marks.
    pub fn marks(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, marks: true }
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

impl Plot {
    /// A plot without lines, on linear axes.
    pub fn new(title: impl Into<String>, axes: [&str; 2]) -> Self {
        Self { title: title.into(), axes: axes.map(str::to_owned), ..Self::default() }
    }

    /// Adds lines and marks.
    pub fn with(mut self, series: impl IntoIterator<Item = Series>) -> Self {
        self.series.extend(series);
        self
    }

    /// Adds a line.
    pub fn line(self, name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        self.with([Series::line(name, points)])
    }

    /// Adds marks.
    pub fn marks(self, name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        self.with([Series::marks(name, points)])
    }

    /// Adds computed points as marks beside the line of an exact function of their first coordinate.
    pub fn beside(self, name: &str, exact: impl Fn(f64) -> f64, points: Vec<[f64; 2]>) -> Self {
        let line = points.iter().map(|p| [p[0], exact(p[0])]).collect();
        self.line(name, line).marks("computed", points)
    }

    /// Sets which axes are logarithmic.
    pub fn logarithmic(self, logarithmic: [bool; 2]) -> Self {
        Self { logarithmic, ..self }
    }
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
