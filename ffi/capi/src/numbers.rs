//! Structures whose members are rows of the engine's tables of quantities, as words of 64 bits; `layout` and the header
//! name them one by one.

use engine::cosimulation::{PORT_QUANTITIES, PortState, Quantity, TOTALS, Totals};
use engine::model::{
    BLOCK_QUANTITIES, BlockState, ENERGIES, INLET_QUANTITIES, InletState, JOINT_MONITOR_QUANTITIES, JointMonitorState,
    Ledger, MONITOR_QUANTITIES, MONITOR_STRESS_QUANTITIES, MonitorState, Stress,
};

use crate::layout::{Kind, energies};
use crate::types::*;

/// Words of the six short counts of the sums, two to a word.
const TOTALS_WORDS: usize = TOTALS.len() - 3;

/// A block now.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_block_state {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    id: u32,
    flags: u32,
    numbers: [u64; BLOCK_QUANTITIES.len()],
}

/// Energies now and works since the start.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_energies {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; ENERGIES.len()],
}

/// Sums and extremes over the model.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_totals {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; TOTALS_WORDS],
}

/// A port now.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_port_state {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; PORT_QUANTITIES.len()],
}

/// A monitor now.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_monitor_state {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; MONITOR_QUANTITIES.len()],
}

/// Stress at a monitor now.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_monitor_stress {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; MONITOR_STRESS_QUANTITIES.len()],
}

/// A monitor of a joint now.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_joint_monitor_state {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; JOINT_MONITOR_QUANTITIES.len()],
}

/// Water at a head, in rain or at a drain.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_inlet_state {
    /// Size of this structure (bytes).
    pub struct_size: usize,
    numbers: [u64; INLET_QUANTITIES.len()],
}

sized! {
    enmm_block_state 152 { struct_size id flags numbers }
    enmm_energies 128 { struct_size numbers }
    enmm_totals 72 { struct_size numbers }
    enmm_port_state 120 { struct_size numbers }
    enmm_monitor_state 40 { struct_size numbers }
    enmm_monitor_stress 56 { struct_size numbers }
    enmm_joint_monitor_state 40 { struct_size numbers }
    enmm_inlet_state 32 { struct_size numbers }
}

impl enmm_block_state {
    /// That of a block.
    pub fn new(state: &BlockState, has_failed: bool) -> Self {
        let flags = [
            (state.fixed, ENMM_BLOCK_FIXED),
            (state.detached, ENMM_BLOCK_DETACHED),
            (has_failed, ENMM_BLOCK_FAILED),
            (state.removed, ENMM_BLOCK_REMOVED),
        ];
        let flags = flags.into_iter().filter(|(holds, _)| *holds).map(|(_, bit)| bit).sum();
        let numbers = words(BLOCK_QUANTITIES.iter(), state);
        Self { struct_size: size_of::<Self>(), id: state.id, flags, numbers }
    }
}

impl From<&Ledger> for enmm_energies {
    fn from(ledger: &Ledger) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(energies(), ledger) }
    }
}

impl From<&Totals> for enmm_totals {
    fn from(totals: &Totals) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(TOTALS.iter(), totals) }
    }
}

impl From<&PortState> for enmm_port_state {
    fn from(port: &PortState) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(PORT_QUANTITIES.iter(), port) }
    }
}

impl From<&MonitorState> for enmm_monitor_state {
    fn from(monitor: &MonitorState) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(MONITOR_QUANTITIES.iter(), monitor) }
    }
}

impl From<&Stress> for enmm_monitor_stress {
    fn from(stress: &Stress) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(MONITOR_STRESS_QUANTITIES.iter(), stress) }
    }
}

impl From<&JointMonitorState> for enmm_joint_monitor_state {
    fn from(joint: &JointMonitorState) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(JOINT_MONITOR_QUANTITIES.iter(), joint) }
    }
}

impl From<&InletState> for enmm_inlet_state {
    fn from(inlet: &InletState) -> Self {
        Self { struct_size: size_of::<Self>(), numbers: words(INLET_QUANTITIES.iter(), inlet) }
    }
}

/// Values of quantities in the words of a structure. Short counts that follow one another share a word.
fn words<T: 'static, const N: usize>(table: impl Iterator<Item = &'static Quantity<T>>, value: &T) -> [u64; N] {
    let mut words = [0; N];
    let (mut next, mut is_half) = (0, false);
    for quantity in table {
        let (number, kind) = ((quantity.get)(value), Kind::of(quantity));
        if kind == Kind::ShortCount {
            let is_upper = is_half != cfg!(target_endian = "big");
            words[next] |= (number as u64) << if is_upper { 32 } else { 0 };
            next += usize::from(is_half);
            is_half = !is_half;
            continue;
        }
        next += usize::from(is_half);
        is_half = false;
        words[next] = if kind == Kind::Real { number.to_bits() } else { number as u64 };
        next += 1;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_their_words_and_short_counts_share_one() {
        let mut totals = Totals { displacement_max: 1.5, overlapping_pairs: 1 << 40, ..Totals::default() };
        (totals.contacts.open, totals.contacts.slipping, totals.failed_blocks) = (3, u32::MAX, 7);
        let own = enmm_totals::from(&totals);
        assert_eq!(own.numbers[0], 1.5_f64.to_bits());
        let bytes: Vec<u8> = own.numbers[5..8].iter().flat_map(|word| word.to_ne_bytes()).collect();
        let counts: Vec<u32> = bytes.chunks(4).map(|four| u32::from_ne_bytes(four.try_into().expect("four"))).collect();
        assert_eq!(counts, [3, u32::MAX, 0, 0, 0, 7]);
        assert_eq!(own.numbers[9], 1 << 40);
        let mut block = BlockState { mass: 2.0, ..BlockState::default() };
        (block.contacts.count, block.contacts.penetration_max) = (4, 0.25);
        let own = enmm_block_state::new(&block, true);
        let count = own.numbers[15].to_ne_bytes();
        assert_eq!((own.flags, count[..4].to_vec()), (ENMM_BLOCK_FAILED, 4_u32.to_ne_bytes().to_vec()));
        assert_eq!([own.numbers[12], own.numbers[16]], [2.0, 0.25].map(f64::to_bits));
    }
}
