//! The passes of the engine that lead from a guess to a solution, and to a polished one.

use crate::leg::transcription::ControlPenalty;
use crate::model::dynamics::Dynamics;
use crate::nlp::Settings;

/// One pass of the engine over the program; each begins where the one before it ended.
pub(super) struct Pass {
    pub(super) settings: Settings,
    /// Weights of the penalty that draws the controls to those at the beginning of the pass.
    pub(super) penalty: ControlPenalty,
}

/// First the active limits and the approximate switches, then the solution up to what its turns are
/// off by. A strong penalty on lengths saves iterations but lengthens the motion; the second pass
/// has a weaker one, drawn to the lengths of the first. It begins with the barrier that it ends
/// with: the first pass ends so near that barriers between them take more iterations, not fewer.
const FROM_A_GUESS: [Pass; 2] = [
    ROUGHLY,
    Pass {
        settings: Settings {
            stationarity: 100.0,
            feasibility: 1e-6,
            ..ACCURATELY
        },
        penalty: ControlPenalty::of_lengths(0.02),
    },
];
/// The last solve of a motion whose passes end before it is accurate: with corrected turns, which
/// move it once more anyway.
pub(super) const ACCURATELY: Settings = Settings {
    initial_barrier: 1e-6,
    ..Settings::COLD
};
/// The same with momentum under a rate limit. There are more intervals than switches, so torque can
/// move from one interval to its neighbour at no cost; penalties on lengths and momentum changes
/// make the solution unique.
const ALONG_LIMITS: [Pass; 2] = [
    ROUGHLY,
    Pass {
        settings: Settings {
            initial_barrier: 1e-3,
            tolerance: 5e-6,
            ..Settings::COLD
        },
        penalty: ControlPenalty {
            length: 0.05,
            change: 0.01,
        },
    },
];
const ROUGHLY: Pass = Pass {
    settings: Settings {
        tolerance: 1e-2,
        feasibility: 1e-3,
        ..Settings::COLD
    },
    penalty: ControlPenalty::of_lengths(0.1),
};
/// From the primal solution of a program with a slightly stronger penalty.
pub(super) const POLISHING: [Pass; 1] = [Pass {
    settings: Settings {
        tolerance: 1e-9,
        initial_barrier: 1e-4,
        initial_slack: 1e-4,
        ..Settings::COLD
    },
    penalty: ControlPenalty::of_lengths(1e-3),
}];

/// The passes that lead from a guess to a solution.
pub(super) fn from_a_guess(dynamics: &Dynamics) -> &'static [Pass] {
    if dynamics.straying() > 0.0 {
        &ALONG_LIMITS
    } else {
        &FROM_A_GUESS
    }
}
