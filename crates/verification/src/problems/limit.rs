//! Helpers for problems of limit analysis: text of cases with several blocks and laws, rows of factors.

use enmm_stability::limit_analysis::{Bound, bound};

use super::block::G;
use crate::parts::turn;
use crate::{Row, Setup, Trouble};

/// Points (m).
type Line = Vec<[f64; 2]>;

/// Rigid blocks on held ground, drawn along and normal to a plane that falls to the right by `dip_deg`.
pub struct Scene {
    /// Dip of the plane (degrees).
    pub dip_deg: f64,
    /// Outline.
    pub outline: Line,
    /// Joints with the names of their laws.
    pub joints: Vec<(Line, &'static str)>,
    /// Names of the laws with friction (degrees) and cohesion (Pa).
    pub laws: Vec<(&'static str, f64, f64)>,
    /// Points of the blocks that are held.
    pub held: Line,
    /// Unit weight (N/m³).
    pub unit_weight: f64,
    /// Horizontal acceleration of all rock over gravity.
    pub seismic: f64,
    /// Mesh size (m).
    pub size: f64,
}

impl Scene {
    /// The text of its case.
    pub fn text(&self, title: &str) -> String {
        let turned = |points: &[[f64; 2]]| turn(points, -self.dip_deg);
        let mut text = format!(
            "title = {title:?}\n[domain]\noutline = {:?}\n[mesh]\nsize = {:e}\norigin = [0.031, 0.017]\n\
             [rock.rock]\ndensity = {:e}\nyoung = 1e10\npoisson = 0.25\n",
            turned(&self.outline),
            self.size,
            self.unit_weight / G
        );
        for (points, law) in &self.joints {
            text += &format!("[[joint]]\npoints = {:?}\nlaw = {law:?}\n", turned(points));
        }
        for (name, friction_deg, cohesion) in &self.laws {
            text += &format!("[joint_law.{name}]\nfriction_deg = {friction_deg:?}\ncohesion = {cohesion:e}\n");
        }
        for point in turned(&self.held) {
            text += &format!("[[fix]]\nblock = {point:?}\n");
        }
        if self.seismic != 0.0 {
            text += &format!("[[load]]\nkind = \"body\"\nacceleration = [{:e}, 0.0]\n", self.seismic * G);
        }
        text + "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 60.0\n"
    }
}

impl Scene {
    /// A block on a plane with nothing before it, of the parameters that problems share.
    ///
    /// # Errors
    /// A block that topples.
    pub fn block(setup: &Setup, cohesion: f64) -> Result<Self, Trouble> {
        let [a, phi, length, height] = ["a_deg", "phi_deg", "length", "height"].map(|name| setup.get(name));
        if a.to_radians().tan() > length / height {
            return Err(Trouble("the block topples: choose a height below length/tan a".to_owned()));
        }
        let (outline, joint) = block_on_plane(length, height);
        Ok(Self {
            dip_deg: a,
            outline,
            joints: vec![(joint, "joint")],
            laws: vec![("joint", phi, cohesion)],
            held: vec![[-0.25 * length, -0.5 * height]],
            unit_weight: setup.get("gamma"),
            seismic: 0.0,
            size: 0.45 * height,
        })
    }
}

/// A block on a plane with nothing before it: outline, and the joint below it.
pub fn block_on_plane(length: f64, height: f64) -> (Line, Line) {
    let [left, right] = [-0.5 * length, 2.0 * length];
    let mut outline = vec![[left, -height], [right, -height], [right, 0.0]];
    outline.extend([[length, 0.0], [length, height], [0.0, height], [0.0, 0.0], [left, 0.0]]);
    (outline, vec![[0.0, 0.0], [length, 0.0]])
}

/// The bounds of a case.
///
/// # Errors
/// A case that cannot be built or treated.
pub fn bound_of(setup: &mut Setup, name: &str, text: String) -> Result<Bound, Trouble> {
    let case = setup.simulation(name, text)?.case().clone();
    Ok(bound(&case)?)
}

/// Reason for the tolerance of all rows of factors.
const REASON: &str = "the bracket is 2e-5 wide, and 2e-7 of a block's weight counts as balanced";

/// Both bounds beside one closed form.
pub fn factor_rows(name: &str, bound: &Bound, exact: f64) -> [Row; 2] {
    let row =
        |kind: &str, factor: f64| Row::new(format!("{kind} factor{name}"), "", factor, exact).relative(3e-4, REASON);
    [row("associated", bound.associated.factor.value()), row("level tops'", bound.level_tops.factor.value())]
}

/// A slope that equilibrium holds however weak its joints: the inverse of the factor is zero.
pub fn endless_row(quantity: &str, factor: f64) -> Row {
    let reason = "factors beyond 1000 are told from no end";
    Row::new(format!("inverse of the {quantity}"), "", factor.recip(), 0.0).at_most(1e-3, reason)
}
