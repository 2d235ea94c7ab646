//! Reasons for which there is no net or no flow.

/// Input that a net cannot have, with the place where it stands.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Refused {
    /// A list has another length than the net needs.
    #[error("`{name}` has {length} values, and the net needs {needed}")]
    Length {
        /// Name of the argument.
        name: &'static str,
        /// Its length.
        length: usize,
        /// The number of nodes or of pipes.
        needed: usize,
    },
    /// A value is not finite, or negative where that makes no sense.
    #[error("`{name}` of {index} is {value}")]
    Value {
        /// Name of the argument.
        name: &'static str,
        /// Number of the node or pipe, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A pipe does not lie between two nodes of the net.
    #[error("pipe {pipe} leads from node {} to node {}, and the net has {nodes} nodes", .ends[0], .ends[1])]
    Ends {
        /// Number of the pipe, from 0.
        pipe: usize,
        /// Its nodes.
        ends: [u32; 2],
        /// Number of nodes of the net.
        nodes: usize,
    },
    /// There are more nodes or pipes than numbers of 32 bits can tell apart.
    #[error("{count} nodes and pipes are more than a net can have")]
    Size {
        /// Number of nodes and pipes.
        count: usize,
    },
    /// Water is given to a piece of the net that it cannot leave.
    #[error("node {node} has a source, and its piece of the net has no head, no air and no rain")]
    Enclosed {
        /// The node.
        node: usize,
    },
}

/// Flow that has not been found: the state with the least imbalance is not good enough.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the flow is not found after {solves} solves: node {node} is out of balance by {residual:e} m²/s")]
pub struct Unsolved {
    /// Node with the greatest imbalance.
    pub node: usize,
    /// Imbalance there (m²/s): what flows out, less what flows in.
    pub residual: f64,
    /// Linear systems that have been solved.
    pub solves: u32,
}

/// Reason for which there is no flow.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The input makes no sense.
    #[error(transparent)]
    Refused(#[from] Refused),
    /// The solver has not found the flow.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}
