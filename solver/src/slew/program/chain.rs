//! The program as a chain of stages: values, and derivatives by the chain rule.

use super::{Program, SparseDerivatives, TermTarget};
use crate::nlp::{Chain, Link, LinkModel, LinkMultipliers, LinkValues};
use nalgebra::DVector;

/// The variables `(q, h)` and `(m, tau)` of the transcription's attitude link.
pub(super) struct BaseLink {
    point: Vec<f64>,
    control: Vec<f64>,
}

impl BaseLink {
    /// The link of the chain in these variables.
    pub(super) fn link<'a>(&'a self, link: &Link<'a>, wheels: usize) -> Link<'a> {
        Link {
            node: link.node,
            point: &self.point,
            control: &self.control,
            next: &link.next[..4 + wheels],
        }
    }
}

impl Program {
    /// `(q, h)` and `(m, tau)` of an interval, computed from the program's own variables.
    pub(super) fn base_link(&self, link: &Link<'_>) -> BaseLink {
        let wheels = self.shape.wheels;
        let mut base = BaseLink {
            point: link.point[..4 + wheels].to_vec(),
            control: vec![0.0; wheels + 1],
        };
        let unit = self.scales.momentum;
        let [from, to] = self.drifts(link).map(|[taken, ..]| taken);
        for i in 0..wheels {
            let state = self.wheel_state(i, link);
            base.point[4 + i] += state.bulge().value / unit + from[i];
            base.control[i] = state.impulse().value / unit + to[i] - from[i];
        }
        base.control[wheels] = self.length(link);
        base
    }

    /// Momentum drift of the speed-law wheels at the beginning and the end of an interval, as momenta of
    /// the enabled wheels with the same effect on the body, scaled, with derivatives by the clock.
    fn drifts(&self, link: &Link<'_>) -> [[DVector<f64>; 3]; 2] {
        [0.0, self.length(link)].map(|length| {
            let drift = self.drift_after(link.point, length);
            drift.taken.map(|taken| &self.equivalent * taken)
        })
    }

    /// The variables of the attitude link as functions of those of the program.
    fn base_locals(&self, link: &Link<'_>) -> Vec<SparseDerivatives> {
        let (wheels, unit) = (self.shape.wheels, self.scales.momentum.recip());
        let itself = |at: usize| SparseDerivatives {
            gradient: vec![(at, 1.0)],
            hessian: Vec::new(),
        };
        let mut locals: Vec<_> = (0..3 + wheels).map(itself).collect();
        for i in 0..wheels {
            let bulge = self.wheel_state(i, link).bulge() * unit;
            let bulge = self.local(i, &bulge, link);
            locals[3 + i].gradient.extend(bulge.gradient);
            locals[3 + i].hessian.extend(bulge.hessian);
        }
        for i in 0..wheels {
            let impulse = self.wheel_state(i, link).impulse() * unit;
            locals.push(self.local(i, &impulse, link));
        }
        let length = self.shape.length_variable();
        locals.push(length.map_or_else(SparseDerivatives::default, itself));
        if self.speed_law_wheels.any_drift() {
            self.add_drifts(link, &mut locals);
        }
        locals
    }

    /// Adds the derivatives of the attitude link's variables by clock and length through the drift.
    fn add_drifts(&self, link: &Link<'_>, locals: &mut [SparseDerivatives]) {
        let wheels = self.shape.wheels;
        let [[_, from, from_bend], [_, to, to_bend]] = self.drifts(link);
        let clock = self.shape.clock_at();
        for i in 0..wheels {
            let momentum = &mut locals[3 + i];
            momentum.gradient.push((clock, from[i]));
            momentum.hessian.push((clock, clock, from_bend[i]));
            let change = &mut locals[3 + wheels + i];
            change.gradient.push((clock, to[i] - from[i]));
            let bend = to_bend[i] - from_bend[i];
            change.hessian.push((clock, clock, bend));
            if let Some(length) = self.shape.length_variable() {
                change.gradient.push((length, to[i]));
                change.hessian.push((length, length, to_bend[i]));
                let (row, column) = (length.max(clock), length.min(clock));
                change.hessian.push((row, column, to_bend[i]));
            }
        }
    }

    /// Adds the derivatives of the attitude link, which `base` has in its own variables, by the chain
    /// rule. `weights` are the multipliers of the attitude gap, `z` those of the rates in the middle.
    fn pull_back(
        &self,
        base: &LinkModel,
        weights: &[f64],
        z: &[f64],
        link: &Link<'_>,
        out: &mut LinkModel,
    ) {
        let locals = self.base_locals(link);
        let middle = self.middle_rows_at(link.node);
        for (a, local) in locals.iter().enumerate() {
            let mut weighted = 0.0;
            for row in 0..3 {
                let slope = base.link_jacobian[row * base.vars + a];
                weighted += weights[row] * slope;
                for (at, c) in &local.gradient {
                    out.link_jacobian[row * out.vars + at] += slope * c;
                }
            }
            for (row, z) in z.iter().enumerate() {
                let slope = base.inequality_jacobian[row * base.vars + a];
                weighted -= z * slope;
                for (at, c) in &local.gradient {
                    out.inequality_jacobian[(middle + row) * out.vars + at] += slope * c;
                }
            }
            for (i, j, bend) in &local.hessian {
                out.hessian[i * out.vars + j] += weighted * bend;
            }
            for (b, other) in locals[..=a].iter().enumerate() {
                let bend = base.hessian[a * base.vars + b];
                if bend == 0.0 {
                    continue;
                }
                for (i, c) in &local.gradient {
                    for (j, d) in &other.gradient {
                        let twice = if a != b && i == j { 2.0 } else { 1.0 };
                        if a != b || i >= j {
                            out.hessian[i.max(j) * out.vars + i.min(j)] += twice * bend * c * d;
                        }
                    }
                }
            }
        }
    }

    /// Adds a term to the derivatives of a link, weighted by the multipliers.
    fn add_term(
        &self,
        term: &super::WheelTerm<'_>,
        duals: &LinkMultipliers<'_>,
        out: &mut LinkModel,
    ) {
        let local = self.local(term.wheel, &term.jet, term.link);
        let (row, weight) = place_in(term.place, duals, out);
        for (at, c) in &local.gradient {
            row[*at] += c;
        }
        for (i, j, bend) in &local.hessian {
            out.hessian[i * out.vars + j] += weight * bend;
        }
        // With stored momentum the wheel's speed has second derivatives by the attitude.
        let by_speed = weight * term.jet.gradient[super::SPEED];
        let pull = self.speeds[term.wheel].momentum * by_speed;
        let drift = self.drift(term.link.point);
        let view = self.base.view(term.link.point, drift);
        self.base.add_momentum_curvature(&pull, &view, out);
    }

    /// Adds the derivatives of the transcription's conditions on the state at a node.
    fn add_state(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        let node = Link {
            control: &[],
            next: &[],
            ..*link
        };
        let extended = (self.drift(link.point), self.shape.states());
        self.base
            .write_state_derivatives(&node, extended, duals, out);
    }

    /// Entries of the state with a given value at the first or last node: `(index, value)`.
    fn fixed_parts(&self, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let (first, last) = (node == 0, node == self.base.intervals());
        let at = self.shape.clock_at();
        let begin = (first && self.shape.clock).then_some((at, 0.0));
        let total = self.clocked_duration().filter(|_| last);
        let end = total.map(|total| (at, total / self.scales.time));
        let clock = begin.or(end);
        let energy_account =
            (self.shape.energy_account && first).then(|| (self.shape.energy_account_at(), 0.0));
        clock.into_iter().chain(energy_account)
    }

    /// The duration, s, where it is a condition on the clock; given lengths sum up to it without one.
    fn clocked_duration(&self) -> Option<f64> {
        let free = self.shape.clock && self.shape.length_variable().is_some();
        self.cost_weights.duration.filter(|_| free)
    }

    /// Index of the equality at the last node that prescribes the duration, if there is one.
    pub(in crate::slew) fn clock_end_row(&self) -> Option<usize> {
        self.clocked_duration()
            .map(|_| self.base.equalities(self.base.intervals()))
    }

    /// Difference of a length from the one that the penalty draws it to, scaled.
    pub(super) fn stray(&self, link: &Link<'_>) -> f64 {
        self.length(link) - self.penalty.lengths[link.node]
    }

    pub(super) fn draws_lengths(&self) -> bool {
        self.penalty.weight > 0.0 && self.shape.length_variable().is_some()
    }
}

/// The gradient of a target and the weight of its second derivatives in the Lagrangian.
fn place_in<'a>(
    place: TermTarget,
    duals: &LinkMultipliers<'_>,
    out: &'a mut LinkModel,
) -> (&'a mut [f64], f64) {
    let vars = out.vars;
    match place {
        TermTarget::Cost => (&mut out.gradient, 1.0),
        TermTarget::Gap(row) => (
            &mut out.link_jacobian[row * vars..(row + 1) * vars],
            duals.gap[row],
        ),
        TermTarget::Inequality(row) => (
            &mut out.inequality_jacobian[row * vars..(row + 1) * vars],
            -duals.inequality[row],
        ),
    }
}

impl Chain for Program {
    fn intervals(&self) -> usize {
        self.base.intervals()
    }

    fn point_len(&self) -> usize {
        1 + self.shape.states()
    }

    fn state_dim(&self) -> usize {
        self.shape.states()
    }

    fn control_dim(&self) -> usize {
        self.shape.controls()
    }

    fn equalities(&self, node: usize) -> usize {
        let own = self.fixed_parts(node).count() + self.allocation_rows(node).count();
        self.base.equalities(node) + own
    }

    fn inequalities(&self, node: usize) -> usize {
        self.rows(node)
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        self.base.retract(point, step, moved);
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        let count =
            self.base
                .write_state_values(link.node, (link.point, self.drift(link.point)), out);
        out.inequality[count..].fill(0.0);
        let fixed = self.base.equalities(link.node);
        let parts = self.fixed_parts(link.node);
        let parts = parts.map(|(at, value)| link.point[1 + at] - value);
        let shared = self.allocation_rows(link.node);
        let residuals = parts.chain(shared.map(|row| row.residual(link.point)));
        for (out, residual) in out.equality[fixed..].iter_mut().zip(residuals) {
            *out = residual;
        }
        out.cost = 0.0;
        if link.has_interval() {
            let base = self.base_link(link);
            let gap = self.base.attitude_gap(&base.link(link, self.shape.wheels));
            out.gap[..3].copy_from_slice(gap.as_slice());
            let middle = &mut out.inequality[self.middle_rows_at(link.node)..];
            let base = base.link(link, self.shape.wheels);
            for (out, margin) in middle.iter_mut().zip(self.base.middle_margins(&base)) {
                *out = margin;
            }
            for (gap, next) in out.gap[3..].iter_mut().zip(&link.next[4..]) {
                *gap = -next;
            }
            out.cost += self.penalty_of(link);
            if self.length(link) <= 0.0 && self.divides_by_length() {
                out.cost = f64::NAN;
            }
        }
        let states = self.shape.states();
        let variable = |at: usize| match at.checked_sub(states) {
            Some(control) => link.control[control],
            None => link.point[1 + at],
        };
        let mut add = |place, value: f64| match place {
            TermTarget::Cost => out.cost += value,
            TermTarget::Gap(row) => out.gap[row] += value,
            TermTarget::Inequality(row) => out.inequality[row] += value,
        };
        self.terms(link, |term| add(term.place, term.jet.value));
        self.linear_terms(link.node, |place, at, c| {
            add(place, c * at.map_or(1.0, variable));
        });
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        self.add_state(link, duals, out);
        let states = self.shape.states();
        let fixed = self.base.equalities(link.node);
        let mut rows = out.equality_jacobian[fixed * states..].chunks_exact_mut(states);
        for ((at, _), row) in self.fixed_parts(link.node).zip(&mut rows) {
            row[at] = 1.0;
        }
        for (shared, row) in self.allocation_rows(link.node).zip(&mut rows) {
            row[shared.at..shared.at + shared.coefficients.len()]
                .copy_from_slice(&shared.coefficients);
        }
        if link.has_interval() {
            let mut base = LinkModel::for_node(&self.base, link.node);
            let inner = self.base_link(link);
            let inner = inner.link(link, self.shape.wheels);
            let z = &duals.inequality[self.middle_rows_at(link.node)..];
            self.base
                .write_attitude_link(&inner, &duals.gap[..3], (0, z), &mut base);
            self.pull_back(&base, &duals.gap[..3], z, link, out);
            if let Some(at) = self
                .shape
                .length_variable()
                .filter(|_| self.draws_lengths())
            {
                out.gradient[at] += self.penalty.weight * self.stray(link);
                out.hessian[at * out.vars + at] += self.penalty.weight;
            }
        }
        self.terms(link, |term| self.add_term(term, duals, out));
        self.linear_terms(link.node, |place, at, c| {
            if let Some(at) = at {
                place_in(place, duals, out).0[at] += c;
            }
        });
    }
}
