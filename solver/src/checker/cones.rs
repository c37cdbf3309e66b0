//! Boresights on the wrong side of cones, along the whole flight or during the stays at targets.

use super::dynamics::{QuaternionComponents, to_reference};
use super::extremum::{critical_points, root};
use super::integrator::IntegrationStep;
use super::number_format::figure;
use super::visits::Visit;
use crate::model::cone::{Applies, Cone, ForbiddenCone, Side};
use crate::model::plan::{ConeClearance, Intrusion};
use crate::model::problem::{Code, Problem};

/// Depth, rad, up to which a boresight inside a cone is no violation: the attitude tolerance.
const TOUCH: f64 = super::ATTITUDE_TOLERANCE;

/// Greatest number of time spans that a message lists.
const MAX_SPANS: usize = 5;

/// Angle between the axis and the cone's surface, rad; negative inside.
fn clearance(cone: &ForbiddenCone, q: &QuaternionComponents) -> f64 {
    let boresight = to_reference(q, &cone.axis);
    let sine = boresight.cross(&cone.direction).norm();
    sine.atan2(boresight.dot(&cone.direction)) - cone.half_angle
}

/// A time span inside a cone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inside {
    from_s: f64,
    to_s: f64,
    depth_rad: f64,
}

/// Observer of one cone.
#[derive(Debug)]
pub(super) struct ConeObserver<'a> {
    cone: ForbiddenCone,
    /// When it is observed, in order of time and apart from each other; always without it.
    during: Option<&'a [[f64; 2]]>,
    /// Least angle between boresight and cone so far, rad, with its time, s.
    nearest: (f64, f64),
    inside: Option<Inside>,
    last_s: f64,
    entered: Vec<Inside>,
}

impl<'a> ConeObserver<'a> {
    /// An observer that has seen the attitude at time zero.
    pub(super) fn new(
        cone: ForbiddenCone,
        during: Option<&'a [[f64; 2]]>,
        start: &QuaternionComponents,
    ) -> Self {
        let mut observer = Self {
            cone,
            during,
            nearest: (f64::INFINITY, 0.0),
            inside: None,
            last_s: 0.0,
            entered: Vec::new(),
        };
        let first = during.map_or(Some(0.0), |spans| Some(spans.first()?[0]));
        if first.is_some_and(|first| first <= 0.0) {
            observer.note(clearance(&cone, start), 0.0, 0.0);
        }
        observer
    }

    pub(super) fn observe(&mut self, step: &IntegrationStep<'_>) {
        let Some(spans) = self.during else {
            return self.observe_at(step, step.grid);
        };
        let first = spans.partition_point(|span| span[1] < step.begin_s);
        let begun = spans[first..].iter();
        for span in begun.take_while(|span| span[0] <= step.end_s) {
            self.observe_at(step, &clipped(step, span));
            if span[1] <= step.end_s {
                self.leave(span[1]);
            }
        }
    }

    /// Observes part of a step, given by its grid.
    fn observe_at(&mut self, step: &IntegrationStep<'_>, grid: &[f64]) {
        let cone = self.cone;
        let clearance = |s: f64| clearance(&cone, &step.motion.quaternion(s));
        // Derivative of the cosine of the angle between boresight and the cone's axis.
        let slope = |s: f64| {
            let turn = step.motion.rate(s).cross(&cone.axis);
            to_reference(&step.motion.quaternion(s), &turn).dot(&cone.direction)
        };
        let mut previous: Option<(f64, f64)> = None;
        critical_points(grid, slope, |s| {
            let here = clearance(s);
            let crossing = match previous {
                Some(before) if before.1 * here < 0.0 => root(before, (s, here), clearance),
                _ => s,
            };
            self.note(here, step.begin_s + s, step.begin_s + crossing);
            previous = Some((s, here));
        });
    }

    /// Records the clearance at a time, and the time at which the surface was crossed before it.
    fn note(&mut self, clearance: f64, time_s: f64, crossing_s: f64) {
        if clearance < self.nearest.0 {
            self.nearest = (clearance, time_s);
        }
        self.last_s = time_s;
        if clearance < 0.0 {
            let inside = self.inside.get_or_insert(Inside {
                from_s: crossing_s,
                to_s: time_s,
                depth_rad: 0.0,
            });
            inside.depth_rad = inside.depth_rad.max(-clearance);
        } else {
            self.leave(crossing_s);
        }
    }

    fn leave(&mut self, time_s: f64) {
        if let Some(mut inside) = self.inside.take()
            && inside.depth_rad > TOUCH
        {
            inside.to_s = time_s;
            self.entered.push(inside);
        }
    }

    /// Ends the observation: how deep the boresight was inside and when, if it was.
    pub(super) fn finish(&mut self) -> Option<String> {
        self.leave(self.last_s);
        let depth = self.entered.iter().map(|inside| inside.depth_rad);
        let depth = depth.reduce(f64::max)?;
        let mut spans: Vec<String> = self.entered.iter().take(MAX_SPANS).map(span).collect();
        if self.entered.len() > MAX_SPANS {
            spans.push(format!("{} more times", self.entered.len() - MAX_SPANS));
        }
        let depth = figure(depth.to_degrees());
        Some(format!("by up to {depth} degrees: {}", spans.join(", ")))
    }
}

/// The grid of the part of a step that lies in a time span.
fn clipped(step: &IntegrationStep<'_>, span: &[f64; 2]) -> Vec<f64> {
    let length = step.end_s - step.begin_s;
    let [from, to] = span.map(|time| (time - step.begin_s).clamp(0.0, length));
    let inner = step.grid.iter().copied();
    let inner = inner.filter(|&s| s > from && s < to);
    let mut grid = vec![from];
    grid.extend(inner);
    grid.push(to);
    grid
}

fn span(inside: &Inside) -> String {
    format!("{} s to {} s", figure(inside.from_s), figure(inside.to_s))
}

/// The stays at targets as time spans, in order of time and apart from each other.
pub(super) fn stays(visits: &[Visit<'_>]) -> Vec<[f64; 2]> {
    let spans = visits
        .iter()
        .map(|visit| [visit.arrival_s, visit.departure_s]);
    let mut spans: Vec<[f64; 2]> = spans.collect();
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut apart: Vec<[f64; 2]> = Vec::new();
    for span in spans {
        match apart.last_mut() {
            Some(last) if span[0] <= last[1] => last[1] = last[1].max(span[1]),
            _ => apart.push(span),
        }
    }
    apart
}

/// The observers of all cones of a scenario.
#[derive(Debug)]
pub(super) struct ConeObservers<'a> {
    observed: Vec<(&'a Cone, ConeObserver<'a>)>,
}

/// What was found about the cones of a scenario.
#[derive(Debug, Default)]
pub(super) struct ConeFindings {
    /// For each cone that applied at some time.
    pub(super) clearances: Vec<ConeClearance>,
    /// In order of cone and time.
    pub(super) intrusions: Vec<Intrusion>,
    /// Sentences about enforced cones.
    pub(super) failures: Vec<String>,
    /// Warnings about cones that are only reported.
    pub(super) warnings: Vec<Problem>,
}

impl<'a> ConeObservers<'a> {
    /// `stays` are those at targets.
    pub(super) fn new(
        cones: &'a [Cone],
        stays: &'a [[f64; 2]],
        start: &QuaternionComponents,
    ) -> Self {
        let observer = |cone: &'a Cone| {
            let during = (cone.applies == Applies::AtTargets).then_some(stays);
            (cone, ConeObserver::new(cone.forbidden(), during, start))
        };
        Self {
            observed: cones.iter().map(observer).collect(),
        }
    }

    pub(super) fn observe(&mut self, step: &IntegrationStep<'_>) {
        for (_, observer) in &mut self.observed {
            observer.observe(step);
        }
    }

    pub(super) fn finish(&mut self) -> ConeFindings {
        let mut findings = ConeFindings::default();
        for (cone, observer) in &mut self.observed {
            if let Some(extent) = observer.finish() {
                let sentence = violation(cone, &extent);
                if cone.applies == Applies::Report {
                    findings.warnings.push(warning(cone, sentence));
                } else {
                    let pointer = cone.pointer();
                    findings.failures.push(format!("{pointer}: {sentence}"));
                }
            }
            findings.include(cone, observer);
        }
        findings
    }
}

impl ConeFindings {
    fn include(&mut self, cone: &Cone, observer: &ConeObserver<'_>) {
        let (clearance, time_s) = observer.nearest;
        if clearance.is_finite() {
            let nearest = ConeClearance::new(cone, clearance, time_s);
            self.clearances.push(nearest);
        }
        let intrusions = observer.entered.iter().map(|inside| Intrusion {
            boresight: cone.boresight.clone(),
            cone: cone.pointer(),
            from_s: inside.from_s,
            to_s: inside.to_s,
            depth_rad: inside.depth_rad,
        });
        self.intrusions.extend(intrusions);
    }
}

/// A sentence about a boresight on the wrong side of a cone.
fn violation(cone: &Cone, extent: &str) -> String {
    let side = match cone.side {
        Side::Out => "inside the keep-out cone",
        Side::In => "outside the keep-in cone",
    };
    let place = match cone.applies {
        Applies::AtTargets => " at targets",
        Applies::Always | Applies::Report => "",
    };
    format!(
        "boresight '{}' is {side} of {} degrees{place} {extent}",
        cone.boresight,
        figure(cone.half_angle.to_degrees())
    )
}

fn warning(cone: &Cone, sentence: String) -> Problem {
    Problem::new(
        cone.pointer(),
        Code::KeepOutViolated,
        sentence,
        "this cone is only reported, plans do not steer around it: let it apply \"always\", or \
         change the targets next to the violation",
    )
}
