//! Published results of scenarios recognised by name, and why the results here differ.
//!
//! Source: A. Olivares, E. Staffetti, "Time-optimal attitude scheduling of a spacecraft equipped
//! with reaction wheels" (2018), experiments A, B and C.

use super::numbers::difference;
use slewplan_solver::model::plan::Plan;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::AttitudeEquivalence;

/// A published result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Published {
    /// Name of the scenario.
    name: &'static str,
    /// The published optimum, s.
    total_time_s: f64,
    /// The published order.
    order: &'static str,
}

const KNOWN: [Published; 3] = [
    Published {
        name: "olivares-staffetti-a",
        total_time_s: 592.49,
        order: "a f e d c b",
    },
    Published {
        name: "olivares-staffetti-b",
        total_time_s: 744.03,
        order: "a b h c d e f l k j i g",
    },
    Published {
        name: "olivares-staffetti-c",
        total_time_s: 897.46,
        order: "g m n o p k e f l r q d j i c h b a",
    },
];

const WHY_QUATERNIONS: &str = "\
It visits quaternions, not attitudes: some targets have a negative scalar part there, so that
  turns take the long way round, although q and -q are the same attitude.";
const WHY_COARSE: &str = "\
Its two collocation intervals per leg are too few: the printed time is below what the torque and speed limits allow for its own order (experiment A: 620.7 s).";

/// The published result for a scenario's name.
pub(super) fn find(name: &str) -> Option<&'static Published> {
    KNOWN.iter().find(|known| known.name == name)
}

impl Published {
    /// The published time, the difference of the plan, and its reasons.
    pub(super) fn comparison(&self, plan: &Plan, scenario: &Scenario) -> String {
        let reasons = match scenario.options().attitude_equivalence {
            AttitudeEquivalence::Rotation => format!("{WHY_QUATERNIONS}\n  {WHY_COARSE}"),
            AttitudeEquivalence::Quaternion => WHY_COARSE.to_owned(),
        };
        let difference = difference(plan.total_time_s / self.total_time_s - 1.0, 1);
        format!(
            "\npublished     {:.2} s in the order {} (Olivares and Staffetti, 2018); \
             this plan: {difference}\n  {reasons}\n",
            self.total_time_s, self.order
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_three_experiments_are_recognised() {
        assert_eq!(
            find("olivares-staffetti-a").map(|known| known.total_time_s),
            Some(592.49)
        );
        assert_eq!(find("olivares-staffetti"), None);
        let lengths = KNOWN.map(|known| known.order.split(' ').count());
        assert_eq!(lengths, [6, 12, 18]);
    }
}
