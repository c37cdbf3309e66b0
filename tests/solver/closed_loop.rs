//! Plans simulated in closed loop: the share of the wheels that a plan has to leave to feedback.

use slewplan_solver::simulation::{
    ControllerSpec, ErrorsSpec, GainsSpec, Simulation, SimulationSpec, Spread,
};
use slewplan_studies::authority::{
    Authorities, AuthorityRow, AuthorityStudySpec, RowOutcome, study,
};
use slewplan_tests::solving::{on_threads, order_of, plan_of, scenario_of};
use slewplan_tests::{experiment_a_spec, pyramid_spec};

const ALL: Authorities = Authorities {
    torque_authority: 1.0,
    momentum_authority: 1.0,
};
const HELD_BACK: Authorities = Authorities {
    torque_authority: 0.95,
    momentum_authority: 0.95,
};

fn simulated(row: &AuthorityRow) -> (f64, &Spread) {
    let RowOutcome::Simulated {
        total_time_s,
        spread,
        ..
    } = &row.outcome
    else {
        panic!("not simulated: {row:?}");
    };
    (*total_time_s, spread)
}

#[test]
fn experiment_a_needs_a_twentieth_of_the_wheels_for_feedback() {
    let mut scenario = experiment_a_spec();
    scenario.options.time_limit_s = None;
    let spec = AuthorityStudySpec {
        scenario,
        simulation: SimulationSpec {
            controller: ControllerSpec::Quaternion {
                gains: GainsSpec::Bandwidth {
                    bandwidth_rad_s: 0.1,
                    damping: 0.7,
                },
                gyroscopic: false,
            },
            on_board_rate_hz: Some(10.0),
            errors: ErrorsSpec {
                inertia_3_sigma: Some(0.02),
                ..ErrorsSpec::default()
            },
            runs: Some(1000),
            tolerance_deg: Some(0.1),
            ..SimulationSpec::default()
        },
        authorities: vec![ALL, HELD_BACK],
    };
    let rows = on_threads(2, |run| study(&spec, "", run)).expect("a valid study");
    let [all, held_back] = &rows[..] else {
        panic!("{rows:?}")
    };
    let (least_s, all) = simulated(all);
    assert_eq!((all.runs, all.runs_asked), (1000, 1000));
    assert!(all.share_within < 0.5, "{all:?}");
    // The cause is wheel speed: feedback demands more than the plan has left.
    assert!(
        all.saturation.iter().any(|wheel| wheel.speed_mean > 0.1),
        "{all:?}"
    );
    let (longer_s, held_back) = simulated(held_back);
    assert!(held_back.share_within >= 0.99, "{held_back:?}");
    assert!(
        held_back.end_attitude_rad.p99 <= 0.1_f64.to_radians(),
        "{held_back:?}"
    );
    // The duration that this costs.
    assert!(least_s < 468.0, "{least_s}");
    assert!(
        (1.0..1.06).contains(&(longer_s / least_s)),
        "{longer_s} {least_s}"
    );
}

#[test]
fn a_plan_for_a_pyramid_is_followed_to_its_target() {
    let mut spec = pyramid_spec();
    spec.options.torque_authority = 0.9;
    spec.options.momentum_authority = 0.9;
    let plan = plan_of(&spec);
    assert_eq!(order_of(&plan), "turned");
    let scenario = scenario_of(&spec);
    let simulate = |controller: ControllerSpec| {
        let spec = SimulationSpec {
            controller,
            errors: ErrorsSpec {
                inertia_3_sigma: Some(0.02),
                alignment_3_sigma_rad: Some(0.003),
                ..ErrorsSpec::default()
            },
            settle_s: Some(40.0),
            ..SimulationSpec::default()
        };
        let simulation = Simulation::try_new(&scenario, &plan.flight, &spec, "");
        simulation
            .expect("a valid simulation")
            .simulate(0, None, &|| false)
            .expect("not stopped")
    };
    let open = simulate(ControllerSpec::FeedForward);
    let gains = GainsSpec::Bandwidth {
        bandwidth_rad_s: 0.3,
        damping: 0.9,
    };
    let closed = simulate(ControllerSpec::Quaternion {
        gains,
        gyroscopic: false,
    });
    assert!(open.end.attitude_rad > 1e-3, "{open:?}");
    assert!(closed.end.attitude_rad < 1e-5, "{closed:?}");
    assert!(closed.passages[0].error.attitude_rad < open.passages[0].error.attitude_rad);
    // Without a plan the same loop is far from the target when the plan has arrived.
    let step = simulate(ControllerSpec::StepInput {
        gains,
        gyroscopic: false,
    });
    assert!(step.plan_end.attitude_rad > 0.01, "{step:?}");
    assert!(
        step.saturation
            .iter()
            .any(|wheel| wheel.torque > 0.1 || wheel.speed > 0.1)
    );
}
