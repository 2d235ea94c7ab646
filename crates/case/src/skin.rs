//! Skins of a case: shotcrete and mesh along a face.

use crate::PointList;
use crate::keys::shared::{LENGTH, PLACE, STRENGTH};
use crate::keys::unit::{METRE, NUMBER, PASCAL};
use crate::keys::{Range, keys};

keys! {
    /// Shotcrete or mesh along a face: a band that carries tension alone, held to the rock at points along it. Members
    /// between neighbouring points are bolts in all outputs, named `NAME_1`, `NAME_2`, …; a stage installs all of them
    /// by the name of the skin.
    #[derive(Default)]
    pub struct Skin {
        /// Name, for stages that install it.
        pub name: Option<String>,
        /// Points on the face (m), from end to end; the skin runs straight between them.
        pub line: PointList => PLACE,
        /// Thickness (m): of mesh, the section of its wires per metre of width (m²/m).
        pub thickness: f64 =>
            Range::above(0.0).to(1e3).of(METRE).hint("the thickness, or the section of the wires per metre")
                .usual([5e-5, 1.0], "shotcrete has 0.05 to 0.3 m, mesh 2e-4 m²/m").example(0.1),
        /// Young's modulus (Pa).
        pub young: f64 =>
            Range::above(0.0).to(1e15).of(PASCAL)
                .usual([1e8, 4e11], "shotcrete has 5e9 to 3e10 Pa, steel 2e11").example(15e9),
        /// Tensile strength (Pa), at which it breaks, or yields with `rupture_strain`; default: it never does.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub tension: Option<f64> =>
            STRENGTH.in_range(Range::above(0.0).to(1e12)).hint("leave it out for a skin that never breaks")
                .usual([1e5, 3e9], "shotcrete has 1e6 to 4e6 Pa, mesh 5e8"),
        /// Elongation of a member, relative to its length, at which it breaks; default: it breaks at `tension`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub rupture_strain: Option<f64> => Range::above(0.0).to(1e6).of(NUMBER).hint("mesh has 0.05 to 0.2"),
        /// Greatest distance of the points that hold it (m); default: the mesh size.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub distance: Option<f64> => LENGTH.hint("leave it out for the mesh size"),
        /// Whether it is there from the start; else a stage installs it by name.
        #[serde(default = "crate::keys::yes")]
        pub active: bool,
    }
}
