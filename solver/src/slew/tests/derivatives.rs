//! Derivatives of programs of every shape against finite differences.

use super::craft::{biros, camera, cone, lro_drives, wheel};
use crate::leg::profile::Profile;
use crate::leg::transcription::Scales;
use crate::model::drive::{DriveSpec, SpeedLawSpec};
use crate::model::spec::{PointingSpec, SpacecraftSpec, StateSpec};
use crate::nlp::{Chain, Iterate, Layout, Link, LinkModel, LinkMultipliers, models_of};
use crate::slew::cost_weights::CostWeights;
use crate::slew::motion::SlewMotion;
use crate::slew::program::{LengthPenalty, Program, ProgramSetup, ProgramUnits};
use crate::slew::shape::{IntervalLengths, ProgramShape, TorqueCourse};
use crate::slew::{EnergyMeasure, Slew, SlewSpec, WheelAllocation};
use nalgebra::{DVector, Vector3};

/// Four wheels with friction and motors, one under a speed law, stored momentum, rate limits, a cone.
fn slew(allocation: WheelAllocation, pointing: Option<PointingSpec>) -> Slew {
    let mut drives = lro_drives();
    for drive in &mut drives {
        drive.coulomb_friction_nm = Some(0.004);
        drive.viscous_friction_nms = Some(1e-4);
    }
    drives.push(DriveSpec {
        speed_law: Some(SpeedLawSpec {
            rate_per_s: 0.01,
            speed_rad_s: 100.0,
        }),
        ..DriveSpec::default()
    });
    let small = |axis| wheel(axis, 0.01, 0.1, Some(300.0));
    let spec = SlewSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[9.0, 0.4, -0.2], [0.4, 8.0, 0.3], [-0.2, 0.3, 7.0]],
            max_body_rate_rad_s: [Some(0.5), None, None],
            max_body_rate_norm_rad_s: Some(0.6),
            wheels: vec![
                small([0.8, 0.0, 0.6]),
                small([0.0, 0.8, 0.6]),
                small([-0.8, 0.0, 0.6]),
                small([0.0, -0.8, 0.6]),
                small([0.6, 0.0, 0.8]),
            ],
            boresights: vec![camera([0.6, 0.0, 0.8])],
        },
        drives,
        keep_out: vec![cone([1.0, 1.0, 0.3], 35.0)],
        start: StateSpec {
            wheel_speed_rad_s: Some(vec![1.0, -2.0, 0.5, 40.0, 50.0]),
            ..StateSpec::default()
        },
        end: StateSpec {
            pointing,
            ..StateSpec::default()
        },
        allocation,
        ..SlewSpec::default()
    };
    Slew::try_new(&spec).expect("a valid slew").slew
}

/// A motion of two intervals, far from any solution.
fn motion() -> SlewMotion {
    let at = |v: [f64; 3]| crate::model::attitude::Attitude::from_rotation_vector(Vector3::from(v));
    SlewMotion::of_profile(&Profile {
        attitudes: vec![
            at([0.1, -0.2, 0.1]),
            at([0.3, -0.25, 0.2]),
            at([0.5, -0.3, 0.4]),
        ],
        wheels: vec![
            DVector::from_vec(vec![0.012, -0.021, 0.0031, 0.4]),
            DVector::from_vec(vec![0.35, -0.4, -0.3, 0.8]),
            DVector::from_vec(vec![0.2, 0.1, -0.2, 0.5]),
        ],
        lengths: vec![7.0, 9.0],
    })
}

fn shapes(slew: &Slew) -> Vec<(ProgramShape, CostWeights)> {
    let effort = CostWeights {
        effort: 3.0,
        ..CostWeights::TIME
    };
    let budget = |measure| CostWeights {
        measure,
        budget: Some(4.0),
        ..CostWeights::TIME
    };
    let within = |duration| CostWeights {
        duration: Some(duration),
        ..effort
    };
    let energy = |measure| CostWeights::energy_in(16.0, measure);
    let given = IntervalLengths::Given(vec![7.0, 9.0]);
    [
        (TorqueCourse::Steps, IntervalLengths::Free, effort),
        (TorqueCourse::Steps, IntervalLengths::Free, within(16.0)),
        (
            TorqueCourse::Steps,
            IntervalLengths::Free,
            energy(EnergyMeasure::Bill),
        ),
        (
            TorqueCourse::Steps,
            IntervalLengths::Free,
            budget(EnergyMeasure::Proxy),
        ),
        (
            TorqueCourse::Steps,
            IntervalLengths::Shared,
            budget(EnergyMeasure::Bill),
        ),
        (
            TorqueCourse::Steps,
            given.clone(),
            energy(EnergyMeasure::Proxy),
        ),
        (TorqueCourse::Ramps, IntervalLengths::Shared, effort),
        (
            TorqueCourse::Ramps,
            IntervalLengths::Free,
            budget(EnergyMeasure::Bill),
        ),
        (TorqueCourse::Ramps, given, energy(EnergyMeasure::Bill)),
    ]
    .map(|(course, lengths, of)| (slew.shape(course, lengths, &of), of))
    .to_vec()
}

struct Fixture {
    program: Program,
    iterate: Iterate,
    node: usize,
    gap: Vec<f64>,
    equality: Vec<f64>,
    inequality: Vec<f64>,
}

impl Fixture {
    fn new(slew: &Slew, (shape, cost_weights): (ProgramShape, CostWeights), node: usize) -> Self {
        let vehicle = slew.vehicle();
        let scales = Scales::for_legs(&vehicle.dynamics, 0.8, 16.0);
        let units = ProgramUnits {
            cost: 3.0,
            energy: 2.0,
        };
        let motion = motion();
        let setup = ProgramSetup {
            waypoints: slew.ends(),
            intervals: 2,
            shape,
            cost_weights,
            scales,
            units,
        };
        let mut program = Program::new(vehicle, setup);
        program.penalty = LengthPenalty {
            weight: 0.3,
            lengths: vec![0.6; 2],
        };
        if program.shape.lengths == IntervalLengths::Free {
            program.base.limit_lengths(&[20.0, 30.0]);
        }
        program.torque_reserve = vec![0.01, 0.02, 0.03];
        let iterate = program.iterate_at(&motion);
        let weights = |n: usize, seed: f64| (0..n).map(|i| (seed + i as f64).sin()).collect();
        Self {
            gap: weights(program.state_dim(), 1.0),
            equality: weights(program.equalities(node), 2.0),
            inequality: weights(program.inequalities(node), 3.0),
            program,
            iterate,
            node,
        }
    }

    /// The model after a step of the state and the controls.
    fn model(&self, step: &[f64]) -> LinkModel {
        let layout = Layout::of(&self.program);
        let base = self.iterate.link(&layout, self.node);
        let states = self.program.state_dim();
        let mut point = vec![0.0; states + 1];
        self.program
            .retract(base.point, &step[..states], &mut point);
        let steps = base.control.iter().zip(&step[states..]);
        let control: Vec<f64> = steps.map(|(c, s)| c + s).collect();
        let link = Link {
            node: self.node,
            point: &point,
            control: &control,
            next: base.next,
        };
        let duals = LinkMultipliers {
            gap: if control.is_empty() { &[] } else { &self.gap },
            equality: &self.equality,
            inequality: &self.inequality,
        };
        let mut model = models_of(&self.program).swap_remove(self.node);
        self.program.values(&link, &mut model.values);
        self.program.derivatives(&link, &duals, &mut model);
        model
    }

    fn lagrangian(&self, model: &LinkModel) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let values = &model.values;
        values.cost + dot(&self.gap, &values.gap) + dot(&self.equality, &values.equality)
            - dot(&self.inequality, &values.inequality)
    }

    fn check_first(&self) {
        let zero = vec![0.0; 40];
        let base = self.model(&zero);
        let (vars, states, by) = (base.vars, self.program.state_dim(), 1e-6);
        for column in 0..vars {
            let mut step = zero.clone();
            step[column] = by;
            let plus = self.model(&step).values;
            step[column] = -by;
            let minus = self.model(&step).values;
            let close = |exact: f64, plus: f64, minus: f64, what: &str| {
                let numeric = (plus - minus) / (2.0 * by);
                let scale = exact.abs().max(1.0);
                assert!(
                    (exact - numeric).abs() < 1e-6 * scale,
                    "{what} column {column} of {:?}: {exact} {numeric}",
                    self.program.shape
                );
            };
            close(base.gradient[column], plus.cost, minus.cost, "cost");
            for (row, (p, m)) in plus.gap.iter().zip(&minus.gap).enumerate() {
                let exact = base.link_jacobian[row * vars + column];
                close(exact, *p, *m, &format!("link {row}"));
            }
            for (row, (p, m)) in plus.inequality.iter().zip(&minus.inequality).enumerate() {
                let exact = base.inequality_row(row)[column];
                close(exact, *p, *m, &format!("inequality {row}"));
            }
            for (row, (p, m)) in plus.equality.iter().zip(&minus.equality).enumerate() {
                if column < states {
                    let exact = base.equality_jacobian[row * states + column];
                    close(exact, *p, *m, &format!("equality {row}"));
                }
            }
        }
    }

    fn check_second(&self) {
        let zero = vec![0.0; 40];
        let base = self.model(&zero);
        let (vars, by) = (base.vars, 1e-4);
        let at = |i: usize, si: f64, j: usize, sj: f64| {
            let mut step = zero.clone();
            step[i] += si * by;
            step[j] += sj * by;
            self.lagrangian(&self.model(&step))
        };
        for i in 0..vars {
            for j in 0..=i {
                let numeric = (at(i, 1.0, j, 1.0) - at(i, 1.0, j, -1.0) - at(i, -1.0, j, 1.0)
                    + at(i, -1.0, j, -1.0))
                    / (4.0 * by * by);
                let exact = base.hessian[i * vars + j];
                assert!(
                    (exact - numeric).abs() < 1e-4 * exact.abs().max(1.0),
                    "hessian {i} {j} of {:?} at {}: {exact} {numeric}",
                    self.program.shape,
                    self.node
                );
            }
        }
    }
}

#[test]
fn derivatives_of_programs_of_every_shape_match_finite_differences() {
    let limited = PointingSpec {
        direction: Some([0.2, 0.9, 0.4].into()),
        roll_min_deg: Some(20.0),
        roll_max_deg: Some(50.0),
        ..PointingSpec::default()
    };
    let slews = [
        slew(WheelAllocation::Free, None),
        slew(WheelAllocation::PseudoInverse, None),
        slew(WheelAllocation::Free, Some(limited)),
    ];
    for slew in slews {
        for of in shapes(&slew) {
            for node in 0..3 {
                let fixture = Fixture::new(&slew, of.clone(), node);
                fixture.check_first();
                fixture.check_second();
            }
        }
    }
}

#[test]
fn a_wheel_under_a_speed_law_is_locked_and_not_an_actuator() {
    let (spacecraft, drives, start) = biros(true);
    let spec = SlewSpec {
        spacecraft,
        drives,
        start,
        ..SlewSpec::default()
    };
    let slew = Slew::try_new(&spec).expect("valid").slew;
    assert_eq!(slew.vehicle().dynamics.wheel_count(), 3);
    let stored = slew.vehicle().dynamics.locked_momentum;
    assert!(
        (stored - Vector3::new(0.0, 0.0, -0.194)).norm() < 1e-4,
        "{stored}"
    );
}
