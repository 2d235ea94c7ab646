//! Flow in nets of joints against formulas, and on many random nets.

mod exact;
mod free_surface;
mod grids;
mod parts;
mod refused;
mod slopes;
mod time;
