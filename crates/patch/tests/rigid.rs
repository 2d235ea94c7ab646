//! Rigid bodies in time: support of the tests, explicit or with implicit rows as the engine has them.

use enmm_patch::{Body, Contacts, Hardening, History, Outline, Row, Rule, Vector};

use super::parts::area_and_centre;

/// A rigid body.
#[derive(Debug, Clone)]
pub struct Rigid {
    shape: Vec<Vector>,
    /// Mass (kg/m).
    pub mass: f64,
    /// Moment of inertia (kg·m).
    pub inertia: f64,
    /// Whether nothing moves it.
    pub is_held: bool,
    /// Centre (m).
    pub centre: Vector,
    /// Turn (rad).
    pub turn: f64,
    /// Velocity (m/s).
    pub velocity: Vector,
    /// Spin (rad/s).
    pub spin: f64,
}

impl Rigid {
    fn new(polygon: &[Vector], density: f64, is_held: bool) -> Self {
        let (area, centre) = area_and_centre(polygon);
        assert!(area > 0.0, "clockwise");
        let shape: Vec<Vector> = polygon.iter().map(|&point| point - centre).collect();
        let next = |k: usize| shape[(k + 1) % shape.len()];
        let of_side = |(k, p): (usize, &Vector)| p.cross(next(k)) * (p.dot(*p) + p.dot(next(k)) + next(k).dot(next(k)));
        let second = shape.iter().enumerate().map(of_side).sum::<f64>() / 12.0;
        let (mass, inertia) = (density * area, density * second);
        let (velocity, spin, turn) = (Vector::default(), 0.0, 0.0);
        Self { shape, mass, inertia, is_held, centre, turn, velocity, spin }
    }

    fn inverse(&self) -> [f64; 2] {
        if self.is_held { [0.0; 2] } else { [1.0 / self.mass, 1.0 / self.inertia] }
    }

    /// Its points after a time (s) at the present velocity.
    fn points(&self, time: f64) -> impl Iterator<Item = Vector> + '_ {
        let (sine, cosine) = (self.turn + time * self.spin).sin_cos();
        let centre = self.centre + self.velocity * time;
        self.shape.iter().map(move |&arm| centre + arm * cosine + arm.left() * sine)
    }

    fn velocity_at(&self, point: Vector) -> Vector {
        self.velocity + (point - self.centre).left() * self.spin
    }

    /// Kinetic energy (J/m) of a velocity and a spin.
    pub fn kinetic(&self, velocity: Vector, spin: f64) -> f64 {
        0.5 * self.mass * velocity.dot(velocity) + 0.5 * self.inertia * spin * spin
    }
}

/// Rigid bodies with their contacts.
#[derive(Debug, Clone)]
pub struct World {
    /// The bodies.
    pub rigid: Vec<Rigid>,
    /// Stiffness of faces, normal and shear (Pa/m).
    pub stiffness: [f64; 2],
    /// Coefficient of friction.
    pub friction: f64,
    /// Gravity (m/s²).
    pub gravity: Vector,
    /// Step (s).
    pub dt: f64,
    /// Weight of the motion in a step; explicit forces where it is 0.
    pub theta: f64,
    /// Damping by mass (1/s).
    pub damping: f64,
    /// Geometry of contact.
    pub rule: Rule,
    /// Hardening of faces.
    pub hardening: Hardening,
    /// Change of a force at which sweeps end.
    pub tolerance: f64,
    /// Most sweeps of a step.
    pub sweeps_max: usize,
    /// Sweeps of all steps.
    pub sweeps: u64,
    /// Steps that did not settle.
    pub unsettled: u64,
    /// Contacts of the last step.
    pub contacts: Contacts,
    /// Forces of their rows (N/m).
    pub forces: Vec<[f64; 2]>,
    spare: Contacts,
    seen: Vec<Body>,
    history: History,
}

impl World {
    /// No bodies yet, with a stiffness (Pa/m) both ways, friction, step (s) and weight of the motion.
    pub fn new(stiffness: f64, friction: f64, dt: f64, theta: f64) -> Self {
        Self {
            rigid: Vec::new(),
            stiffness: [stiffness; 2],
            friction,
            gravity: Vector::new(0.0, -9.81),
            dt,
            theta,
            damping: 0.0,
            rule: Rule::default(),
            hardening: Hardening::NONE,
            tolerance: 1e-3,
            sweeps_max: 200,
            sweeps: 0,
            unsettled: 0,
            contacts: Contacts::default(),
            forces: Vec::new(),
            spare: Contacts::default(),
            seen: Vec::new(),
            history: History::default(),
        }
    }

    /// Adds a polygon of some density (kg/m³); its number.
    pub fn add(&mut self, polygon: &[Vector], density: f64, is_held: bool) -> usize {
        self.rigid.push(Rigid::new(polygon, density, is_held));
        self.rigid.len() - 1
    }

    /// Sets all velocities to zero.
    pub fn stop(&mut self) {
        self.rigid.iter_mut().for_each(|body| (body.velocity, body.spin) = (Vector::default(), 0.0));
    }

    /// Makes some steps.
    pub fn run(&mut self, time: f64) {
        (0..(time / self.dt).round() as usize).for_each(|_| self.step());
    }

    /// Moves what contact sees to the places after a time (s) at the present velocities.
    fn place(&mut self, time: f64) {
        let Self { rigid, rule, seen, .. } = self;
        if seen.len() != rigid.len() {
            let outline = |body: &Rigid| Outline::new(body.points(0.0).collect());
            *seen = rigid.iter().map(|body| Body::new(outline(body), body.is_held, rule)).collect();
        }
        for (seen, body) in seen.iter_mut().zip(rigid.iter()) {
            seen.move_rigidly(body.points(time));
        }
    }

    /// Finds the contacts at the places after a time (s) at the present velocities.
    pub fn find(&mut self, time: f64) {
        self.place(time);
        self.contacts.find(&self.seen, &self.rule, self.hardening);
        self.history.take_over(&self.contacts.rows, &self.seen);
    }

    /// Energy of all (J/m) where the bodies are now.
    pub fn energy(&mut self) -> f64 {
        self.place(0.0);
        let mut contacts = std::mem::take(&mut self.spare);
        contacts.find(&self.seen, &self.rule, self.hardening);
        let elastic = self.stiffness[0] * contacts.energy;
        self.spare = contacts;
        elastic + self.kinetic() + self.potential()
    }

    /// Energy of the springs (J/m) where contacts were found.
    pub fn elastic(&self) -> f64 {
        self.stiffness[0] * self.contacts.energy
    }

    /// Kinetic energy of all (J/m).
    pub fn kinetic(&self) -> f64 {
        self.rigid.iter().filter(|body| !body.is_held).map(|body| body.kinetic(body.velocity, body.spin)).sum()
    }

    /// Potential energy of all (J/m).
    pub fn potential(&self) -> f64 {
        self.rigid.iter().filter(|body| !body.is_held).map(|body| -body.mass * self.gravity.dot(body.centre)).sum()
    }

    /// Mass of all that moves (kg/m).
    pub fn mass(&self) -> f64 {
        self.rigid.iter().filter(|body| !body.is_held).map(|body| body.mass).sum()
    }

    /// Points of a body (m).
    pub fn outline(&self, body: usize) -> Vec<Vector> {
        self.rigid[body].points(0.0).collect()
    }

    /// One step.
    pub fn step(&mut self) {
        if self.theta == 0.0 {
            self.explicit();
        } else {
            self.implicit();
        }
        for body in self.rigid.iter_mut().filter(|body| !body.is_held) {
            body.centre += body.velocity * self.dt;
            body.turn += body.spin * self.dt;
        }
    }

    /// Forces at the present places.
    fn explicit(&mut self) {
        self.find(0.0);
        let rows = std::mem::take(&mut self.contacts.rows);
        let rates: Vec<Vector> = rows.iter().map(|row| self.relative(row)).collect();
        self.load();
        self.forces.clear();
        for (row, rate) in rows.iter().zip(rates) {
            let normal = self.stiffness[0] * row.weight * row.closure;
            let shear = self.history.of(&row.key).shear[row.point_of_two]
                - self.stiffness[1] * row.weight * self.dt * rate.dot(row.normal.left());
            let shear = shear.clamp(-self.friction * normal, self.friction * normal);
            self.history.set(row, normal, shear);
            self.push(row, [normal, shear]);
            self.forces.push([normal, shear]);
        }
        self.contacts.rows = rows;
    }

    /// Gravity and damping.
    fn load(&mut self) {
        let Self { gravity, dt, damping, .. } = *self;
        let kept = 1.0 / (1.0 + damping * dt);
        for body in &mut self.rigid {
            if body.is_held {
                (body.velocity, body.spin) = (Vector::default(), 0.0);
            } else {
                body.velocity = (body.velocity + gravity * dt) * kept;
                body.spin *= kept;
            }
        }
    }

    /// Sweeps over implicit rows, found at the places that the step would reach without contact.
    fn implicit(&mut self) {
        self.load();
        self.find(self.dt);
        let rows = std::mem::take(&mut self.contacts.rows);
        let springs: Vec<Spring> = rows.iter().map(|row| self.spring(row)).collect();
        self.forces.clear();
        for (row, spring) in rows.iter().zip(&springs) {
            let limit = self.friction * spring.start[0];
            let forces = [spring.start[0], spring.start[1].clamp(-limit, limit)];
            self.push(row, forces);
            self.forces.push(forces);
        }
        let mut is_settled = false;
        for _ in 0..self.sweeps_max {
            self.sweeps += 1;
            if self.sweep(&rows, &springs) < self.tolerance {
                is_settled = true;
                break;
            }
        }
        self.unsettled += u64::from(!is_settled);
        for (k, (row, spring)) in rows.iter().zip(&springs).enumerate() {
            let normal = self.forces[k][0];
            let slip = self.relative(row).dot(row.normal.left()) * self.dt;
            let limit = self.friction * normal;
            let shear = (spring.stored - self.stiffness[1] * row.weight * slip).clamp(-limit, limit);
            self.history.set(row, normal, shear);
        }
        self.contacts.rows = rows;
    }

    /// One sweep over all rows; the greatest change of a force.
    fn sweep(&mut self, rows: &[Row], springs: &[Spring]) -> f64 {
        let (mut worst, mut top) = (0.0f64, 0.0f64);
        for (k, (row, spring)) in rows.iter().zip(springs).enumerate() {
            let [old, held] = self.forces[k];
            let closing = self.relative(row).dot(row.normal);
            let normal = if row.is_live { spring.normal(closing, old) } else { old };
            self.push(row, [normal - old, 0.0]);
            let sliding = self.relative(row).dot(row.normal.left());
            let limit = self.friction * normal;
            let shear = spring.shear(sliding, held).clamp(-limit, limit);
            self.push(row, [0.0, shear - held]);
            self.forces[k] = [normal, shear];
            top = top.max(normal);
            let change = (normal - old).abs().max((shear - held).abs());
            worst = worst.max(change / normal.max(f64::MIN_POSITIVE).max(0.02 * top));
        }
        worst
    }

    /// The linear response of a row in a step.
    fn spring(&self, row: &Row) -> Spring {
        let [normal, shear] = self.stiffness.map(|stiffness| stiffness * row.weight);
        let rate = normal * self.hardening.rate(row.depth);
        let free = normal * row.closure;
        let axes = [row.normal, row.normal.left()];
        let compliance = axes.map(|axis| self.compliance(row, axis));
        let (scale, kept) = (self.theta * self.dt, self.history.of(&row.key));
        let stored = kept.shear[row.point_of_two];
        let now = free + rate * self.dt * self.relative(row).dot(row.normal);
        let warm = if row.is_live { kept.normal[row.point_of_two] } else { free };
        Spring {
            rest: [now, stored],
            rate: [rate * scale, shear * scale],
            kept: [0, 1].map(|k| [rate, shear][k] * scale * self.dt * compliance[k]),
            start: [warm, stored],
            stored,
        }
    }

    /// Velocity (m/s) of the viewer against the body that is viewed at a row.
    fn relative(&self, row: &Row) -> Vector {
        self.rigid[row.key.viewer].velocity_at(row.point) - self.rigid[row.key.viewed].velocity_at(row.point)
    }

    fn compliance(&self, row: &Row, axis: Vector) -> f64 {
        let of_body = |body: &Rigid| {
            let ([mass, inertia], lever) = (body.inverse(), (row.point - body.centre).cross(axis));
            mass + lever * lever * inertia
        };
        of_body(&self.rigid[row.key.viewer]) + of_body(&self.rigid[row.key.viewed])
    }

    /// Both bodies of a row take forces (N/m) for a step.
    fn push(&mut self, row: &Row, [normal, shear]: [f64; 2]) {
        if normal == 0.0 && shear == 0.0 {
            return;
        }
        let impulse = (row.normal * normal + row.normal.left() * shear) * self.dt;
        for (index, impulse) in [(row.key.viewer, impulse), (row.key.viewed, -impulse)] {
            let body = &mut self.rigid[index];
            let [mass, inertia] = body.inverse();
            body.velocity += impulse * mass;
            body.spin += (row.point - body.centre).cross(impulse) * inertia;
        }
    }
}

/// A row in one step (Eqs. 14 and 15): a force is `rest` less `rate` times the velocity and plus what is kept.
struct Spring {
    rest: [f64; 2],
    rate: [f64; 2],
    kept: [f64; 2],
    start: [f64; 2],
    stored: f64,
}

impl Spring {
    fn normal(&self, velocity: f64, force: f64) -> f64 {
        self.answer(0, velocity, force).max(0.0)
    }

    fn shear(&self, velocity: f64, force: f64) -> f64 {
        self.answer(1, velocity, force)
    }

    fn answer(&self, axis: usize, velocity: f64, force: f64) -> f64 {
        (self.rest[axis] - self.rate[axis] * velocity + self.kept[axis] * force) / (1.0 + self.kept[axis])
    }
}
