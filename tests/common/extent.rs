//! How much a test does.

/// Whether campaigns run in full: `ENMM_LONG=1`, as `cargo xtask long` sets it. Any other value is a mistake.
pub fn is_long() -> bool {
    match std::env::var("ENMM_LONG").as_deref() {
        Err(_) | Ok("" | "0") => false,
        Ok("1") => true,
        Ok(other) => panic!("ENMM_LONG is `{other}`; it is 1 for the long campaigns, 0 or absent otherwise"),
    }
}
