//! Minimum-time attitude scheduling for spacecraft with reaction wheels.
//!
//! # The problem
//!
//! A rigid spacecraft with reaction wheels starts from a known state and has to pass through a set
//! of attitudes `q_1 .. q_n` in any order, at each of them with certain body-rate components zero,
//! bounded or free, and to end in a given attitude and rate. Sought are the order and the wheel
//! torques of minimum time:
//!
//! ```text
//!   minimise   T
//!   subject to q' = 1/2 q (x) [w, 0],     J_eff w = R(q)^T H - A h,     h' = u
//!              u_min <= u <= u_max,       |h_i / I_i - a_i . w| <= W_i,     |w_j| <= r_j
//!              q(t_k) = q_order(k),       rate conditions at t_1 < t_2 < ... < T
//! ```
//!
//! with `h` the wheels' momenta about their axes (the columns of `A`) and `H` the total momentum,
//! constant in the reference frame: the body rate follows from attitude and wheels.
//!
//! # The method
//!
//! [`model::scenario::Scenario::try_new`] turns a description into a scenario that is valid by
//! construction, or lists all problems. [`tour::planner::solve`] then solves the tables of leg
//! times, searches the order by branch and bound with multi-phase nonlinear programs as nodes and
//! leaves, and hands the winner to [`checker::verify`], which integrates the full dynamics again
//! with code of its own. The mathematics and the symbols are in `solver/docs/mathematics.md`, the map of
//! the modules and a glossary in `ARCHITECTURE.md`, further programs in `solver/examples`.
//!
//! # Example
//!
//! A quarter turn about the body's z axis, from rest to rest:
//!
//! ```
//! use slewplan_solver::tour::legs::NoStore;
//! use slewplan_solver::model::plan::Outcome;
//! use slewplan_solver::tour::planner::{Run, solve};
//! use slewplan_solver::run::pool::SolverPool;
//! use slewplan_solver::run::progress::Silent;
//! use slewplan_solver::model::scenario::Scenario;
//! use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, SpacecraftSpec, TargetSpec, WheelSpec};
//! use slewplan_solver::run::stop::StopSignal;
//!
//! let wheel = |axis| WheelSpec {
//!     axis,
//!     normalize_axis: true,
//!     inertia_kg_m2: 0.000_169,
//!     max_torque_nm: 0.0101,
//!     min_torque_nm: None,
//!     max_speed_rad_s: Some(710.0),
//!     enabled: true,
//! };
//! let spec = ScenarioSpec {
//!     spacecraft: SpacecraftSpec {
//!         inertia_kg_m2: [[6.63, 0.0, 0.0], [0.0, 8.90, 0.0], [0.0, 0.0, 9.63]],
//!         wheels: vec![wheel([1.0, 0.0, 0.0]), wheel([0.0, 1.0, 0.0]), wheel([0.0, 0.0, 1.0])],
//!         ..SpacecraftSpec::default()
//!     },
//!     targets: vec![TargetSpec {
//!         id: "quarter".into(),
//!         attitude: AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 90.0]),
//!         ..TargetSpec::default()
//!     }],
//!     ..ScenarioSpec::default()
//! };
//! let scenario = Scenario::try_new(&spec).expect("a valid description").scenario;
//! let (pool, stop) = (SolverPool::new(None)?, StopSignal::new());
//! let run = Run { pool: &pool, stop: &stop, observer: &Silent, legs: &NoStore,
//!     segments: &NoStore };
//! let Outcome::Planned(plan) = solve(&scenario, run) else { panic!("a quarter turn is possible") };
//! assert!(plan.verification.passed);
//! // About the eigenaxis it would take 138 s.
//! assert!(plan.total_time_s < 114.0);
//! # Ok::<(), slewplan_solver::run::pool::PoolError>(())
//! ```

pub mod bounds;
pub mod checker;
mod leg;
pub mod math;
pub mod model;
mod nlp;
pub mod run;
pub mod simulation;
pub mod slew;
pub mod tour;
pub mod wheels;
