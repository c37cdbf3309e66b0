//! Derivatives of the transcription against finite differences.

use super::*;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::roll::RollArcs;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::{ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec};
use crate::nlp::Iterate;
use nalgebra::DVector;

fn wheel(axis: [f64; 3], enabled: bool) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: 0.01,
        max_torque_nm: 0.1,
        min_torque_nm: Some(-0.07),
        max_speed_rad_s: Some(300.0),
        enabled,
    }
}

/// Five wheels, one of them locked, full inertia, stored momentum, every kind of limit.
fn dynamics(biased: bool) -> Dynamics {
    let speeds = if biased {
        vec![60.0, -20.0, 80.0, 40.0, 50.0]
    } else {
        vec![0.0; 5]
    };
    let spec = ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[9.0, 0.4, -0.2], [0.4, 8.0, 0.3], [-0.2, 0.3, 7.0]],
            max_body_rate_rad_s: [Some(0.5), None, Some(0.4)],
            max_body_rate_norm_rad_s: Some(0.6),
            wheels: vec![
                wheel([0.8, 0.0, 0.6], true),
                wheel([0.0, 0.8, 0.6], true),
                wheel([-0.8, 0.0, 0.6], true),
                wheel([0.0, -0.8, 0.6], true),
                wheel([1.0, 1.0, 0.0], false),
            ],
            boresights: Vec::new(),
        },
        start: StateSpec {
            wheel_speed_rad_s: Some(speeds),
            ..StateSpec::default()
        },
        targets: vec![TargetSpec {
            id: "a".into(),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    };
    let mut dynamics = Scenario::try_new(&spec)
        .expect("a valid scenario")
        .scenario
        .dynamics();
    let cone = |axis: Vector3<f64>, direction: Vector3<f64>, half_angle| ForbiddenCone {
        axis: axis.normalize(),
        direction: direction.normalize(),
        half_angle,
    };
    dynamics.cones = vec![
        cone(Vector3::x(), Vector3::new(0.3, -0.5, 0.9), 0.4),
        cone(
            Vector3::new(0.2, 0.4, -1.0),
            Vector3::new(-0.7, 0.1, 0.2),
            1.9,
        ),
        cone(Vector3::y(), Vector3::z(), 0.01),
    ];
    dynamics
}

fn transcription(dynamics: &Dynamics, roll: Option<RollArcs>) -> Transcription {
    let scales = Scales::for_legs(dynamics, 0.8, 50.0);
    let null = DVector::from_vec(vec![0.03]);
    let waypoints = [
        Waypoint {
            attitude: Attitude::identity(),
            roll: None,
            rate: [
                RateCondition::Free,
                RateCondition::Fixed(0.01),
                RateCondition::Within(-0.1, 0.2),
            ],
            wheels: WheelCondition::NullSpace(null),
            costates: Some(DVector::from_vec(vec![0.7, -1.3, 0.4, 2.0])),
        },
        Waypoint {
            attitude: Attitude::from_rotation_vector(Vector3::new(0.5, -0.4, 0.3)),
            roll,
            rate: [RateCondition::Free; 3],
            wheels: WheelCondition::Free,
            costates: None,
        },
    ];
    let mut chain = Transcription::new(dynamics, scales, &waypoints, &[2]);
    // Larger than any that a solution needs.
    let correction = Attitude::from_rotation_vector(Vector3::new(0.01, -0.02, 0.015));
    chain.corrections.fill(correction.xyzw());
    let penalty = ControlPenalty {
        length: 0.3,
        change: 0.2,
    };
    chain.limit_lengths(&[70.0, 40.0]);
    let mut reserves = Reserves::none(dynamics, 2);
    let depth = |between| ConeDepth {
        at_ends: [0.0; 2],
        between: Some(between),
    };
    reserves.raise_cones(&[0.01, 0.02, 0.0, 0.03, 0.0, 0.04].map(depth), 1.0);
    chain.keep(&reserves);
    chain.draw_controls_to(&Iterate::cold(Vec::new(), [0.6; 10].into()), penalty);
    chain
}

const POINT: [f64; 8] = [0.1, -0.2, 0.15, 0.95, 0.3, -0.2, 0.5, 0.1];
const NEXT: [f64; 8] = [0.2, -0.25, 0.22, 0.91, 0.5, -0.3, 0.3, 0.4];
const CONTROL: [f64; 5] = [0.2, -0.1, -0.25, 0.3, 0.8];

fn unit(point: [f64; 8]) -> Vec<f64> {
    let norm = point[..4].iter().map(|c| c * c).sum::<f64>().sqrt();
    let mut point = point.to_vec();
    point[..4].iter_mut().for_each(|c| *c /= norm);
    point
}

struct Fixture {
    chain: Transcription,
    node: usize,
    gap: Vec<f64>,
    equality: Vec<f64>,
    inequality: Vec<f64>,
}

impl Fixture {
    fn new(biased: bool, roll: Option<RollArcs>, node: usize) -> Self {
        let chain = transcription(&dynamics(biased), roll);
        let weights = |n: usize, seed: f64| (0..n).map(|i| (seed + i as f64).sin()).collect();
        Self {
            gap: weights(chain.state_dim(), 1.0),
            equality: weights(chain.equalities(node), 2.0),
            inequality: weights(chain.inequalities(node), 3.0),
            node,
            chain,
        }
    }

    /// The model after a step of the state and the controls.
    fn model(&self, step: &[f64]) -> LinkModel {
        let states = self.chain.state_dim();
        let mut point = vec![0.0; 8];
        self.chain
            .retract(&unit(POINT), &step[..states], &mut point);
        let mut control = CONTROL.to_vec();
        control
            .iter_mut()
            .zip(&step[states..])
            .for_each(|(c, s)| *c += s);
        let last = self.node == self.chain.intervals();
        let mut iterate = Iterate::cold(Vec::new(), Vec::new());
        iterate.points = unit(NEXT);
        let link = Link {
            node: self.node,
            point: &point,
            control: if last { &[] } else { &control },
            next: if last { &[] } else { &iterate.points },
        };
        let duals = LinkMultipliers {
            gap: if last { &[] } else { &self.gap },
            equality: &self.equality,
            inequality: &self.inequality,
        };
        let mut model = crate::nlp::models_of(&self.chain).swap_remove(self.node);
        self.chain.values(&link, &mut model.values);
        self.chain.derivatives(&link, &duals, &mut model);
        model
    }

    fn lagrangian(&self, model: &LinkModel) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let values = &model.values;
        let gaps = if values.gap.is_empty() {
            0.0
        } else {
            dot(&self.gap, &values.gap)
        };
        values.cost + gaps + dot(&self.equality, &values.equality)
            - dot(&self.inequality, &values.inequality)
    }
}

fn check_first(fixture: &Fixture) {
    let base = fixture.model(&[0.0; 12]);
    let (vars, states, by) = (base.vars, fixture.chain.state_dim(), 1e-6);
    for column in 0..vars {
        let mut step = [0.0; 12];
        step[column] = by;
        let plus = fixture.model(&step).values;
        step[column] = -by;
        let minus = fixture.model(&step).values;
        let close = |exact: f64, plus: f64, minus: f64, what: &str| {
            let numeric = (plus - minus) / (2.0 * by);
            assert!(
                (exact - numeric).abs() < 1e-7,
                "{what} column {column}: {exact} {numeric}"
            );
        };
        close(base.gradient[column], plus.cost, minus.cost, "cost");
        for (row, (p, m)) in plus.gap.iter().zip(&minus.gap).enumerate() {
            close(base.link_jacobian[row * vars + column], *p, *m, "link");
        }
        for (row, (p, m)) in plus.inequality.iter().zip(&minus.inequality).enumerate() {
            close(base.inequality_row(row)[column], *p, *m, "inequality");
        }
        if column < states {
            for (row, (p, m)) in plus.equality.iter().zip(&minus.equality).enumerate() {
                close(
                    base.equality_jacobian[row * states + column],
                    *p,
                    *m,
                    "equality",
                );
            }
        }
    }
}

fn check_second(fixture: &Fixture) {
    let (vars, by) = (fixture.model(&[0.0; 12]).vars, 1e-3);
    let base = fixture.model(&[0.0; 12]);
    let at = |i: usize, si: f64, j: usize, sj: f64| {
        let mut step = [0.0; 12];
        step[i] += si * by;
        step[j] += sj * by;
        fixture.lagrangian(&fixture.model(&step))
    };
    for i in 0..vars {
        for j in 0..=i {
            let numeric = (at(i, 1.0, j, 1.0) - at(i, 1.0, j, -1.0) - at(i, -1.0, j, 1.0)
                + at(i, -1.0, j, -1.0))
                / (4.0 * by * by);
            let exact = base.hessian[i * vars + j];
            assert!(
                (exact - numeric).abs() < 2e-5,
                "hessian {i} {j}: {exact} {numeric}"
            );
        }
    }
}

#[test]
fn derivatives_of_every_kind_of_node_match_finite_differences() {
    let free = RollArcs {
        axis: Vector3::new(0.2, -0.9, 0.4).normalize(),
        arcs: Vec::new(),
    };
    let limited = RollArcs {
        arcs: vec![[-0.3, 1.4], [2.0, 3.0]],
        ..free.clone()
    };
    for biased in [false, true] {
        for (node, roll) in [
            (0, None),
            (1, None),
            (2, None),
            (2, Some(free.clone())),
            (2, Some(limited.clone())),
        ] {
            let fixture = Fixture::new(biased, roll, node);
            check_first(&fixture);
            check_second(&fixture);
        }
    }
}
