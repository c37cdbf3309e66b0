//! Which variables the program of a slew has.
//!
//! | part of a state | when |
//! |---|---|
//! | attitude (three steps), wheel momenta `h` | always |
//! | torques `u` at the node | torque is linear on intervals |
//! | length of the intervals | all intervals have the same unknown length |
//! | clock | the duration is prescribed and lengths are unknown, or a speed law moves a wheel |
//! | energy_account | the energy is prescribed |
//!
//! | part of the controls | when |
//! |---|---|
//! | change of the momenta `m`, or the torques `v` at the interval's end | always |
//! | length | every interval has a length of its own |
//! | what the supply gives to each wheel | nothing is fed back |

/// How torque runs over an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TorqueCourse {
    /// Constant.
    Steps,
    /// Linear, and continuous from one interval to the next.
    Ramps,
}

/// What is known of the lengths of intervals.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum IntervalLengths {
    /// Each is an unknown of its own.
    Free,
    /// All are the same unknown.
    SharedControls,
    /// They are given, s.
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
    fn ramps(&self) -> usize {
        match self.course {
            TorqueCourse::Steps => 0,
            TorqueCourse::Ramps => self.wheels,
        }
    }

    fn shared(&self) -> usize {
        usize::from(self.lengths == IntervalLengths::SharedControls)
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

    /// First torque of a state.
    pub(super) fn torque_at(&self) -> usize {
        3 + self.wheels
    }

    /// The shared length in a state.
    pub(super) fn shared_at(&self) -> usize {
        self.torque_at() + self.ramps()
    }

    /// The clock in a state.
    pub(super) fn clock_at(&self) -> usize {
        self.shared_at() + self.shared()
    }

    /// The energy_account in a state.
    pub(super) fn energy_account_at(&self) -> usize {
        self.clock_at() + usize::from(self.clock)
    }

    /// The first slack among the controls.
    pub(super) fn slack_at(&self) -> usize {
        self.wheels + self.own()
    }

    /// The variable that is an interval's length, counted over states and controls.
    pub(super) fn length_variable(&self) -> Option<usize> {
        match self.lengths {
            IntervalLengths::Free => Some(self.states() + self.wheels),
            IntervalLengths::SharedControls => Some(self.shared_at()),
            IntervalLengths::Given(_) => None,
        }
    }
}
