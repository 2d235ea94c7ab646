//! How much a test does.

/// The forms of a test that takes long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Extent {
    /// Some seconds: `cargo test` and `cargo xtask test`.
    Quick,
    /// Some minutes for all tests: `ENMM_FULL=1`, as `cargo xtask test --all` sets it.
    Full,
    /// A campaign: `ENMM_LONG=1`, as `cargo xtask long` sets it.
    Long,
}

/// The form that the environment asks for; the one place that reads it.
pub fn extent() -> Extent {
    if is_set("ENMM_LONG") {
        Extent::Long
    } else if is_set("ENMM_FULL") {
        Extent::Full
    } else {
        Extent::Quick
    }
}

/// The value for the extent, of those for quick, full and long tests.
pub fn by_extent<T>([quick, full, long]: [T; 3]) -> T {
    match extent() {
        Extent::Quick => quick,
        Extent::Full => full,
        Extent::Long => long,
    }
}

fn is_set(name: &str) -> bool {
    match std::env::var(name).as_deref() {
        Err(_) | Ok("" | "0") => false,
        Ok("1") => true,
        Ok(other) => panic!("{name} is `{other}`; say 1, or 0 for the quick form"),
    }
}
