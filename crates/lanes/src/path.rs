//! Which kind of lanes runs: the widest that the processor has, or the one that is requested.

use std::sync::atomic::{AtomicU8, Ordering};

use super::Kernel;
use super::portable::Portable;

/// Kinds of lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Path {
    /// Plain Rust.
    Portable,
    /// Two registers of four.
    Avx2,
    /// One register of eight.
    Avx512,
}

impl Path {
    /// All kinds that this processor has, the narrowest first.
    pub fn all() -> Vec<Path> {
        [Path::Portable, Path::Avx2, Path::Avx512].into_iter().filter(|p| p.is_there()).collect()
    }

    /// Name, as the environment variable `ENMM_LANES` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Path::Portable => "portable",
            Path::Avx2 => "avx2",
            Path::Avx512 => "avx512",
        }
    }

    #[cfg(target_arch = "x86_64")]
    fn is_there(self) -> bool {
        match self {
            Path::Portable => true,
            Path::Avx2 => is_x86_feature_detected!("avx2"),
            Path::Avx512 => is_x86_feature_detected!("avx512f"),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn is_there(self) -> bool {
        self == Path::Portable
    }
}

/// Name of the environment variable that asks for a kind of lanes.
pub const VARIABLE: &str = "ENMM_LANES";

/// The kind that `ENMM_LANES` names, else the widest of this processor.
///
/// # Errors
/// A message for the user: no kind has that name, or this processor lacks it.
pub fn requested() -> Result<Path, String> {
    let all = Path::all();
    let Some(wanted) = std::env::var_os(VARIABLE).filter(|wanted| !wanted.is_empty()) else {
        return Ok(all[all.len() - 1]);
    };
    all.iter().copied().find(|kind| wanted == kind.name()).ok_or_else(|| {
        let names = all.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ");
        format!("is {wanted:?}, must be one of those that this processor has: {names}; correct or unset it")
    })
}

/// The kind that [`dispatch`] takes: the one [`requested`], or the widest where the request is none of this processor,
/// which builders of models refuse.
fn path() -> Path {
    /// Number of the kind and 1, once it is known; threads that find it at the same time find the same.
    static KNOWN: AtomicU8 = AtomicU8::new(0);
    const KINDS: [Path; 3] = [Path::Portable, Path::Avx2, Path::Avx512];
    match KNOWN.load(Ordering::Relaxed) {
        0 => {
            let all = Path::all();
            let path = requested().unwrap_or(all[all.len() - 1]);
            KNOWN.store(path as u8 + 1, Ordering::Relaxed);
            path
        }
        known => KINDS[usize::from(known) - 1],
    }
}

/// Runs a kernel with the lanes that `ENMM_LANES` names, else with the widest of this processor.
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    dispatch_on(path(), kernel)
}

/// Runs a kernel with lanes of one kind, or with the portable ones where the processor lacks it.
#[inline]
pub fn dispatch_on<K: Kernel>(path: Path, kernel: K) -> K::Output {
    if !path.is_there() {
        return kernel.run(Portable);
    }
    match path {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has AVX-512F, as `is_there` has just found.
        Path::Avx512 => unsafe { super::avx512::run(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has AVX2, as `is_there` has just found.
        Path::Avx2 => unsafe { super::avx2::run(kernel) },
        _ => kernel.run(Portable),
    }
}
