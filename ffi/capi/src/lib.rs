//! C ABI of the engine: twin files of safe Rust and pointers.
