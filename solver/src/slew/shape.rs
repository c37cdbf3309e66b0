//! Which variables the program of a slew has.
//!
//! | part of a state | when |
//! |---|---|
//! | attitude (three steps), wheel momenta `h` | always |
//! | torques `u` at the node | torque is linear on intervals |
//! | length of the intervals | all intervals have the same unknown length |
//! | clock | the duration is prescribed and lengths are unknown, or a speed law moves a wheel |
//! | energy account: what has been used since the start | the energy is limited |
//!
//! | part of the controls | when |
//! |---|---|
//! | change of the momenta `m`, or the torques `v` at the interval's end | always |
//! | length | every interval has a length of its own |
//! | slacks: energy at each motor, at least 0 | the bill is counted, braking returns nothing |

/// Torque as a function of time within an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TorqueCourse {
    /// Constant.
    Steps,
    /// Linear, and continuous from one interval to the next.
    Ramps,
}

/// Whether the lengths of the intervals are unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum IntervalLengths {
    /// Each length is an unknown.
    Free,
    /// One unknown is the length of all intervals.
    Shared,
    /// The lengths are given, s.
    Given(Vec<f64>),
}

/// The variables of an interval and its first node.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ProgramShape {
    pub(super) wheels: usize,
    pub(super) course: TorqueCourse,
    pub(super) lengths: IntervalLengths,
    pub(super) clock: bool,
    pub(super) energy_account: bool,
    pub(super) slacks: bool,
}

impl ProgramShape {
    /// Number of torques in a state.
    fn ramps(&self) -> usize {
        match self.course {
            TorqueCourse::Steps => 0,
            TorqueCourse::Ramps => self.wheels,
        }
    }

    fn shared(&self) -> usize {
        usize::from(self.lengths == IntervalLengths::Shared)
    }

    fn own(&self) -> usize {
        usize::from(self.lengths == IntervalLengths::Free)
    }

    /// Dimension of a state's tangent space; a point has one number more.
    pub(super) fn states(&self) -> usize {
        self.energy_account_at() + usize::from(self.energy_account)
    }

    /// Number of controls.
    pub(super) fn controls(&self) -> usize {
        self.wheels * (1 + usize::from(self.slacks)) + self.own()
    }

    /// Index of the first torque in a state.
    pub(super) fn torque_at(&self) -> usize {
        3 + self.wheels
    }

    /// Index of the shared length in a state.
    pub(super) fn shared_at(&self) -> usize {
        self.torque_at() + self.ramps()
    }

    /// Index of the clock in a state.
    pub(super) fn clock_at(&self) -> usize {
        self.shared_at() + self.shared()
    }

    /// Index of the energy account in a state.
    pub(super) fn energy_account_at(&self) -> usize {
        self.clock_at() + usize::from(self.clock)
    }

    /// Index of the first slack among the controls.
    pub(super) fn slack_at(&self) -> usize {
        self.wheels + self.own()
    }

    /// Index of an interval's length, counted over states and controls; `None` where it is given.
    pub(super) fn length_variable(&self) -> Option<usize> {
        match self.lengths {
            IntervalLengths::Free => Some(self.states() + self.wheels),
            IntervalLengths::Shared => Some(self.shared_at()),
            IntervalLengths::Given(_) => None,
        }
    }
}
