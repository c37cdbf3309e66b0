//! From continuous motions through waypoints to a chain-structured nonlinear program.
//!
//! A motion passes waypoints `0 .. L`; each leg between two of them has intervals of constant
//! torque whose lengths are unknowns, so that nodes lie on the switches and the torques can be
//! commanded exactly. Variables of interval `k` (scaled, see [`Scales`]):
//!
//! | symbol | meaning |
//! |---|---|
//! | `q_k` | attitude at its beginning |
//! | `h_k` | wheel momenta at its beginning |
//! | `m_k` | change of the wheel momenta over it |
//! | `tau_k` | its length; the torque is `m_k / tau_k` |
//!
//! With `m` instead of torque all links and limits but the attitude's are linear:
//! `h_{k+1} = h_k + m_k`, `min_torque tau <= m <= max_torque tau` (which implies `tau >= 0`), and
//! an interval may shrink to nothing without any variable losing its meaning. Speed and rate limits
//! hold at nodes; between nodes `h` is linear, so without total momentum they hold there too. With
//! it rate limits hold in the middle of intervals as well ([`middle`]), and excesses found between
//! nodes tighten all limits ([`Reserves`]).
//!
//! Where times of passages are bounded ([`PassageTimes`]), the elapsed time is one more state, which
//! takes the length of each interval as a wheel momentum takes its change.
//!
//! The attitude link is `2 vec(q_{k+1}* q_k p_k) = 0` with the turn `p_k` of
//! [`crate::leg::kinematics`].

mod attitude_link;
mod attitude_rows;
mod clock;
mod cones;
mod demands;
mod middle;
mod nodes;
mod reserves;
mod rows;
mod scales;
#[cfg(test)]
mod tests;

use crate::model::waypoint::{Waypoint, WheelCondition};
pub(crate) use clock::PassageTimes;
pub(crate) use reserves::{ConeDepth, Reserves};
pub(crate) use rows::{Drift, Row};
pub(crate) use scales::{MIN_TURN, Scales};

use crate::leg::kinematics::{TurnMap, exact_turn};
use crate::math::quaternion::{Quat, conjugate, imaginary, product};
use crate::model::dynamics::Dynamics;
use crate::model::spacecraft::MAX_ENABLED;
use crate::nlp::{
    Chain, Iterate, Link, LinkModel, LinkMultipliers, LinkValues, MAX_CONTROLS, MAX_STATES,
};
use attitude_rows::AttitudeRows;
use middle::MiddleRow;
use nalgebra::Vector3;
use nodes::Node;
use rows::LimitRow;

/// The largest compiled size of the engine holds the states and controls of [`MAX_ENABLED`] wheels.
const _: () = assert!(3 + MAX_ENABLED <= MAX_STATES && MAX_ENABLED < MAX_CONTROLS);

/// Weights of a penalty on controls: half of the square of their distance from given ones.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ControlPenalty {
    /// On the lengths of intervals.
    pub(crate) length: f64,
    /// On the changes of wheel momenta over them.
    pub(crate) change: f64,
}

impl ControlPenalty {
    /// On lengths alone.
    pub(crate) const fn of_lengths(length: f64) -> Self {
        Self {
            length,
            change: 0.0,
        }
    }
}

/// The quaternion of no turn.
const NO_TURN: Quat = [0.0, 0.0, 0.0, 1.0];

/// A motion through waypoints as a nonlinear program.
#[derive(Debug, Clone)]
pub(crate) struct Transcription {
    dynamics: Dynamics,
    scales: Scales,
    turn_map: TurnMap,
    /// Fixed turns that make the turn map exact on each interval, see [`Transcription::correct`].
    corrections: Vec<Quat>,
    /// `ts Ji h_locked` and `ts hs Ji A`: the wheels' share of the scaled rate is
    /// `-(offset + gain h)`.
    rate_offset: Vector3<f64>,
    rate_gain: Vec<Vector3<f64>>,
    /// Greatest and least `m` per unit of `tau`.
    momentum_per_time: Vec<(f64, f64)>,
    /// Scaled controls to which a penalty draws those of the intervals, and its weights. Where
    /// torque does not change from one interval to the next the cost does not depend on the node
    /// between them; the penalty makes the solution unique.
    reference_controls: Vec<f64>,
    penalty: ControlPenalty,
    /// Limits that hold at every node whose state is not fixed.
    limits: Vec<LimitRow>,
    /// Rate limits that hold in the middle of every interval.
    middle_rows: Vec<MiddleRow>,
    /// The components of the body rate, rad/s.
    rates: [Row; 3],
    /// Longest intervals, scaled; empty where they are not limited.
    longest: Vec<f64>,
    /// Reserve kept from every limit at every node.
    reserves: Reserves,
    nodes: Vec<Node>,
    /// Whether the elapsed time is a state.
    has_clock: bool,
}

impl Transcription {
    /// Transcribes legs between waypoints; `intervals[i]` for the leg from waypoint `i` to `i+1`.
    pub(crate) fn new(
        dynamics: &Dynamics,
        scales: Scales,
        waypoints: &[Waypoint],
        intervals: &[usize],
    ) -> Self {
        let factor = scales.time * scales.momentum;
        let inverse = dynamics.inertia_inverse;
        let mut transcription = Self {
            scales,
            turn_map: TurnMap::fast(inverse, dynamics.has_momentum()),
            corrections: vec![NO_TURN; intervals.iter().sum()],
            rate_offset: inverse * dynamics.locked_momentum * scales.time,
            rate_gain: dynamics
                .actuators
                .iter()
                .map(|a| inverse * a.axis * factor)
                .collect(),
            momentum_per_time: dynamics
                .actuators
                .iter()
                .map(|a| (a.max_torque, a.min_torque))
                .map(|(max, min)| {
                    (
                        max * scales.time / scales.momentum,
                        min * scales.time / scales.momentum,
                    )
                })
                .collect(),
            reference_controls: vec![
                0.0;
                intervals.iter().sum::<usize>() * (dynamics.wheel_count() + 1)
            ],
            penalty: ControlPenalty::default(),
            limits: Vec::new(),
            middle_rows: Vec::new(),
            rates: Default::default(),
            longest: Vec::new(),
            reserves: Reserves::none(dynamics, intervals.iter().sum()),
            nodes: Vec::new(),
            has_clock: false,
            dynamics: dynamics.clone(),
        };
        transcription.rates =
            std::array::from_fn(|axis| transcription.row(0.0, Vector3::ith(axis, 1.0), &[]));
        transcription.limits = transcription.limit_rows();
        transcription.middle_rows = transcription.middle_rows_of(&transcription.limits);
        transcription.nodes = transcription.lay_out(waypoints, intervals);
        transcription
    }

    /// The reserves kept from the limits at nodes.
    pub(crate) fn reserves(&self) -> &Reserves {
        &self.reserves
    }

    /// Sets the reserves from speed and rate limits.
    pub(crate) fn keep(&mut self, reserves: &Reserves) {
        self.reserves.clone_from(reserves);
    }

    /// Sets the penalty that draws the controls to those of an iterate.
    pub(crate) fn draw_controls_to(&mut self, iterate: &Iterate, penalty: ControlPenalty) {
        self.reference_controls.clone_from(&iterate.controls);
        self.penalty = penalty;
    }

    /// Makes the turn map exact at an iterate: a fixed turn `e_k = p_k* p_exact` follows the map's
    /// turn `p_k` on every interval. Returns the sum of the angles, rad, by which the corrections
    /// change: how far the iterate misses its end.
    ///
    /// The solution of a corrected program ends where it should. Its derivatives are still those of
    /// the map, which moves the optimum by a share of the square of the map's error.
    pub(crate) fn correct(&mut self, iterate: &Iterate) -> f64 {
        let (points, controls) = (self.point_len(), self.control_dim());
        let inverse = self.dynamics.inertia_inverse;
        let with_momentum = self.dynamics.has_momentum();
        let mut missed = 0.0;
        for node in 0..self.intervals() {
            let link = Link {
                node,
                point: &iterate.points[node * points..(node + 1) * points],
                control: &iterate.controls[node * controls..(node + 1) * controls],
                next: &iterate.points[(node + 1) * points..(node + 2) * points],
            };
            let exact = exact_turn(inverse, with_momentum, &self.turn_inputs(&link));
            missed += self.correct_turn(&link, &exact);
        }
        missed
    }

    /// Corrects one interval whose exact turn is known. Returns the angle, rad.
    pub(crate) fn correct_turn(&mut self, link: &Link<'_>, exact: &Quat) -> f64 {
        let turn = self.turn_map.turn(&self.turn_inputs(link));
        let correction = product(&conjugate(&turn), exact);
        let change = product(&conjugate(&self.corrections[link.node]), &correction);
        self.corrections[link.node] = correction;
        2.0 * imaginary(&change).norm()
    }

    /// Switches to a finer map of the turn.
    pub(crate) fn use_finer_map(&mut self) {
        self.turn_map = self.turn_map.finer(self.dynamics.inertia_inverse);
    }

    /// Switches to a finer map of the turn and corrects it: for iterates at which the derivatives
    /// of the map in use are too inaccurate.
    pub(crate) fn refine(&mut self, iterate: &Iterate) {
        self.use_finer_map();
        self.correct(iterate);
    }

    fn wheels(&self) -> usize {
        self.dynamics.wheel_count()
    }

    /// `offset + gain h`: minus the wheels' share of the scaled rate.
    fn wheel_rate(&self, wheels: &[f64]) -> Vector3<f64> {
        let mut rate = self.rate_offset;
        for (gain, h) in self.rate_gain.iter().zip(wheels) {
            rate += gain * *h;
        }
        rate
    }

    /// Number of inequalities on the state at a node.
    pub(crate) fn state_inequalities(&self, node: usize) -> usize {
        let cones = self.cones_at(node).len();
        let node = &self.nodes[node];
        let of_roll = node.attitude.as_ref().map_or(0, AttitudeRows::inequalities);
        of_roll + self.inequality_rows(node).count() + usize::from(self.has_norm_row(node)) + cones
    }

    fn torque_margins<'a>(&'a self, control: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let tau = control[self.wheels()];
        self.momentum_per_time
            .iter()
            .zip(control)
            .flat_map(move |((max, min), m)| [tau - m / max, tau - m / min])
    }

    /// The weight of every control's penalty, and how far the control is from its reference.
    fn away_from_reference<'a>(
        &'a self,
        link: &'a Link<'_>,
    ) -> impl Iterator<Item = (f64, f64)> + 'a {
        let wheels = self.wheels();
        let references = &self.reference_controls[link.node * (wheels + 1)..];
        let controls = link.control.iter().zip(references).enumerate();
        controls.map(move |(i, (control, reference))| {
            let weight = if i == wheels {
                self.penalty.length
            } else {
                self.penalty.change
            };
            (weight, control - reference)
        })
    }

    /// Cost of the wheel momenta at a node, scaled.
    fn cost_of_momenta(&self, link: &Link<'_>) -> f64 {
        let costates = self.nodes[link.node].costates.iter();
        costates
            .zip(&link.point[4..])
            .map(|(costate, h)| costate * h)
            .sum()
    }

    /// Writes the conditions on a state at a node; returns how many inequalities.
    pub(crate) fn write_state_values(
        &self,
        at: usize,
        (point, drift): (&[f64], Drift),
        out: &mut LinkValues,
    ) -> usize {
        let (node, reserves) = (&self.nodes[at], self.reserves.at(at));
        let state = self.view(point, drift);
        let mut equalities = out.equality.as_mut_slice();
        let mut count = 0;
        if let Some(rows) = &node.attitude {
            let (attitude, rest) = equalities.split_at_mut(rows.equalities());
            self.write_attitude_values(rows, point, (attitude, &mut out.inequality));
            equalities = rest;
            count = rows.inequalities();
        }
        for (out, row) in equalities.iter_mut().zip(&node.equalities) {
            *out = row.value(&state);
        }
        let first = count;
        for row in self.inequality_rows(node) {
            out.inequality[count] = row.value(&state);
            count += 1;
        }
        let values = out.inequality[first..].iter_mut();
        for (value, limit) in values.zip(self.limits_of(node)) {
            *value -= reserves[limit.share] * limit.limit;
        }
        if self.has_norm_row(node) {
            let norm = self.wheels() + 3;
            out.inequality[count] = self.norm_margin(&state, reserves[norm]);
            count += 1;
        }
        for margin in self.cone_margins(at, point) {
            out.inequality[count] = margin;
            count += 1;
        }
        count
    }

    /// Writes the derivatives of the conditions on a state by so many of its directions; returns
    /// how many inequalities.
    pub(crate) fn write_state_derivatives(
        &self,
        link: &Link<'_>,
        (drift, states): (Drift, usize),
        duals: &LinkMultipliers<'_>,
        out: &mut LinkModel,
    ) -> usize {
        let node = &self.nodes[link.node];
        let state = self.view(link.point, drift);
        let (mut offset, mut count) = (0, 0);
        if let Some(rows) = &node.attitude {
            self.write_attitude_equalities(rows, link.point, (duals.equality, states), out);
            self.write_roll_limits(rows, link.point, (0, duals.inequality), out);
            (offset, count) = (rows.equalities(), rows.inequalities());
        }
        let mut curvature = Vector3::zeros();
        for (i, row) in node.equalities.iter().enumerate() {
            let at = (offset + i) * states;
            self.write_row(row, &state, &mut out.equality_jacobian[at..at + states]);
            curvature += row.momentum * duals.equality[offset + i];
        }
        for row in self.inequality_rows(node) {
            let at = count * out.vars;
            self.write_row(row, &state, &mut out.inequality_jacobian[at..at + states]);
            curvature -= row.momentum * duals.inequality[count];
            count += 1;
        }
        if self.has_norm_row(node) {
            let (stride, z) = (out.vars, duals.inequality[count]);
            let row = &mut out.inequality_jacobian[count * stride..(count + 1) * stride];
            let size = (states, stride);
            curvature += self.write_norm_row(&state, z, row, &mut out.hessian, size);
            count += 1;
        }
        self.add_momentum_curvature(&curvature, &state, out);
        self.write_cone_rows((link.node, count), link.point, duals.inequality, out);
        count + self.cones_at(link.node).len()
    }
}

impl Chain for Transcription {
    fn intervals(&self) -> usize {
        self.nodes.len() - 1
    }

    fn point_len(&self) -> usize {
        1 + self.state_dim()
    }

    fn state_dim(&self) -> usize {
        3 + self.wheels() + usize::from(self.has_clock)
    }

    fn control_dim(&self) -> usize {
        self.wheels() + 1
    }

    fn equalities(&self, node: usize) -> usize {
        let node = &self.nodes[node];
        let of_attitude = node.attitude.as_ref().map_or(0, AttitudeRows::equalities);
        of_attitude + node.equalities.len()
    }

    fn inequalities(&self, node: usize) -> usize {
        let of_interval = if node < self.intervals() {
            2 * self.wheels() + self.middle_limits() + usize::from(!self.longest.is_empty())
        } else {
            0
        };
        self.state_inequalities(node) + of_interval
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        let half = self.scales.angle / 2.0;
        let turn = [half * step[0], half * step[1], half * step[2], 1.0];
        let q = product(&quaternion_of(point), &turn);
        let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
        for i in 0..4 {
            moved[i] = q[i] / norm;
        }
        for ((out, h), dh) in moved[4..].iter_mut().zip(&point[4..]).zip(&step[3..]) {
            *out = h + dh;
        }
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        let count = self.write_state_values(link.node, (link.point, Drift::default()), out);
        out.cost = self.cost_of_momenta(link);
        if link.has_interval() {
            out.cost += link.control[self.wheels()];
            for (weight, away) in self.away_from_reference(link) {
                out.cost += 0.5 * weight * away.powi(2);
            }
            self.write_gap(link, &mut out.gap);
            for (out, margin) in out.inequality[count..]
                .iter_mut()
                .zip(self.torque_margins(link.control))
            {
                *out = margin;
            }
            let count = count + 2 * self.wheels();
            let margins = self.middle_margins(link);
            for (out, margin) in out.inequality[count..].iter_mut().zip(margins) {
                *out = margin;
            }
            if let Some(longest) = self.longest_at(link.node) {
                let last = count + self.middle_limits();
                out.inequality[last] = 1.0 - link.control[self.wheels()] / longest;
            }
        }
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        let node = &self.nodes[link.node];
        let still = (Drift::default(), self.state_dim());
        let count = self.write_state_derivatives(link, still, duals, out);
        out.gradient[3..][..node.costates.len()].copy_from_slice(&node.costates);
        if !link.has_interval() {
            return;
        }
        let (wheels, states) = (self.wheels(), self.state_dim());
        let tau = states + wheels;
        out.gradient[tau] = 1.0;
        for (i, (weight, away)) in self.away_from_reference(link).enumerate() {
            let at = states + i;
            out.gradient[at] += weight * away;
            out.hessian[at * out.vars + at] += weight;
        }
        let middle = count + 2 * wheels;
        let z = &duals.inequality[middle..middle + self.middle_limits()];
        self.write_attitude_link(link, duals.gap, (middle, z), out);
        // The clock takes the length, which is the control after the changes.
        for i in 0..states - 3 {
            let row = (3 + i) * out.vars;
            out.link_jacobian[row + 3 + i] = 1.0;
            out.link_jacobian[row + states + i] = 1.0;
        }
        for (i, (max, min)) in self.momentum_per_time.iter().enumerate() {
            for (row, bound) in [(count + 2 * i, max), (count + 2 * i + 1, min)] {
                out.inequality_jacobian[row * out.vars + states + i] = -bound.recip();
                out.inequality_jacobian[row * out.vars + tau] = 1.0;
            }
        }
        if let Some(longest) = self.longest_at(link.node) {
            let last = middle + self.middle_limits();
            out.inequality_jacobian[last * out.vars + tau] = -longest.recip();
        }
    }
}

fn quaternion_of(point: &[f64]) -> Quat {
    [point[0], point[1], point[2], point[3]]
}
