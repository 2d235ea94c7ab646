//! Places in model and workspace for an integrator beside the explicit one, which the engine does not know.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

/// The integrator of a model, where it is not the explicit one. The room `step`, which knows its interface, puts it
/// here.
#[derive(Clone)]
pub struct OtherIntegrator(Arc<dyn Any + Send + Sync>);

impl OtherIntegrator {
    /// Keeps an integrator.
    pub fn new<T: Any + Send + Sync>(integrator: T) -> Self {
        Self(Arc::new(integrator))
    }

    /// The integrator, if it is a `T`.
    pub fn get<T: Any>(&self) -> Option<&T> {
        self.0.downcast_ref()
    }
}

impl Debug for OtherIntegrator {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "OtherIntegrator")
    }
}

/// Buffers of such an integrator.
pub trait Buffers: Any + Debug + Send + Sync {
    /// A copy of them.
    fn copy(&self) -> Box<dyn Buffers>;

    /// Their bytes.
    fn bytes(&self) -> usize;
}

impl Clone for Box<dyn Buffers> {
    fn clone(&self) -> Self {
        (**self).copy()
    }
}
