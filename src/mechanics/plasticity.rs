//! Mohr–Coulomb rock: return mapping in principal stresses.

/// Plastic strain xx, yy, xy, zz of an element in the axes that turn with it.
pub type PlasticStrain = [f64; 4];
