//! The interior point against the second engine, on legs.

use super::*;
use crate::leg::solve::eigenaxis::{EigenaxisSlew, Perturbation};
use crate::leg::transcription::ControlPenalty;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::{ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec};
use crate::model::waypoint::WheelCondition;
use crate::nlp::second_engine::{Ending, SequentialQuadratic};
use crate::nlp::tests::TIGHT;
use crate::nlp::{Chain, Layout, values_of};
use nalgebra::Vector3;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// Required relative agreement of the costs.
const AGREEMENT: f64 = 1e-6;
/// Accuracy of the optimality conditions of the second engine, scaled variables; the cost is off
/// by about its square.
const ACCURACY: f64 = 1e-6;
/// Quadratic programs of a leg at most.
const PROGRAMS: usize = 60;
/// Intervals of a leg: dense quadratic programs are slow with more.
const INTERVALS: usize = 8;
/// That of polishing.
const LENGTH_PENALTY: f64 = 1e-3;
/// Largest displacements of the variables (of order one) from the first engine's solution to the
/// second engine's start, tried in this order.
const DISPLACEMENTS: [f64; 3] = [2e-3, 5e-4, 1e-4];

/// A leg at rest at both ends.
struct Leg {
    name: String,
    dynamics: Dynamics,
    ends: [Waypoint; 2],
    null: DVector<f64>,
}

/// The program of a leg, with a guess.
struct LegProgram {
    chain: Transcription,
    guess: Iterate,
}

impl Leg {
    fn new(name: String, dynamics: &Dynamics, turn: [Attitude; 2]) -> Self {
        let null = DVector::zeros(dynamics.wheel_count() - 3);
        let ends = [turn[0], turn[1].nearest_sign(&turn[0])].map(|attitude| Waypoint {
            attitude,
            roll: None,
            rate: [RateCondition::Fixed(0.0); 3],
            wheels: WheelCondition::NullSpace(null.clone()),
            costates: None,
        });
        Self {
            name,
            dynamics: dynamics.clone(),
            ends,
            null,
        }
    }

    fn program(&self) -> LegProgram {
        let [from, to] = &self.ends;
        let eigenaxis =
            EigenaxisSlew::fastest(&self.dynamics, &from.attitude, &to.attitude, &self.null);
        let guess = eigenaxis.guess(&self.dynamics, INTERVALS, Perturbation::Near);
        let angle = typical_angle(&self.dynamics, &self.ends);
        let scales = Scales::for_legs(&self.dynamics, angle, guess.duration());
        let mut chain = Transcription::new(&self.dynamics, scales, &self.ends, &[INTERVALS]);
        let guess = scaled(&guess, &scales);
        chain.draw_controls_to(&guess, ControlPenalty::of_lengths(LENGTH_PENALTY));
        LegProgram { chain, guess }
    }
}

impl LegProgram {
    fn cost(&self, iterate: &Iterate) -> f64 {
        let layout = Layout::of(&self.chain);
        let mut values = values_of(&self.chain);
        let costs = values.iter_mut().enumerate().map(|(node, values)| {
            self.chain.values(&iterate.link(&layout, node), values);
            values.cost
        });
        costs.sum()
    }
}

/// Every seventh pair of the start and the 18 targets of experiment C: 25 legs.
fn published_legs() -> Vec<Leg> {
    let spec = crate::model::scenario::reference::experiment_a();
    let dynamics = Scenario::try_new(&spec).expect("valid").scenario.dynamics();
    let about = |axis: Vector3<f64>, degrees: f64| {
        Attitude::from_rotation_vector(axis * degrees.to_radians())
    };
    let mut places = vec![Attitude::identity()];
    for roll in [15.0, 40.0, 85.0] {
        for (yaw, more) in [
            (10.0, 0.0),
            (50.0, 10.0),
            (130.0, 0.0),
            (170.0, 10.0),
            (250.0, 0.0),
            (290.0, 10.0),
        ] {
            places.push(about(Vector3::z(), yaw).then_in_body(&about(Vector3::x(), roll + more)));
        }
    }
    let pairs = (0..places.len()).flat_map(|i| (i + 1..places.len()).map(move |j| (i, j)));
    pairs
        .step_by(7)
        .map(|(i, j)| Leg::new(format!("{i} to {j}"), &dynamics, [places[i], places[j]]))
        .collect()
}

/// A leg of a spacecraft of no particular shape with 3 to 5 wheels, with and without momentum,
/// with and without a rate limit, angles log-uniform from 0.01 rad to half a turn.
fn random_leg(case: usize, runner: &mut TestRunner) -> Leg {
    let mut number = |low: f64, high: f64| sample(&(low..high), runner);
    let principal = [number(4.0, 12.0), number(4.0, 12.0), number(6.0, 10.0)];
    let products = [(); 3].map(|()| number(-0.8, 0.8));
    let [a, b, c] = products;
    let momentum = case % 2 == 1;
    let count = 3 + case % 3;
    let wheels: Vec<_> = (0..count)
        .map(|i| {
            let mut axis = [(); 3].map(|()| number(-0.4, 0.4));
            // Three that span the space, and more between them.
            axis[i % 3] += if i < 3 { 1.0 } else { -0.7 };
            axis[(i + 1) % 3] += if i < 3 { 0.0 } else { 0.7 };
            WheelSpec {
                axis,
                normalize_axis: true,
                inertia_kg_m2: number(0.005, 0.02),
                max_torque_nm: number(0.05, 0.2),
                min_torque_nm: None,
                max_speed_rad_s: Some(number(200.0, 500.0)),
                enabled: true,
            }
        })
        .collect();
    let speeds = wheels
        .iter()
        .map(|_| if momentum { number(-30.0, 30.0) } else { 0.0 });
    let start = StateSpec {
        wheel_speed_rad_s: Some(speeds.collect()),
        ..StateSpec::default()
    };
    let rate = number(0.05, 0.3);
    let turn = Vector3::from([(); 3].map(|()| number(-1.0, 1.0))).normalize();
    let angle = number(0.01_f64.ln(), std::f64::consts::PI.ln()).exp();
    let spec = ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [
                [principal[0], a, b],
                [a, principal[1], c],
                [b, c, principal[2]],
            ],
            max_body_rate_norm_rad_s: (case % 4 < 2).then_some(rate),
            wheels,
            ..SpacecraftSpec::default()
        },
        start,
        targets: vec![TargetSpec {
            id: "there".into(),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    };
    let scenario = Scenario::try_new(&spec).expect("a valid scenario").scenario;
    let to = Attitude::from_rotation_vector(turn * angle);
    let name = format!("random {case}, {angle:.3} rad");
    Leg::new(name, &scenario.dynamics(), [Attitude::identity(), to])
}

fn sample<S: Strategy>(strategy: &S, runner: &mut TestRunner) -> S::Value {
    strategy.new_tree(runner).expect("a value").current()
}

impl LegProgram {
    /// The first engine's solution from the guess.
    fn minimum_of_first(&self) -> Iterate {
        let mut iterate = self.guess.clone();
        let mut engine = InteriorPoint::new(&self.chain, TIGHT);
        let report = engine.solve(&self.chain, &mut iterate, &|| None);
        assert_eq!(report.status, NlpStatus::Converged);
        iterate
    }

    /// The cost that the second engine finds from a start, when it converges in more than one
    /// iteration.
    fn cost_of_second(&self, start: &Iterate) -> Option<f64> {
        let mut iterate = start.clone();
        let mut engine = SequentialQuadratic::new(&self.chain);
        let report = engine.solve(&mut iterate, ACCURACY, PROGRAMS);
        (report.ending == Ending::Converged && report.iterations > 1).then_some(report.cost)
    }

    /// A random point near another one.
    fn displaced(&self, from: &Iterate, by: f64, runner: &mut TestRunner) -> Iterate {
        let mut moved = Iterate::cold(from.points.clone(), from.controls.clone());
        let mut by = || sample(&(-by..by), runner);
        moved.controls.iter_mut().for_each(|value| *value += by());
        let points = self.chain.point_len();
        let moves = moved.points.chunks_exact_mut(points);
        for (to, from) in moves.zip(from.points.chunks_exact(points)) {
            let step: Vec<_> = (0..self.chain.state_dim()).map(|_| by()).collect();
            self.chain.retract(from, &step, to);
        }
        moved
    }
}

#[test]
fn both_engines_agree_on_fifty_legs() {
    let mut runner = TestRunner::deterministic();
    let mut legs = published_legs();
    legs.extend((0..25).map(|case| random_leg(case, &mut runner)));
    assert_eq!(legs.len(), 50);
    let mut from_one_start = 0;
    for leg in legs {
        let program = leg.program();
        let solution = program.minimum_of_first();
        let cost = program.cost(&solution);
        let agrees = |other: f64| (other / cost - 1.0).abs() <= AGREEMENT;
        if program.cost_of_second(&program.guess).is_some_and(agrees) {
            from_one_start += 1;
            continue;
        }
        // The engines found different local minima. The division into intervals makes many of them,
        // close together. Started near the first engine's minimum, the second must find it too.
        let found = DISPLACEMENTS.iter().find_map(|by| {
            let near = program.displaced(&solution, *by, &mut runner);
            program.cost_of_second(&near).filter(|other| agrees(*other))
        });
        assert!(found.is_some(), "{}: {cost} is no minimum", leg.name);
    }
    // Most guesses lead the engines to different minima; these to the same one.
    assert!(from_one_start >= 10, "{from_one_start} legs only");
}

#[test]
fn the_inner_loop_of_a_leg_allocates_nothing() {
    // With and without momentum, which takes another turn map.
    for case in [0, 1] {
        let program = random_leg(case, &mut TestRunner::deterministic()).program();
        let counts = [2, 12].map(|max_iterations| {
            let settings = Settings {
                max_iterations,
                ..TIGHT
            };
            let mut engine = InteriorPoint::new(&program.chain, settings);
            let mut iterate = program.guess.clone();
            let counted = allocation_counter::measure(|| {
                let report = engine.solve(&program.chain, &mut iterate, &|| None);
                assert_eq!(report.iterations, max_iterations);
            });
            counted.count_total
        });
        assert_eq!(counts[0], counts[1], "ten iterations more");
    }
}

/// Strong duality: with the costates of the whole motion as costs of the states between them, legs
/// that are solved alone add up to its duration, where each is convex in those states.
#[test]
fn legs_with_the_costates_of_a_motion_add_up_to_it() {
    let spec = crate::model::scenario::reference::experiment_a();
    let dynamics = Scenario::try_new(&spec).expect("valid").scenario.dynamics();
    let turned = |x: f64, z: f64| {
        Attitude::from_rotation_vector(Vector3::z() * z)
            .then_in_body(&Attitude::from_rotation_vector(Vector3::x() * x))
    };
    let (rest, free) = (RateCondition::Fixed(0.0), RateCondition::Free);
    let place = |attitude, rate| Waypoint {
        attitude,
        roll: None,
        rate,
        wheels: WheelCondition::Free,
        costates: None,
    };
    let route = [
        place(Attitude::identity(), [rest; 3]),
        place(turned(0.3, 0.4), [free, free, rest]),
        place(turned(0.9, 0.1), [free, free, rest]),
        place(turned(1.2, 0.9), [rest; 3]),
    ];
    let eigenaxes = |legs: &[Waypoint]| {
        let mut guess = Profile::empty();
        for pair in legs.windows(2) {
            let null = DVector::zeros(0);
            let (from, to) = (&pair[0].attitude, &pair[1].attitude);
            let slew = EigenaxisSlew::fastest(&dynamics, from, to, &null);
            guess.append(&slew.guess(&dynamics, 12, Perturbation::Near));
        }
        guess
    };
    let whole = solve_through(&dynamics, &route, &[12; 3], &eigenaxes(&route), &|| None);
    let whole_s = whole.duration().expect("converges");
    let mut alone_s = 0.0;
    let mut with_costates_s = 0.0;
    for leg in 0..3 {
        let mut ends = [route[leg].clone(), route[leg + 1].clone()];
        let alone = solve_through(&dynamics, &ends, &[12], &eigenaxes(&ends), &|| None);
        alone_s += alone.duration().expect("converges");
        ends[0].costates = leg.checked_sub(1).map(|joint| -&whole.costates[joint]);
        ends[1].costates = whole.costates.get(leg).cloned();
        let leg = solve_through(&dynamics, &ends, &[12], &alone.profile, &|| None);
        with_costates_s += leg.duration().expect("converges");
        let wheels = [&leg.profile.wheels[0], &leg.profile.wheels[12]];
        for (end, wheels) in ends.iter().zip(wheels) {
            let costates = end.costates.as_ref();
            with_costates_s += costates.map_or(0.0, |costates| costates.dot(wheels));
        }
    }
    assert!(
        alone_s < 0.98 * whole_s,
        "the legs are coupled: {alone_s} {whole_s}"
    );
    assert!(
        (with_costates_s / whole_s - 1.0).abs() < 5e-4,
        "{with_costates_s} {whole_s}"
    );
}

/// A long motion through random attitudes, free about two axes at each, in blocks and as one program.
#[test]
fn a_very_long_motion_in_blocks_is_as_short_as_one_program() {
    let spec = crate::model::scenario::reference::experiment_a();
    let dynamics = Scenario::try_new(&spec).expect("valid").scenario.dynamics();
    let mut runner = TestRunner::deterministic();
    let mut number = |low: f64, high: f64| sample(&(low..high), &mut runner);
    let mut waypoints: Vec<Waypoint> = Vec::new();
    let mut at = Attitude::identity();
    for place in 0..=LONG_MOTION {
        let outer = place == 0 || place == LONG_MOTION;
        let free = if outer {
            RateCondition::Fixed(0.0)
        } else {
            RateCondition::Free
        };
        waypoints.push(Waypoint {
            attitude: at,
            roll: None,
            rate: [free, free, RateCondition::Fixed(0.0)],
            wheels: WheelCondition::NullSpace(DVector::zeros(0)),
            costates: None,
        });
        let turn = Vector3::from_fn(|_, _| number(-0.15, 0.15));
        at = at.then_in_body(&Attitude::from_rotation_vector(turn));
    }
    let null = DVector::zeros(0);
    let mut guess = Profile::empty();
    for pair in waypoints.windows(2) {
        let [from, to] = [&pair[0].attitude, &pair[1].attitude];
        let eigenaxis = EigenaxisSlew::fastest(&dynamics, from, to, &null);
        guess.append(&eigenaxis.guess(&dynamics, INTERVALS, Perturbation::Near));
    }
    let intervals = vec![INTERVALS; LONG_MOTION];
    let blocks = solve_rolling(&dynamics, &waypoints, &intervals, &guess, &|| None);
    let whole = solve_through(&dynamics, &waypoints, &intervals, &guess, &|| None);
    let [blocks_s, whole_s] = [&blocks, &whole].map(LegSolution::duration);
    let (blocks_s, whole_s) = (blocks_s.expect("blocks"), whole_s.expect("whole"));
    assert!(
        (blocks_s / whole_s - 1.0).abs() < 5e-4,
        "{blocks_s} {whole_s}"
    );
    assert_eq!(blocks.intervals, intervals);
    assert_eq!(blocks.costates.len(), LONG_MOTION - 1);
    for (leg, waypoint) in waypoints.iter().enumerate() {
        let node = leg * INTERVALS;
        let missed = blocks.profile.attitudes[node].signed_turn_to(&waypoint.attitude);
        assert!(missed.norm() < 1e-7);
        let rate = dynamics.rate(
            &blocks.profile.attitudes[node],
            &blocks.profile.wheels[node],
        );
        assert!(rate.z.abs() < 1e-7, "{rate}");
    }
}

/// Legs of that motion: more than of one program.
const LONG_MOTION: usize = 70;
