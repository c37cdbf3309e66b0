//! Paths around cones, tested by sampling with the model's own geometry.

mod hard;
mod parts;
mod random;

use super::*;

/// A cone with its half angle in degrees.
fn cone(boresight: Vector3<f64>, direction: Vector3<f64>, half_angle_deg: f64) -> ForbiddenCone {
    ForbiddenCone {
        axis: boresight.normalize(),
        direction: direction.normalize(),
        half_angle: half_angle_deg.to_radians(),
    }
}

/// The complement of a cone that a boresight has to stay in.
fn keep_in(boresight: Vector3<f64>, direction: Vector3<f64>, half_angle_deg: f64) -> ForbiddenCone {
    cone(boresight, -direction, 180.0 - half_angle_deg)
}

/// Clearance of an attitude by the model's geometry, rad.
fn clearance(cones: &[ForbiddenCone], attitude: &Attitude) -> f64 {
    let clearances = cones.iter().map(|cone| -cone.depth(attitude));
    clearances.fold(PI, f64::min)
}

/// Least clearance along the arc between two attitudes at so many samples, rad.
fn sampled(cones: &[ForbiddenCone], from: &Attitude, to: &Attitude, samples: u32) -> f64 {
    let turn = from.signed_turn_to(to);
    let at = |i| from.retract(turn * (f64::from(i) / f64::from(samples)));
    (0..=samples)
        .map(|i| clearance(cones, &at(i)))
        .fold(PI, f64::min)
}

/// A problem whose last attitude may have either sign.
fn problem(cones: &[ForbiddenCone], from: Attitude, to: Attitude) -> PathProblem<'_> {
    PathProblem {
        cones,
        from,
        to,
        signed: false,
    }
}

/// Solves a problem, tests the path from outside, and returns its attitudes and length, rad.
fn path(problem: &PathProblem<'_>) -> (Vec<Attitude>, f64) {
    let search = find(problem);
    let PathOutcome::Found(attitudes) = search.outcome else {
        panic!("{:?}", search.outcome);
    };
    let turn = keeps_clear(problem, &attitudes);
    (attitudes, turn)
}

/// Tests a path from outside, and returns its length, rad.
fn keeps_clear(problem: &PathProblem<'_>, attitudes: &[Attitude]) -> f64 {
    let (first, last) = (attitudes[0], attitudes[attitudes.len() - 1]);
    assert!(first.signed_turn_to(&problem.from).norm() < 1e-9);
    let to = if problem.signed {
        problem.to
    } else {
        problem.to.nearest_sign(&last)
    };
    assert!(last.signed_turn_to(&to).norm() < 1e-9);
    let mut sum = 0.0;
    for ends in attitudes.windows(2) {
        let step = ends[0].signed_turn_to(&ends[1]).norm();
        assert!(step <= 3_f64.to_radians() + 1e-9, "{step}");
        sum += step;
        let least = sampled(problem.cones, &ends[0], &ends[1], 30);
        assert!(least >= -1.001e-6, "{least}");
    }
    sum
}

/// The turn about an axis, deg.
fn about(axis: Vector3<f64>, angle_deg: f64) -> Attitude {
    Attitude::from_rotation_vector(axis.normalize() * angle_deg.to_radians())
}

/// The attitude whose boresight, the body's x axis, points to a longitude and latitude, deg.
fn toward(longitude: f64, latitude: f64) -> Attitude {
    about(Vector3::z(), longitude).then_in_body(&about(Vector3::y(), -latitude))
}

/// A direction by longitude and latitude, deg.
fn direction(longitude: f64, latitude: f64) -> Vector3<f64> {
    toward(longitude, latitude).to_reference(Vector3::x())
}
