//! Boresights inside keep-out cones, along the whole flight.

use super::dynamics::{QuaternionComponents, to_reference};
use super::extremum::{critical_points, root};
use super::integrator::IntegrationStep;
use super::number_format::figure;
use crate::model::cone::Cone;
use crate::model::plan::Intrusion;
use crate::model::problem::{Code, Problem};

/// Depth, rad, up to which a boresight inside a cone is no violation: the attitude tolerance.
const TOUCH: f64 = super::ATTITUDE_TOLERANCE;

/// Greatest number of time spans that a message lists.
const MAX_SPANS: usize = 5;

/// Observer of one cone.
#[derive(Debug)]
pub(super) struct ConeObserver<'a> {
    index: usize,
    cone: &'a Cone,
    /// Smallest angle between boresight and cone so far, rad.
    pub(super) clearance: f64,
    inside: Option<Intrusion>,
    last_s: f64,
    pub(super) intrusions: Vec<Intrusion>,
}

impl<'a> ConeObserver<'a> {
    /// An observer that has seen the attitude at time zero.
    pub(super) fn new(index: usize, cone: &'a Cone, start: &QuaternionComponents) -> Self {
        let mut observer = Self {
            index,
            cone,
            clearance: f64::INFINITY,
            inside: None,
            last_s: 0.0,
            intrusions: Vec::new(),
        };
        let clearance = observer.clearance_at(start);
        observer.note(clearance, 0.0, 0.0);
        observer
    }

    pub(super) fn observe(&mut self, step: &IntegrationStep<'_>) {
        let cone = self.cone;
        // Derivative of the cosine of the angle between boresight and the cone's axis.
        let slope = |s: f64| {
            let turn = step.motion.rate(s).cross(&cone.axis);
            to_reference(&step.motion.quaternion(s), &turn).dot(&cone.direction)
        };
        let mut previous: Option<(f64, f64)> = None;
        critical_points(step.grid, slope, |s| {
            let here = self.clearance_at(&step.motion.quaternion(s));
            let crossing = match previous {
                Some(before) if before.1 * here < 0.0 => root(before, (s, here), |s| {
                    self.clearance_at(&step.motion.quaternion(s))
                }),
                _ => s,
            };
            self.note(here, step.begin_s + s, step.begin_s + crossing);
            previous = Some((s, here));
        });
    }

    /// Records the clearance at a time, and the time at which the surface was crossed before it.
    fn note(&mut self, clearance: f64, time_s: f64, crossing_s: f64) {
        self.clearance = self.clearance.min(clearance);
        self.last_s = time_s;
        if clearance < 0.0 {
            let intrusion = self.inside.get_or_insert(Intrusion {
                keep_out: self.index,
                from_s: crossing_s,
                to_s: time_s,
                depth_rad: 0.0,
            });
            intrusion.depth_rad = intrusion.depth_rad.max(-clearance);
        } else {
            self.leave(crossing_s);
        }
    }

    fn leave(&mut self, time_s: f64) {
        if let Some(mut intrusion) = self.inside.take()
            && intrusion.depth_rad > TOUCH
        {
            intrusion.to_s = time_s;
            self.intrusions.push(intrusion);
        }
    }

    /// Ends the observation; a warning when the boresight was inside the cone.
    pub(super) fn finish(&mut self) -> Option<Problem> {
        self.leave(self.last_s);
        if self.intrusions.is_empty() {
            return None;
        }
        let depth = self
            .intrusions
            .iter()
            .fold(0.0_f64, |d, i| d.max(i.depth_rad));
        let mut spans: Vec<String> = self.intrusions.iter().take(MAX_SPANS).map(span).collect();
        if self.intrusions.len() > MAX_SPANS {
            spans.push(format!("{} more times", self.intrusions.len() - MAX_SPANS));
        }
        Some(Problem::new(
            format!("/keep_out/{}", self.index),
            Code::KeepOutViolated,
            format!(
                "boresight '{}' is inside the cone of {} degrees by up to {} degrees: {}",
                self.cone.boresight,
                figure(self.cone.half_angle.to_degrees()),
                figure(depth.to_degrees()),
                spans.join(", ")
            ),
            "the planner reports cones but does not steer around them: change the targets next to \
             the violation, or put a target between them that leads around the cone",
        ))
    }

    fn clearance_at(&self, q: &QuaternionComponents) -> f64 {
        let boresight = to_reference(q, &self.cone.axis);
        let sine = boresight.cross(&self.cone.direction).norm();
        sine.atan2(boresight.dot(&self.cone.direction)) - self.cone.half_angle
    }
}

fn span(intrusion: &Intrusion) -> String {
    format!(
        "{} s to {} s",
        figure(intrusion.from_s),
        figure(intrusion.to_s)
    )
}
