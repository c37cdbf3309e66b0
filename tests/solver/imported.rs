//! Legs that were solved elsewhere: taken bit for bit when they pass verification, otherwise refused.

use slewplan_solver::model::motion::Motion;
use slewplan_solver::model::spec::{
    Applies, AttitudeEquivalence, AttitudeSpec, BoresightSpec, ConeSpec, ScenarioSpec,
};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, LegStore, StoredLeg};
use slewplan_solver::tour::planner::{LegCheck, Run, Shard, leg_table};
use slewplan_tests::random::Generator;
use slewplan_tests::schedules::{RateConditions, Region, schedule};
use slewplan_tests::solving::{on_threads, pool, scenario_of};
use slewplan_tests::suite;
use std::collections::HashMap;
use std::sync::Mutex;

/// A change of a leg that makes it fail its verification.
type Spoil = fn(&mut Motion);

const WHOLE: Shard = Shard { index: 0, of: 1 };

#[derive(Default)]
struct LegMemory(Mutex<HashMap<String, StoredLeg>>);

impl LegStore for LegMemory {
    fn get(&self, _: &str) -> Option<StoredLeg> {
        None
    }

    fn put(&self, identity: &str, leg: &StoredLeg) {
        let mut legs = self.0.lock().expect("not poisoned");
        legs.insert(identity.to_owned(), leg.clone());
    }
}

/// All solved legs of a scenario.
fn solved(spec: &ScenarioSpec, kind: LegKind) -> HashMap<String, StoredLeg> {
    let (scenario, memory) = (scenario_of(spec), LegMemory::default());
    on_threads(2, |run| {
        let legs = &memory;
        leg_table(&scenario, kind, WHOLE, Run { legs, ..run })
    });
    memory.0.into_inner().expect("not poisoned")
}

/// The result of importing a leg for a scenario.
fn judged(
    spec: &ScenarioSpec,
    kind: LegKind,
    identity: &str,
    leg: &StoredLeg,
) -> Result<StoredLeg, Vec<String>> {
    let (scenario, pool, stop) = (scenario_of(spec), pool(1), StopSignal::new());
    let wanted = |other: &str| other == identity;
    let check = LegCheck::new(&scenario, kind, &wanted, (&pool, &stop)).expect("not stopped");
    check.check(identity, leg.motion.clone(), leg.solve_time_s)
}

fn quaternions() -> ScenarioSpec {
    let mut spec = schedule(Region::Sphere, RateConditions::ZeroAboutZ, 4, 3);
    spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    spec
}

#[test]
fn a_solved_leg_is_imported_unchanged() {
    let random = (0..6).map(|seed| Generator::new(seed).single_slews());
    let arrays = [1, 6, 15].map(|spacecraft| suite::leg(spacecraft, 1));
    let scenarios = random.chain(arrays).chain([quaternions()]);
    let mut count = 0;
    for (number, spec) in scenarios.enumerate() {
        for kind in [LegKind::RestToRest, LegKind::LowerBound] {
            for (identity, leg) in solved(&spec, kind) {
                let taken = judged(&spec, kind, &identity, &leg);
                assert_eq!(taken.as_ref(), Ok(&leg), "scenario {number}, {kind:?}");
                count += 1;
            }
        }
    }
    assert!(count > 40, "{count} legs");
}

/// A quarter turn on whose way a camera passes a bright body.
fn past_a_bright_body() -> ScenarioSpec {
    let mut spec = schedule(Region::Sphere, RateConditions::AllZero, 1, 1);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    spec.targets[0].attitude = AttitudeSpec::Quaternion([0.0, 0.0, half, half]);
    spec.spacecraft.boresights = vec![BoresightSpec {
        name: "camera".into(),
        axis: [1.0, 0.0, 0.0],
    }];
    spec.keep_out = vec![ConeSpec {
        boresight: "camera".into(),
        direction: [1.0, 1.0, 0.05].into(),
        half_angle_deg: 25.0,
        applies: Applies::Always,
    }];
    spec
}

#[test]
fn a_leg_around_a_cone_is_imported_and_one_through_it_refused() {
    let (spec, kind) = (past_a_bright_body(), LegKind::RestToRest);
    let legs = solved(&spec, kind);
    let (mut free, around): (Vec<_>, Vec<_>) = legs
        .iter()
        .partition(|(identity, _)| !identity.contains("cone"));
    assert!(!around.is_empty(), "{legs:?}");
    for (identity, leg) in &around {
        assert_eq!(judged(&spec, kind, identity, leg).as_ref(), Ok(*leg));
    }
    let (identity, leg) = around[0];
    let bits = |leg: &StoredLeg| leg.turn_xyzw.map(f64::to_bits);
    free.retain(|(_, other)| bits(other) == bits(leg));
    let through = free.pop().expect("solved before").1;
    assert!(through.duration_s < leg.duration_s);
    let faults = judged(&spec, kind, identity, through).expect_err("refused");
    assert!(faults[0].contains("cone 0 is entered"), "{faults:?}");
}

#[test]
fn a_leg_that_fails_verification_is_refused_with_a_reason() {
    let spec = schedule(Region::Sphere, RateConditions::AllZero, 2, 1);
    let kind = LegKind::RestToRest;
    let legs = solved(&spec, kind);
    let (identity, leg) = legs
        .iter()
        .max_by(|a, b| a.1.duration_s.total_cmp(&b.1.duration_s))
        .expect("there are legs");
    let cases: [(&str, Spoil); 12] = [
        ("the end is missed", |leg| {
            leg.lengths_s.iter_mut().for_each(|length| *length *= 1.001);
        }),
        ("the end is missed", |leg| {
            // Twice as fast: torques are cut to their limits, so that the wheels do not reach the momenta.
            leg.lengths_s.iter_mut().for_each(|length| *length *= 0.5);
            let momenta = leg.wheel_momenta_nms.iter_mut().flatten();
            momenta.for_each(|momentum| *momentum *= 2.0);
        }),
        ("eigenaxis", |leg| {
            // Twice as slow: within all limits, but not a minimum.
            leg.lengths_s.iter_mut().for_each(|length| *length *= 2.0);
            let momenta = leg.wheel_momenta_nms.iter_mut().flatten();
            momenta.for_each(|momentum| *momentum *= 0.5);
        }),
        ("between nodes 2 and 3", |leg| {
            leg.attitudes_xyzw[3] = leg.attitudes_xyzw[4];
        }),
        ("begins", |leg| {
            leg.attitudes_xyzw[0] = leg.attitudes_xyzw[1];
        }),
        ("the rate about x is off", |leg| {
            leg.wheel_momenta_nms[0][0] += 0.001;
        }),
        ("at the end", |leg| {
            let last = leg.wheel_momenta_nms.last_mut().expect("nodes");
            last[2] += 0.001;
        }),
        ("unit quaternions", |leg| {
            leg.attitudes_xyzw[1] = [0.0, 0.0, 0.0, 2.0];
        }),
        ("unit quaternions", |leg| {
            leg.lengths_s.pop();
        }),
        ("momenta of 3 wheels", |leg| {
            leg.wheel_momenta_nms[5].pop();
        }),
        ("not finite", |leg| leg.wheel_momenta_nms[1][1] = f64::NAN),
        ("negative", |leg| leg.lengths_s[1] = -1.0),
    ];
    for (reason, spoil) in cases {
        let mut spoilt = leg.clone();
        spoil(&mut spoilt.motion);
        let faults = judged(&spec, kind, identity, &spoilt).expect_err(reason);
        assert!(faults.join("; ").contains(reason), "{reason}: {faults:?}");
    }
    let other = legs.keys().find(|key| *key != identity).expect("another");
    assert!(judged(&spec, kind, other, leg).is_err());
    let unknown = judged(&spec, kind, "another problem", leg);
    assert!(unknown.expect_err("unknown")[0].contains("no such leg"));
}
