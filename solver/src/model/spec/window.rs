//! When a target may be visited.

use crate::model::epoch;
use crate::model::input::{input_object, optional};

use super::MAX_TIME_S;

input_object! {
    /// A span of time in which a whole visit, from arrival to departure, may lie. Begin and end are given
    /// in seconds from time zero or as dates.
    #[derive(Default)]
    pub struct WindowSpec as "Window" {
        /// Begin, s from time zero.
        pub from_s: Option<f64> = optional().at_least(-MAX_TIME_S).at_most(MAX_TIME_S),
        /// End, s from time zero.
        pub to_s: Option<f64> = optional().at_least(-MAX_TIME_S).at_most(MAX_TIME_S),
        /// Instead of `from_s` the date of the begin in the scenario's time system, which needs an epoch.
        pub from: Option<String> = optional().pattern(epoch::PATTERN),
        /// Instead of `to_s` the date of the end in the scenario's time system, which needs an epoch.
        pub to: Option<String> = optional().pattern(epoch::PATTERN),
    }
}
