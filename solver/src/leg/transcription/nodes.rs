//! Conditions at nodes: which rows hold where.

use super::Transcription;
use super::attitude_rows::AttitudeRows;
use super::rows::{LimitRow, Row};
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use nalgebra::Vector3;

/// Smallest unit of a rate limit's row, in units of a typical rate. In the unit of a limit near
/// zero the row would be steeper than all others by orders of magnitude.
const MIN_RATE_UNIT: f64 = 1e-2;

/// The rows of one node.
#[derive(Debug, Clone, Default)]
pub(super) struct Node {
    /// Conditions on the attitude.
    pub(super) attitude: Option<AttitudeRows>,
    /// Rows that are zero.
    pub(super) equalities: Vec<Row>,
    /// Rows that are not negative, beside the limits.
    pub(super) inequalities: Vec<Row>,
    /// Whether speed and rate limits are imposed: not where the state is fixed, since a fixed
    /// state on a limit would leave no interior.
    pub(super) limited: bool,
    /// Costates of the wheel momenta, scaled; empty where momenta cost nothing.
    pub(super) costates: Vec<f64>,
}

impl Transcription {
    /// Nodes of all legs; a waypoint's conditions stand at the node between two legs.
    pub(super) fn lay_out(&self, waypoints: &[Waypoint], intervals: &[usize]) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(intervals.iter().sum::<usize>() + 1);
        for (waypoint, count) in waypoints.iter().zip(intervals) {
            nodes.push(self.waypoint_node(waypoint));
            let free = Node {
                limited: true,
                ..Node::default()
            };
            nodes.extend(std::iter::repeat_n(free, count.saturating_sub(1)));
        }
        nodes.extend(
            waypoints
                .last()
                .map(|waypoint| self.waypoint_node(waypoint)),
        );
        nodes
    }

    /// All inequality rows of a node except the norm limit.
    pub(super) fn inequality_rows<'a>(&'a self, node: &'a Node) -> impl Iterator<Item = &'a Row> {
        let limits = self.limits_of(node).iter().map(|limit| &limit.row);
        limits.chain(&node.inequalities)
    }

    /// The limit rows of a node.
    pub(super) fn limits_of(&self, node: &Node) -> &[LimitRow] {
        if node.limited { &self.limits } else { &[] }
    }

    /// Whether the norm of the rate is limited at a node.
    pub(super) fn has_norm_row(&self, node: &Node) -> bool {
        node.limited && self.dynamics.max_rate_norm.is_finite()
    }

    fn waypoint_node(&self, waypoint: &Waypoint) -> Node {
        let mut node = Node {
            attitude: Some(AttitudeRows::of(waypoint)),
            limited: !waypoint.fixes_limits(&self.dynamics),
            costates: self.scaled_costates(waypoint),
            ..Node::default()
        };
        match &waypoint.wheels {
            WheelCondition::Fixed(momenta) => {
                for (i, h) in momenta.iter().enumerate() {
                    let constant = -h / self.scales.momentum;
                    node.equalities
                        .push(self.row(constant, Vector3::zeros(), &[(i, 1.0)]));
                }
                // Attitude and all wheel momenta determine the rates.
                return node;
            }
            WheelCondition::NullSpace(components) => {
                for (column, value) in self
                    .dynamics
                    .null_space
                    .column_iter()
                    .zip(components.iter())
                {
                    let constant = -value / self.scales.momentum;
                    let wheels: Vec<_> = column.iter().copied().enumerate().collect();
                    node.equalities
                        .push(self.row(constant, Vector3::zeros(), &wheels));
                }
            }
            WheelCondition::Free => {}
        }
        for (axis, condition) in waypoint.rate.iter().enumerate() {
            self.add_rate_rows(axis, *condition, &mut node);
        }
        node
    }

    /// The costates of a waypoint in units of time per unit of momentum.
    fn scaled_costates(&self, waypoint: &Waypoint) -> Vec<f64> {
        let unit = self.scales.momentum / self.scales.time;
        let costates = waypoint.costates.iter().flatten();
        costates.map(|costate| costate * unit).collect()
    }

    fn add_rate_rows(&self, axis: usize, condition: RateCondition, node: &mut Node) {
        let unit = self.scales.rate.recip();
        let row = |sign: f64, value: f64| {
            self.row(-sign * value * unit, Vector3::ith(axis, sign * unit), &[])
        };
        match condition {
            RateCondition::Free => {}
            RateCondition::Fixed(value) => node.equalities.push(row(1.0, value)),
            RateCondition::Within(low, high) if low >= high => node.equalities.push(row(1.0, low)),
            RateCondition::Within(low, high) => {
                if low.is_finite() {
                    node.inequalities.push(row(1.0, low));
                }
                if high.is_finite() {
                    node.inequalities.push(row(-1.0, high));
                }
            }
        }
    }

    /// Rows `1 -+ share` of all speed and rate limits that can be reached.
    pub(super) fn limit_rows(&self) -> Vec<LimitRow> {
        let mut rows = Vec::new();
        for (i, wheel) in self.dynamics.actuators.iter().enumerate() {
            if !wheel.max_speed.is_finite() {
                continue;
            }
            for sign in [1.0, -1.0] {
                let per_momentum = self.scales.momentum / (wheel.inertia * wheel.max_speed);
                let by_rate = wheel.axis * (sign / wheel.max_speed);
                rows.push(LimitRow {
                    row: self.row(1.0, by_rate, &[(i, -sign * per_momentum)]),
                    limit: 1.0,
                    share: i,
                });
            }
        }
        let reachable = self.dynamics.reachable_rates();
        for axis in 0..3 {
            let limit = self.dynamics.max_rate[axis];
            if limit.is_finite() && limit <= reachable[axis] {
                // In units of the limit, unless that is close to zero.
                let unit = limit.max(MIN_RATE_UNIT * self.scales.rate);
                for sign in [1.0, -1.0] {
                    let limit = limit / unit;
                    rows.push(LimitRow {
                        row: self.row(limit, Vector3::ith(axis, -sign / unit), &[]),
                        limit,
                        share: self.wheels() + axis,
                    });
                }
            }
        }
        rows
    }
}
