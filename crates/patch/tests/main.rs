//! Contact of faces: the force against the gradient of its energy, and rigid bodies that fall, slide, topple and rest.

mod cells;
mod columns;
mod constants;
mod cracks;
mod crossings;
mod drops;
mod gradient;
mod heaps;
mod objectivity;
mod parts;
mod rest;
mod rigid;
mod slopes;
mod sums;
mod toppling;
