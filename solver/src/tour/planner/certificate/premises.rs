//! The premises of a certificate, compared with the scenario.
//!
//! A certificate says that no motion within some limits and with some end rates makes a turn in
//! less than a time. Whether the slews of the scenario are within these limits is checked here from
//! the scenario alone, by formulas other than those of [`crate::bounds::certified`]: largest
//! components from the corners of boxes, inertias by solving linear systems, turns as products of
//! matrices. What the checker tolerates has to be within them too.

mod momentum;

use crate::bounds::kinematic::certificate::{Certificate, CertifiedTurn};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::polytope::certificate::{FacetPremise, FramePremise, NormCertificate};
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::tolerances::{ATTITUDE_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE};
use crate::tour::order::Place;
pub(super) use momentum::check_drift;
use nalgebra::{Matrix3, Vector3};

/// Tolerance for rounding of a limit, relative.
const ROUNDING: f64 = 1e-12;
/// Tolerance for the components of the matrices of two equal turns; attitudes are rounded to a
/// tenth of a picoradian.
const SAME_TURN: f64 = 1e-9;
/// Tolerance for the products of orthonormal axes.
const ORTHONORMAL: f64 = 1e-12;

/// Checks the premises of a certificate, expressed in axes that are the columns of a matrix, for
/// slews between two places without momentum.
///
/// # Errors
///
/// The first premise that the scenario does not support.
pub(super) fn check(
    scenario: &Scenario,
    places: [Place; 2],
    axes: &Matrix3<f64>,
    certificate: &Certificate,
) -> Result<(), &'static str> {
    let slews = Slews::of(scenario, places).ok_or(NO_INVERSE)?;
    check_axes(axes)?;
    let [turn] = &certificate.turns[..] else {
        return Err("more or less than one turn");
    };
    slews.check_turn(axes, turn, certificate.attitude_tolerance_rad)?;
    slews.check_limits(axes, &certificate.limits, &certificate.ends)
}

/// Checks the premises of a certificate of a bound by a norm for slews between two places without momentum.
///
/// # Errors
///
/// The first premise that the scenario does not support.
pub(super) fn check_norm(
    scenario: &Scenario,
    places: [Place; 2],
    certificate: &NormCertificate,
) -> Result<(), &'static str> {
    let slews = Slews::of(scenario, places).ok_or(NO_INVERSE)?;
    slews.check_turn(
        &Matrix3::identity(),
        &certificate.turn,
        certificate.attitude_tolerance_rad,
    )?;
    for facet in &certificate.facets {
        slews.check_facet(facet)?;
    }
    let Some(FramePremise { axes, limits, ends }) = &certificate.frame else {
        return Ok(());
    };
    check_axes(axes)?;
    slews.check_limits(axes, limits, ends)
}

/// Torques, wheel speeds and body rates, relative to their limits, that the checker admits.
const EXCEEDED: f64 = 1.0 + LIMIT_TOLERANCE;
const RATES: &str = "a limit of the rates below what the wheels can do";
const ACCELERATIONS: &str = "a limit of the accelerations below what the wheels can do";
/// Why nothing can be said of a spacecraft.
const NO_INVERSE: &str = "an inertia that cannot be inverted";

/// All slews between two places.
struct Slews<'a> {
    scenario: &'a Scenario,
    /// Body axes at the two ends in the reference frame, as columns.
    attitudes: [Matrix3<f64>; 2],
    /// Ranges of the rate components there, rad/s, with the tolerance.
    ranges: [[(f64, f64); 3]; 2],
    /// Inverses of the inertia of the spacecraft and of that without its wheels about their axes.
    inverses: [Matrix3<f64>; 2],
    /// Momentum of locked wheels, N m s.
    locked: Vector3<f64>,
}

impl<'a> Slews<'a> {
    fn of(scenario: &'a Scenario, places: [Place; 2]) -> Option<Self> {
        let [begin, end] = places.map(|place| conditions(scenario, place));
        let spacecraft = scenario.spacecraft();
        let speeds = &scenario.start().wheel_speed;
        let mut effective = *spacecraft.inertia();
        let mut locked = Vector3::zeros();
        for (wheel, speed) in spacecraft.wheels().iter().zip(speeds) {
            if wheel.enabled {
                effective -= wheel.axis * wheel.axis.transpose() * wheel.inertia;
            } else {
                locked += wheel.axis * (wheel.inertia * speed);
            }
        }
        let inverse = |inertia: &Matrix3<f64>| inertia.lu().solve(&Matrix3::identity());
        Some(Self {
            scenario,
            attitudes: [begin.0, end.0],
            ranges: [begin.1, end.1],
            inverses: [inverse(spacecraft.inertia())?, inverse(&effective)?],
            locked,
        })
    }

    /// Checks a turn that is expressed in some axes.
    fn check_turn(
        &self,
        axes: &Matrix3<f64>,
        turn: &CertifiedTurn,
        attitude_tolerance_rad: f64,
    ) -> Result<(), &'static str> {
        if (self.turn(axes) - turn.turn.matrix()).amax() > SAME_TURN {
            return Err("another turn");
        }
        check_missed(attitude_tolerance_rad)
    }

    /// The turn from begin to end in some axes.
    fn turn(&self, axes: &Matrix3<f64>) -> Matrix3<f64> {
        let [from, to] = &self.attitudes;
        axes.tr_mul(&(from.tr_mul(to) * axes))
    }

    fn check_limits(
        &self,
        axes: &Matrix3<f64>,
        limits: &SlewLimits,
        ends: &EndRates,
    ) -> Result<(), &'static str> {
        for (axis, direction) in axes.column_iter().enumerate() {
            self.check_direction(
                &direction.into_owned(),
                limits.rates_rad_s[axis],
                limits.accelerations_rad_s2[axis],
                [ends.begin_rad_s[axis], ends.end_rad_s[axis]],
            )?;
        }
        Ok(())
    }

    fn check_facet(&self, facet: &FacetPremise) -> Result<(), &'static str> {
        let FacetPremise { normal, share } = facet;
        self.check_direction(normal, share.most, share.slope, share.ends)
    }

    /// Checks limits of the component along a direction, of any length.
    fn check_direction(
        &self,
        direction: &Vector3<f64>,
        rate: f64,
        acceleration: f64,
        ends: [f64; 2],
    ) -> Result<(), &'static str> {
        if !within(self.largest_rate(direction) * EXCEEDED, rate) {
            return Err(RATES);
        }
        if !within(
            self.largest_acceleration(direction) * EXCEEDED,
            acceleration,
        ) {
            return Err(ACCELERATIONS);
        }
        self.check_ends(direction, [0.0; 2], ends)
    }

    /// Checks limits of the component at the ends, relative to something that changes it by so much at most.
    fn check_ends(
        &self,
        direction: &Vector3<f64>,
        moved: [f64; 2],
        ends: [f64; 2],
    ) -> Result<(), &'static str> {
        let [begin, end] = self.ranges.map(|range| over_corners(direction, &range));
        if !within(begin + moved[0], ends[0]) {
            return Err("a rate at the beginning below what is admitted there");
        }
        if !within(end + moved[1], ends[1]) {
            return Err("a rate at the end below what is admitted there");
        }
        Ok(())
    }

    /// Largest component along a direction of the rates without total momentum.
    fn largest_rate(&self, direction: &Vector3<f64>) -> f64 {
        self.reached_rate(direction)
            .min(self.allowed_rate(direction))
    }

    /// That of the rates that the wheels reach, `J w = -h_locked - sum a I W`.
    fn reached_rate(&self, direction: &Vector3<f64>) -> f64 {
        let (spacecraft, options) = (self.scenario.spacecraft(), self.scenario.options());
        // The inertia is symmetric: d . J^-1 v = (J^-1 d) . v.
        let lever = self.inverses[0] * direction;
        let mut reached = lever.dot(&self.locked).abs();
        for (_, wheel) in spacecraft.enabled_wheels() {
            let share = (lever.dot(&wheel.axis) * wheel.inertia).abs();
            if share > 0.0 {
                reached += share * wheel.max_speed * options.momentum_authority;
            }
        }
        reached
    }

    /// That of the rates which are allowed.
    fn allowed_rate(&self, direction: &Vector3<f64>) -> f64 {
        let spacecraft = self.scenario.spacecraft();
        let limits = spacecraft.max_rate().map(|limit| (-limit, limit));
        let by_axis = over_corners(direction, &[limits.x, limits.y, limits.z]);
        by_axis.min(spacecraft.max_rate_norm() * direction.norm())
    }

    /// Largest component along a direction of the accelerations that the wheels reach, either way,
    /// `J_eff w' = -sum a u`.
    fn largest_acceleration(&self, direction: &Vector3<f64>) -> f64 {
        let (spacecraft, options) = (self.scenario.spacecraft(), self.scenario.options());
        let push = self.inverses[1] * direction;
        let either = [1.0, -1.0].map(|sign| -> f64 {
            let wheels = spacecraft.enabled_wheels();
            let largest = wheels.map(|(_, wheel)| {
                let share = sign * push.dot(&wheel.axis) * options.torque_authority;
                (share * wheel.max_torque).max(share * wheel.min_torque)
            });
            largest.sum()
        });
        either[0].max(either[1])
    }
}

/// Whether a limit grants what is needed, up to rounding.
fn within(needed: f64, granted: f64) -> bool {
    needed <= granted * (1.0 + ROUNDING)
}

fn check_missed(attitude_tolerance_rad: f64) -> Result<(), &'static str> {
    if attitude_tolerance_rad < ATTITUDE_TOLERANCE {
        return Err("attitudes that are met more exactly than they have to be");
    }
    Ok(())
}

fn check_axes(axes: &Matrix3<f64>) -> Result<(), &'static str> {
    let product = axes.tr_mul(axes) - Matrix3::identity();
    if product.amax() > ORTHONORMAL || axes.determinant() < 0.0 {
        return Err("axes that are not orthonormal");
    }
    Ok(())
}

/// The body axes in the reference frame, as columns, and the ranges of the rate components at a
/// place, rad/s, with the tolerance.
fn conditions(scenario: &Scenario, place: Place) -> (Matrix3<f64>, [(f64, f64); 3]) {
    let (attitude, ranges) = exact_conditions(scenario, place);
    let tolerated = |(low, high)| (low - RATE_TOLERANCE, high + RATE_TOLERANCE);
    (attitude, ranges.map(tolerated))
}

/// The same without the tolerance.
fn exact_conditions(scenario: &Scenario, place: Place) -> (Matrix3<f64>, [(f64, f64); 3]) {
    let fixed = |rate: &Vector3<f64>| [0, 1, 2].map(|axis| (rate[axis], rate[axis]));
    match place {
        Place::Start => {
            let start = scenario.start();
            (start.attitude.matrix(), fixed(&start.rate))
        }
        Place::Target(index) => {
            let target = &scenario.targets()[index];
            let range = |condition: RateCondition| match condition {
                RateCondition::Fixed(rate) => (rate, rate),
                RateCondition::Within(low, high) => (low, high),
                RateCondition::Free => (f64::NEG_INFINITY, f64::INFINITY),
            };
            (target.attitude.matrix(), target.rate.map(range))
        }
        Place::End => {
            let end = scenario
                .end()
                .expect("only scenarios with an end have legs to it");
            (end.attitude.matrix(), fixed(&end.rate))
        }
    }
}

/// Largest absolute component along a direction of the vectors in a box, over its corners.
fn over_corners(direction: &Vector3<f64>, ranges: &[(f64, f64); 3]) -> f64 {
    let corners = (0..8_u8).map(|corner| {
        let parts = (0..3).map(|axis| {
            let (low, high) = ranges[axis];
            let component = if corner >> axis & 1 == 0 { low } else { high };
            // A component orthogonal to the direction does not contribute, even if it is infinite.
            if direction[axis] == 0.0 {
                0.0
            } else {
                direction[axis] * component
            }
        });
        parts.sum::<f64>().abs()
    });
    // The sum of two infinities of different sign is not a number; it counts as infinite.
    corners.fold(0.0, |largest, size| {
        if size.is_nan() {
            f64::INFINITY
        } else {
            size.max(largest)
        }
    })
}

#[cfg(test)]
mod tests;
