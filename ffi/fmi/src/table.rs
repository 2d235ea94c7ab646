//! The one table of variables: both model descriptions, every getter and every setter follow it.

use enmm::cosimulation::limits::{ACCELERATION_MAX, FACTOR_MAX, LEVEL_MAX, RAIN_MAX, THREADS_MAX, VALUE_MAX};
use enmm::cosimulation::{Named, PORT_QUANTITIES, Parameter, PortKind, TOTALS, parameters};
use enmm::model::case::Port;
use enmm::model::case::keys::Plain;
use enmm::model::{
    BLOCK_QUANTITIES, BlockState, Case, ENERGIES, INLET_QUANTITIES, JOINT_MONITOR_QUANTITIES, MONITOR_QUANTITIES,
    MONITOR_STRESS_QUANTITIES,
};
use uuid::Uuid;

/// Version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0, which also has arrays and binaries.
    Three,
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// FMI 2 `Real`, FMI 3 `Float64`.
    Real,
    /// FMI 2 `Integer`, FMI 3 `Int32`.
    Integer,
    /// `Boolean`.
    Boolean,
    /// `String`.
    String,
    /// FMI 3 `Binary`.
    Binary,
}

/// Role of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Time itself.
    Independent,
    /// Set before initialization ends.
    Parameter,
    /// Set by the importer at any communication point.
    Input,
    /// Read by the importer.
    Output,
    /// An output under an older name, which importers need not list.
    Local,
}

/// Direction of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal.
    X,
    /// Vertical, up.
    Y,
}

/// An output of the whole model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Total {
    /// An energy or a work: its place in [`ENERGIES`].
    Energy(usize),
    /// A sum or an extreme: its place in [`TOTALS`].
    Extreme(usize),
    /// Internal step (s).
    InternalDt,
    /// Blocks, those included that have come from others by cuts.
    PartCount,
    /// Sections of rock that have broken.
    CutCount,
    /// Their length (m).
    CutLength,
    /// Events so far.
    EventCount,
    /// Time of the last event (s); 0 when there was none.
    LastEventTime,
    /// Last event: 0 none, 1 block detached, 2 joint slipped, 3 block failed, 4 two blocks overlap, 5 bond broken,
    /// 6 block cut.
    LastEventKind,
    /// Block or joint of the last event; −1 when there was none, or for a contact away from joints.
    LastEventSubject,
}

/// Meaning of a variable. Indices count ports, monitors and parameters in the order of the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Time (s).
    Time,
    /// The whole state as bytes.
    Snapshot,
    /// Property of the case, see [`Table::parameters`].
    Parameter(usize),
    /// Threads of a step.
    Threads,
    /// Whether inputs are interpolated over a communication step.
    InterpolateInputs,
    /// Folder to record results into.
    ResultsFolder,
    /// Gravity (m/s²).
    Gravity(Axis),
    /// Acceleration of the base (m/s²).
    BaseAcceleration(Axis),
    /// Height of the water (m).
    WaterLevel,
    /// Factor on the strength of joints.
    StrengthFactor,
    /// Force on the block of a port (N/m), added to that of the arrays.
    PortForce(usize, Axis),
    /// Moment on the block of a port (N·m/m).
    PortMoment(usize),
    /// Traction on a boundary (Pa).
    PortTraction(usize, Axis),
    /// Pressure on a boundary or in joints (Pa).
    PortPressure(usize),
    /// Velocity of the wave that comes in through a quiet boundary, or of supports (m/s).
    PortVelocity(usize, Axis),
    /// Forces on all blocks (N/m).
    BlockForce(Axis),
    /// Moments on all blocks (N·m/m).
    BlockMoment,
    /// Level of a head of water in joints (m).
    Head(usize),
    /// Rate of rain (m/s).
    Rain(usize),
    /// Whether a drain acts.
    Drain(usize),
    /// Output of a head, a rain or a drain, by its place: its place in [`INLET_QUANTITIES`].
    Inlet(Named, usize, usize),
    /// Output of a port: its place in [`PORT_QUANTITIES`].
    Port(usize, usize),
    /// Output of a monitor: its place in [`MONITOR_QUANTITIES`].
    Monitor(usize, usize),
    /// Stress at a monitor: its place in [`MONITOR_STRESS_QUANTITIES`].
    MonitorStress(usize, usize),
    /// Output of a monitor of a joint: its place in [`JOINT_MONITOR_QUANTITIES`].
    JointMonitor(usize, usize),
    /// Output of the whole model.
    Total(Total),
    /// Output of all blocks: its place in [`BLOCK_QUANTITIES`].
    Blocks(usize),
    /// Output of one block, by its id: its place in [`BLOCK_QUANTITIES`].
    Block(usize, usize),
}

impl Quantity {
    /// Whether the value is a function of the state of the model alone: an input that is set does not change it before
    /// the next step. Everything but the snapshot is such, which holds the inputs.
    pub fn is_of_state(self) -> bool {
        let of_places = matches!(self, Self::Port(..) | Self::Monitor(..) | Self::Inlet(..));
        let of_gauges = matches!(self, Self::MonitorStress(..) | Self::JointMonitor(..));
        of_places || of_gauges || matches!(self, Self::Blocks(_) | Self::Block(..) | Self::Total(_))
    }
}

/// One variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Value reference, unique across all types.
    pub reference: u32,
    /// Name, without control characters.
    pub name: String,
    /// Description, with sign and when it acts.
    pub description: String,
    /// Unit name of the model description; empty for none.
    pub unit: &'static str,
    /// Type.
    pub kind: Type,
    /// Role.
    pub causality: Causality,
    /// Order of magnitude of a number that changes continuously.
    pub nominal: Option<f64>,
    /// Start value of a parameter or an input; a Boolean is 0 or 1.
    pub start: Option<f64>,
    /// Least and greatest value of a number that can be set.
    pub limits: Option<(f64, f64)>,
    /// Whether a parameter may be set after initialization.
    pub is_tunable: bool,
    /// Number of elements of an array; `None` for a scalar.
    pub length: Option<usize>,
    /// Name of the port that it belongs to.
    pub port: Option<String>,
    /// Its meaning.
    pub quantity: Quantity,
}

impl Variable {
    /// Whether the value may change at any time, and not only at events: a number with decimals that is no parameter.
    pub fn is_continuous(&self) -> bool {
        let jumps = matches!(self.quantity, Quantity::Total(Total::LastEventTime));
        self.kind == Type::Real && self.causality != Causality::Parameter && !jumps
    }

    /// Whether a length is a motion or a depth of contacts, and not a place.
    pub fn is_motion(&self) -> bool {
        ["displacement", "slip", "penetration", "overlap"].iter().any(|word| self.name.contains(word))
    }

    /// Checks a value that is to be set.
    ///
    /// # Errors
    /// It is not finite, or beyond the limits.
    pub fn check(&self, value: f64) -> Result<(), String> {
        let Self { name, unit, limits, .. } = self;
        if !value.is_finite() {
            return Err(format!("{name}: is {value}, must be a finite number; the old value still holds"));
        }
        match limits {
            Some((low, high)) if !(*low..=*high).contains(&value) => Err(format!(
                "{name}: is {}, must be at least {} and at most {} {unit}; the old value still holds",
                Plain(value),
                Plain(*low),
                Plain(*high)
            )),
            _ => Ok(()),
        }
    }

    /// Number of values: those of an array, or 1.
    pub fn size(&self) -> usize {
        self.length.unwrap_or(1)
    }
}

/// All variables of one FMU, ordered by value reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Version of the standard.
    pub version: Version,
    /// The variables.
    pub variables: Vec<Variable>,
    /// Properties of the case that are parameters.
    pub parameters: Vec<Parameter>,
    /// Token that ties a model description to a library and a resource.
    pub token: String,
}

impl Table {
    /// The variables of a case with so many blocks at most; `hash` is the fingerprint of the case.
    pub fn new(case: &Case, blocks: usize, hash: &str, version: Version) -> Self {
        let parameters = parameters(case);
        let mut rows = Rows { variables: Vec::new(), blocks };
        if version == Version::Three {
            rows.push("time", "Simulated time", "s", Type::Real, Causality::Independent, Quantity::Time);
        }
        rows.parameters(&parameters);
        rows.inputs(case, version);
        rows.outputs(case, version);
        case.fmu.iter().flat_map(|notes| &notes.blocks).for_each(|&block| rows.block(block as usize));
        rows.results_folder();
        if case.has_cuts() {
            BREAKING_TOTALS.into_iter().for_each(|total| rows.total(total));
        }
        if case.flow.is_some() {
            rows.flow(case);
        }
        set_nominals(&mut rows.variables, case);
        let token = token(&rows.variables, hash, version);
        Self { version, variables: rows.variables, parameters, token }
    }

    /// The variable with a value reference.
    pub fn get(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(reference as usize)
    }

    /// The quantity whose value is the time derivative of another, for FMI output derivatives.
    pub fn derivative(quantity: Quantity) -> Option<Quantity> {
        match quantity {
            Quantity::Port(port, place) => {
                place_of(&PORT_QUANTITIES, rate_of(PORT_QUANTITIES[place].name)?).map(|rate| Quantity::Port(port, rate))
            }
            Quantity::Monitor(k, place) => {
                let rate = rate_of(MONITOR_QUANTITIES[place].name)?;
                place_of(&MONITOR_QUANTITIES, rate).map(|rate| Quantity::Monitor(k, rate))
            }
            Quantity::Blocks(place) => block_rate(place).map(Quantity::Blocks),
            Quantity::Block(block, place) => block_rate(place).map(|rate| Quantity::Block(block, rate)),
            _ => None,
        }
    }
}

/// Name of the time derivative of a motion.
fn rate_of(name: &str) -> Option<&'static str> {
    match name {
        "displacement_x" => Some("velocity_x"),
        "displacement_y" => Some("velocity_y"),
        "rotation" => Some("angular_velocity"),
        _ => None,
    }
}

/// Place of the time derivative of a quantity of blocks.
fn block_rate(place: usize) -> Option<usize> {
    place_of(&BLOCK_QUANTITIES, rate_of(BLOCK_QUANTITIES[place].name)?)
}

/// Checks the ids of the blocks that the notes of a case name.
///
/// # Errors
/// The case has no such block.
pub fn check_blocks(case: &Case, blocks: usize) -> Result<(), String> {
    let named = case.fmu.iter().flat_map(|notes| notes.blocks.iter().enumerate());
    match named.into_iter().find(|(_, block)| **block as usize >= blocks) {
        None => Ok(()),
        Some((k, block)) => Err(format!(
            "fmu.blocks[{k}]: is {block}, must be less than the number of blocks, {blocks}; the pictures of \
             `enmm check -o` show their ids"
        )),
    }
}

/// Sets orders of magnitude, those of the weight of a piece of rock as large as an element.
fn set_nominals(variables: &mut [Variable], case: &Case) {
    let density = case.rocks.values().map(|rock| rock.density).fold(1.0, f64::max);
    let gravity = Some(case.gravity.x.hypot(case.gravity.y)).filter(|&g| g > 0.0).unwrap_or(10.0);
    let (size, stress) = (case.mesh.size, density * gravity * case.mesh.size);
    for v in variables.iter_mut().filter(|v| v.is_continuous()) {
        let magnitude = match v.unit {
            "m" if v.is_motion() => 1e-3,
            "m" => size,
            "m/s" | "rad/s" => 1e-2,
            "m/s2" => gravity,
            "rad" => 1e-3,
            "N/m" => stress * size,
            "N.m/m" => stress * size * size,
            "J/m" => stress * size * 1e-3,
            "Pa" => stress,
            _ => continue,
        };
        v.nominal = Some(10_f64.powf(magnitude.log10().round()));
    }
}

/// Place of a quantity in a table of the engine.
fn place_of<T>(table: &[Row<T>], name: &str) -> Option<usize> {
    table.iter().position(|quantity| quantity.name == name)
}

/// UUID version 5 of the interface and the case behind it.
fn token(variables: &[Variable], hash: &str, version: Version) -> String {
    let mut text = format!("enmm {} {version:?} {hash}\n", enmm::engine_version());
    for v in variables {
        text += &format!(
            "{} {} {:?} {:?} {:?} {:?} {}\n",
            v.reference, v.name, v.kind, v.causality, v.start, v.length, v.unit
        );
    }
    Uuid::new_v5(&Uuid::NAMESPACE_OID, text.as_bytes()).to_string()
}

/// The kind of a port of a case.
pub fn port_kind(port: &Port) -> PortKind {
    match port {
        Port { boundary: Some(_), .. } => PortKind::Boundary,
        Port { joint: Some(_), .. } => PortKind::Joint,
        Port { quiet: Some(_), .. } => PortKind::Quiet,
        Port { fix: Some(_), .. } => PortKind::Fix,
        _ => PortKind::Block,
    }
}

/// The name with control characters, which no importer can take, and their escape sign written out: `\u{9}` for a tab.
/// Different names stay different.
fn plain(name: &str) -> String {
    let bad = |c: char| c.is_control() || matches!(c, '\\' | '\u{fffe}' | '\u{ffff}');
    name.chars().map(|c| if bad(c) { c.escape_unicode().to_string() } else { c.to_string() }).collect()
}

/// Least and greatest value of an input: those that the model itself takes.
fn input_limits(quantity: Quantity) -> Option<(f64, f64)> {
    let most = match quantity {
        Quantity::Gravity(_) | Quantity::BaseAcceleration(_) => ACCELERATION_MAX,
        Quantity::WaterLevel | Quantity::Head(_) => LEVEL_MAX,
        Quantity::Rain(_) => return Some((0.0, RAIN_MAX)),
        Quantity::StrengthFactor => return Some((0.0, FACTOR_MAX)),
        _ => VALUE_MAX,
    };
    Some((-most, most))
}

/// Rows in the making.
struct Rows {
    variables: Vec<Variable>,
    blocks: usize,
}

const ACTS: &str = "acts from the start of the next step on, or linearly over it with interpolate_inputs";

impl Rows {
    fn push(
        &mut self,
        name: &str,
        what: &str,
        unit: &'static str,
        kind: Type,
        causality: Causality,
        quantity: Quantity,
    ) {
        self.variables.push(Variable {
            reference: self.variables.len() as u32,
            name: plain(name),
            description: what.to_owned(),
            unit,
            kind,
            causality,
            nominal: None,
            start: None,
            limits: None,
            is_tunable: false,
            length: None,
            port: None,
            quantity,
        });
    }

    fn last(&mut self) -> &mut Variable {
        let last = self.variables.len() - 1;
        &mut self.variables[last]
    }

    fn parameter(
        &mut self,
        name: &str,
        what: &str,
        unit: &'static str,
        kind: Type,
        quantity: Quantity,
    ) -> &mut Variable {
        self.push(name, what, unit, kind, Causality::Parameter, quantity);
        self.last()
    }

    fn input(&mut self, name: &str, what: &str, unit: &'static str, start: f64, quantity: Quantity) -> &mut Variable {
        self.push(name, &format!("{what}; {ACTS}"), unit, Type::Real, Causality::Input, quantity);
        let row = self.last();
        (row.start, row.limits) = (Some(start), input_limits(quantity));
        row
    }

    fn output(&mut self, name: &str, what: &str, unit: &'static str, quantity: Quantity) -> &mut Variable {
        self.push(name, what, unit, Type::Real, Causality::Output, quantity);
        self.last()
    }

    fn parameters(&mut self, parameters: &[Parameter]) {
        for (k, p) in parameters.iter().enumerate() {
            let row = self.parameter(&p.name, &p.description, p.unit, Type::Real, Quantity::Parameter(k));
            // The value of the case itself is always allowed.
            (row.start, row.limits) = (Some(p.start), Some((p.low.min(p.start), p.high.max(p.start))));
            row.is_tunable = p.is_tunable;
        }
        let what = "Threads that a step uses; results do not depend on it";
        let row = self.parameter("threads", what, "", Type::Integer, Quantity::Threads);
        (row.start, row.limits) = (Some(1.0), Some((1.0, THREADS_MAX as f64)));
        let what = "Whether a new input is reached linearly at the end of the next step instead of holding over it";
        self.parameter("interpolate_inputs", what, "", Type::Boolean, Quantity::InterpolateInputs).start = Some(0.0);
    }

    fn inputs(&mut self, case: &Case, version: Version) {
        let what = "Acceleration of gravity, x";
        self.input("gravity_x", what, "m/s2", case.gravity.x, Quantity::Gravity(Axis::X));
        let what = "Acceleration of gravity, y up: -9.81 on earth";
        self.input("gravity_y", what, "m/s2", case.gravity.y, Quantity::Gravity(Axis::Y));
        for (axis, letter) in AXES {
            let what = format!("Acceleration of the base, {letter}; rock feels the opposite; begins at time 0");
            let quantity = Quantity::BaseAcceleration(axis);
            self.input(&format!("base_acceleration_{letter}"), &what, "m/s2", 0.0, quantity);
        }
        if let Some(water) = &case.water {
            let what = "Height y of the free water surface";
            self.input("water_level", what, "m", water.start_level(), Quantity::WaterLevel);
        }
        let what = "Factor on cohesion, tan(friction angle) and tensile strength of joints and rock";
        self.input("strength_factor", what, "", 1.0, Quantity::StrengthFactor);
        for (k, port) in case.ports.iter().enumerate() {
            self.port_inputs(k, port);
        }
        if version == Version::Three {
            self.block_inputs();
        }
    }

    fn port_inputs(&mut self, k: usize, port: &Port) {
        let (name, kind) = (&port.name, port_kind(port));
        let mut add = |word: &str, what: &str, unit, start: f64, quantity| {
            let what = format!("{what}, port {name}");
            self.input(&format!("{name}.{word}"), &what, unit, start, quantity).port = Some(name.clone());
        };
        for ((axis, letter), component) in AXES.into_iter().zip([0, 1]) {
            if kind == PortKind::Block {
                let what = format!("Force per metre of depth through the centroid of the block, {letter}");
                let start = port.force[component];
                add(&format!("force_{letter}"), &what, "N/m", start, Quantity::PortForce(k, axis));
            }
            let velocity = Quantity::PortVelocity(k, axis);
            if kind == PortKind::Quiet {
                let what = format!("Particle velocity of the wave that comes in through the quiet boundary, {letter}");
                add(&format!("wave_{letter}"), &what, "m/s", 0.0, velocity);
            }
            if kind == PortKind::Fix {
                let what = format!("Velocity with which the held place is moved, {letter}");
                add(&format!("velocity_{letter}"), &what, "m/s", 0.0, velocity);
            }
            if kind == PortKind::Boundary {
                let what = format!("Traction on the boundary, {letter}, global axes, per reference length");
                let start = port.traction[component];
                add(&format!("traction_{letter}"), &what, "Pa", start, Quantity::PortTraction(k, axis));
            }
        }
        let pressure = Quantity::PortPressure(k);
        match kind {
            PortKind::Block => {
                let what = "Moment per metre of depth about the centroid of the block, counter-clockwise";
                add("moment", what, "N.m/m", port.moment, Quantity::PortMoment(k));
            }
            PortKind::Boundary => {
                let what = "Pressure on the boundary, pushing into the rock";
                add("pressure", what, "Pa", port.pressure, pressure);
            }
            PortKind::Joint => {
                let what = "Fluid pressure in the joints, pushing on both faces";
                add("pressure", what, "Pa", port.pressure, pressure);
            }
            PortKind::Quiet | PortKind::Fix => {}
        }
    }

    fn block_inputs(&mut self) {
        let blocks = self.blocks;
        for (axis, letter) in AXES {
            let what = format!("Force per metre of depth through the centroid of every block, {letter}");
            let name = format!("block_force_{letter}");
            self.input(&name, &what, "N/m", 0.0, Quantity::BlockForce(axis)).length = Some(blocks);
        }
        let what = "Moment per metre of depth about the centroid of every block, counter-clockwise";
        self.input("block_moment", what, "N.m/m", 0.0, Quantity::BlockMoment).length = Some(blocks);
    }

    fn outputs(&mut self, case: &Case, version: Version) {
        for (k, port) in case.ports.iter().enumerate() {
            port_outputs(port_kind(port)).iter().for_each(|name| self.port_output(k, port, name));
        }
        for (k, monitor) in case.monitors.iter().enumerate() {
            for (place, quantity) in MONITOR_QUANTITIES.iter().enumerate() {
                let name = format!("monitor.{}.{}", monitor.name, quantity.name);
                let what = format!("{}, monitor {}", quantity.text, monitor.name);
                self.output(&name, &what, quantity.unit, Quantity::Monitor(k, place));
            }
        }
        self.gauges(case);
        let Rowed { first, later, .. } = totals();
        first.into_iter().for_each(|total| self.total(total));
        if version == Version::Three {
            self.block_outputs();
        }
        later.into_iter().for_each(|total| self.total(total));
    }

    /// Outputs of monitors of stress and of joints.
    fn gauges(&mut self, case: &Case) {
        for (k, monitor) in case.monitors.iter().enumerate().filter(|(_, monitor)| monitor.stress) {
            for (place, quantity) in MONITOR_STRESS_QUANTITIES.iter().enumerate() {
                let name = format!("monitor.{}.{}", monitor.name, quantity.name);
                let what = format!("{}, monitor {}", quantity.text, monitor.name);
                self.output(&name, &what, quantity.unit, Quantity::MonitorStress(k, place));
            }
        }
        for (k, monitor) in case.joint_monitors.iter().enumerate() {
            for (place, quantity) in JOINT_MONITOR_QUANTITIES.iter().enumerate() {
                let name = format!("joint_monitor.{}.{}", monitor.name, quantity.name);
                let what = format!("{}, joint monitor {}", quantity.text, monitor.name);
                self.output(&name, &what, quantity.unit, Quantity::JointMonitor(k, place));
            }
        }
    }

    /// Inputs and outputs of water that flows in joints, behind all that other cases have.
    fn flow(&mut self, case: &Case) {
        for (k, head) in case.heads.iter().enumerate() {
            let what = format!("Level of the head where the flow in joints is found, head {}", head.name);
            self.input(&format!("{}.head", head.name), &what, "m", head.level, Quantity::Head(k));
        }
        for (k, rain) in case.rains.iter().enumerate() {
            let what = format!("Rain on each square metre in plan where the flow in joints is found, {}", rain.name);
            self.input(&format!("{}.rate", rain.name), &what, "m/s", rain.rate, Quantity::Rain(k));
        }
        for (k, drain) in case.drains.iter().enumerate() {
            let what = format!("Whether the drain acts, drain {}; a switch at the start of the next step", drain.name);
            let name = format!("{}.active", drain.name);
            self.push(&name, &what, "", Type::Boolean, Causality::Input, Quantity::Drain(k));
            let acts = drain.active || case.stages.iter().take(1).any(|stage| stage.drain.contains(&drain.name));
            self.last().start = Some(if acts { 1.0 } else { 0.0 });
        }
        case.heads.iter().enumerate().for_each(|(k, head)| self.inlet(Named::Head, k, &head.name, &["inflow"]));
        for (k, rain) in case.rains.iter().enumerate() {
            self.inlet(Named::Rain, k, &rain.name, &["inflow", "run_off"]);
        }
        case.drains.iter().enumerate().for_each(|(k, drain)| self.inlet(Named::Drain, k, &drain.name, &["outflow"]));
        for (k, port) in case.ports.iter().enumerate().filter(|(_, port)| port_kind(port) == PortKind::Joint) {
            FLOW_PORT_OUTPUTS.into_iter().for_each(|name| self.port_output(k, port, name));
        }
        totals().flow.into_iter().for_each(|total| self.total(total));
    }

    /// Outputs of a head, a rain or a drain.
    fn inlet(&mut self, kind: Named, k: usize, of: &str, names: &[&str]) {
        for place in names.iter().filter_map(|name| place_of(&INLET_QUANTITIES, name)) {
            let quantity = &INLET_QUANTITIES[place];
            let (name, what) = (format!("{of}.{}", quantity.name), format!("{}, {of}", quantity.text));
            self.output(&name, &what, quantity.unit, Quantity::Inlet(kind, k, place));
        }
    }

    /// An output of a port by its name in [`PORT_QUANTITIES`].
    fn port_output(&mut self, k: usize, port: &Port, name: &str) {
        let Some(place) = place_of(&PORT_QUANTITIES, name) else { return };
        let quantity = &PORT_QUANTITIES[place];
        let (name, what) = (format!("{}.{name}", port.name), format!("{}, port {}", quantity.text, port.name));
        self.output(&name, &what, quantity.unit, Quantity::Port(k, place)).port = Some(port.name.clone());
    }

    /// Outputs of one block.
    fn block(&mut self, block: usize) {
        for (place, quantity) in BLOCK_QUANTITIES.iter().enumerate().filter(|(_, q)| !q.column.is_empty()) {
            let name = format!("block_{block}.{}", quantity.name);
            let what = format!("{}, block {block}", quantity.text);
            let row = self.output(&name, &what, quantity.unit, Quantity::Block(block, place));
            if quantity.is_count {
                row.kind = Type::Integer;
            }
        }
    }

    /// Stands behind all that were there before it, so that it moves no value reference.
    fn results_folder(&mut self) {
        let what = "Folder to record the results of the run into, with pictures and summary; empty for none";
        self.parameter("results_folder", what, "", Type::String, Quantity::ResultsFolder);
    }

    fn total(&mut self, (total, name, what, unit, kind): TotalRow) {
        let row = self.output(name, what, unit, Quantity::Total(total));
        row.kind = kind;
        if name == FORMER[0] {
            row.causality = Causality::Local;
        }
    }

    fn block_outputs(&mut self) {
        let blocks = self.blocks;
        let first = |quantity: &&Row<BlockState>| FIRST_BLOCK_OUTPUTS.iter().position(|name| *name == quantity.column);
        let mut shown: Vec<&Row<BlockState>> = BLOCK_QUANTITIES.iter().filter(|q| !q.column.is_empty()).collect();
        shown.sort_by_key(|quantity| first(quantity).unwrap_or(FIRST_BLOCK_OUTPUTS.len()));
        for quantity in shown {
            let Some(place) = place_of(&BLOCK_QUANTITIES, quantity.name) else { continue };
            let what = format!("{}, every block", quantity.text);
            let row = self.output(quantity.column, &what, quantity.unit, Quantity::Blocks(place));
            row.length = Some(blocks);
            if quantity.is_count {
                row.kind = Type::Integer;
            }
        }
        let what = "The whole state as bytes; enmm_state_deserialize reads it";
        self.output("snapshot", what, "", Quantity::Snapshot).kind = Type::Binary;
    }
}

const AXES: [(Axis, &str); 2] = [(Axis::X, "x"), (Axis::Y, "y")];

/// A row of a table of the engine.
type Row<T> = enmm::model::Quantity<T>;

/// Outputs of a block port, those of a boundary port first, in the order of their value references.
const PORT_OUTPUTS: [&str; 11] = [
    "displacement_x",
    "displacement_y",
    "velocity_x",
    "velocity_y",
    "stress_xx",
    "stress_yy",
    "stress_xy",
    "rotation",
    "angular_velocity",
    "contact_force_x",
    "contact_force_y",
];

/// Outputs of a quiet boundary.
const OF_QUIET: [&str; 6] =
    ["displacement_x", "displacement_y", "velocity_x", "velocity_y", "traction_x", "traction_y"];

/// Outputs of a port of a kind.
fn port_outputs(kind: PortKind) -> &'static [&'static str] {
    match kind {
        PortKind::Block => &PORT_OUTPUTS,
        PortKind::Boundary => &PORT_OUTPUTS[..7],
        PortKind::Joint => &["normal_force", "shear_force", "slip"],
        PortKind::Quiet => &OF_QUIET,
        // Its velocity is an input.
        PortKind::Fix => &["displacement_x", "displacement_y", "reaction_x", "reaction_y"],
    }
}

/// Outputs of a port of joints in which water flows; they stand behind all others.
const FLOW_PORT_OUTPUTS: [&str; 3] = ["water_pressure", "water_pressure_max", "uplift"];

/// Outputs of all blocks that keep the value references they have always had; all others follow.
const FIRST_BLOCK_OUTPUTS: [&str; 13] = [
    "block_x",
    "block_y",
    "block_displacement_x",
    "block_displacement_y",
    "block_rotation",
    "block_velocity_x",
    "block_velocity_y",
    "block_angular_velocity",
    "block_stress_xx",
    "block_stress_yy",
    "block_stress_xy",
    "block_penetration",
    "block_contact_count",
];

type TotalRow = (Total, &'static str, &'static str, &'static str, Type);

/// What the numbers of the last event's kind mean.
const KINDS: &str = "Last event: 0 none, 1 detached, 2 slipped, 3 failed, 4 overlapped, 5 bond broken, 6 block cut";

/// Outputs of a model whose blocks can be cut.
const BREAKING_TOTALS: [TotalRow; 3] = [
    (Total::PartCount, "part_count", "Blocks now; arrays have 0 behind them", "", Type::Integer),
    (Total::CutCount, "cut_count", "Sections of rock that have broken", "", Type::Integer),
    (Total::CutLength, "cut_length", "Length of the sections of rock that have broken", "m", Type::Real),
];

/// Outputs of the whole model that no other interface has under these names.
const OWN_TOTALS: [TotalRow; 5] = [
    (Total::InternalDt, "internal_dt", "Internal step", "s", Type::Real),
    (Total::LastEventTime, "last_event_time", "Time of the last event, 0 if there was none", "s", Type::Real),
    (Total::EventCount, "event_count", "Events so far", "", Type::Integer),
    (Total::LastEventKind, "last_event_kind", KINDS, "", Type::Integer),
    (Total::LastEventSubject, "last_event_subject", "Block or joint of the last event, -1 if none", "", Type::Integer),
];

/// Former name of an output, and its name.
const FORMER: [&str; 2] = ["sliding_contacts", "slipping_contacts"];

/// Outputs of the whole model that keep the value references they have always had. All others stand behind every other
/// variable, so that a new row in a table of the engine becomes a new variable and moves none.
const FIRST_TOTALS: [&str; 27] = [
    "kinetic_energy",
    "strain_energy",
    "potential_energy",
    "stored_energy",
    "friction_heat",
    "damping_loss",
    "yielding_loss",
    "bolt_work",
    "radiation",
    "external_work",
    "energy_residual",
    "displacement_max",
    "velocity_max",
    "penetration_max",
    "unbalanced_ratio",
    "critical_dt",
    "internal_dt",
    "last_event_time",
    "open_contacts",
    "slipping_contacts",
    "locked_contacts",
    "detached_blocks",
    "slipped_joints",
    "failed_blocks",
    "event_count",
    "last_event_kind",
    "last_event_subject",
];

/// Outputs of the whole model that those cases have in which water flows in joints.
const FLOW_TOTALS: [&str; 7] = [
    "water_entered",
    "water_left",
    "flow_residual",
    "seepage_height",
    "water_stored",
    "flow_parted",
    "flow_parted_pieces",
];

/// Outputs of the whole model by their place.
struct Rowed {
    /// Those of [`FIRST_TOTALS`], in its order.
    first: Vec<TotalRow>,
    /// All others, in the order of the tables.
    later: Vec<TotalRow>,
    /// Those of [`FLOW_TOTALS`].
    flow: Vec<TotalRow>,
}

fn totals() -> Rowed {
    let kind = |is_count| if is_count { Type::Integer } else { Type::Real };
    let energies = ENERGIES.iter().enumerate().map(|(k, q)| (Total::Energy(k), q.column, q.text, q.unit, Type::Real));
    let extremes =
        TOTALS.iter().enumerate().map(|(k, q)| (Total::Extreme(k), q.column, q.text, q.unit, kind(q.is_count)));
    let mut rows: Vec<TotalRow> = energies.chain(extremes).chain(OWN_TOTALS).collect();
    let known = rows.iter().find(|row| row.1 == FORMER[1]).copied();
    rows.extend(known.map(|(total, _, what, unit, kind)| (total, FORMER[0], what, unit, kind)));
    let place = |row: &TotalRow| FIRST_TOTALS.iter().position(|name| *name == row.1);
    let (mut first, others): (Vec<_>, Vec<_>) = rows.into_iter().partition(|row| place(row).is_some());
    first.sort_by_key(place);
    let (flow, later) = others.into_iter().partition(|row| FLOW_TOTALS.contains(&row.1));
    Rowed { first, later, flow }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_output_of_ports_and_blocks_is_in_a_table_of_the_engine() {
        let kinds = [PortKind::Block, PortKind::Joint, PortKind::Quiet, PortKind::Fix];
        let ports = || kinds.into_iter().flat_map(port_outputs).chain(&FLOW_PORT_OUTPUTS);
        assert!(ports().all(|name| place_of(&PORT_QUANTITIES, name).is_some()));
        assert!(PORT_QUANTITIES.iter().all(|quantity| ports().any(|name| *name == quantity.name)));
        let is_shown = |name: &&str| BLOCK_QUANTITIES.iter().any(|quantity| quantity.column == *name);
        assert!(FIRST_BLOCK_OUTPUTS.iter().all(is_shown));
    }

    #[test]
    fn every_first_output_is_in_a_table() {
        let Rowed { first, later, flow } = totals();
        assert_eq!(flow.iter().map(|row| row.1).collect::<Vec<_>>(), FLOW_TOTALS);
        assert_eq!(first.iter().map(|row| row.1).collect::<Vec<_>>(), FIRST_TOTALS);
        assert_eq!(first.len() + later.len() + flow.len(), ENERGIES.len() + TOTALS.len() + OWN_TOTALS.len() + 1);
        assert_eq!(later.last().map(|row| row.1), Some(FORMER[0]));
    }
}
