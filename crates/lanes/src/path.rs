//! Which kind of lanes runs: the widest that the processor has, or the one that is requested.

use std::sync::OnceLock;

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

/// The kind that [`dispatch`] takes: the widest there is, or a narrower one that `ENMM_LANES` names.
pub fn path() -> Path {
    static PATH: OnceLock<Path> = OnceLock::new();
    *PATH.get_or_init(|| {
        let wanted = std::env::var("ENMM_LANES").unwrap_or_default();
        let all = Path::all();
        all.iter().copied().find(|p| p.name() == wanted).unwrap_or(all[all.len() - 1])
    })
}

/// Runs a kernel with the lanes of [`path`].
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
