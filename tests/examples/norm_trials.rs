//! Random trials of the second proof of bounds by norms: certificates true and damaged. Prints
//! what was found; fails if anything was not as it has to be.
//!
//! The full size (1,000 certificates, 200 damaged ones) is divided by the argument.

use nalgebra::Vector3;
use slewplan_solver::bounds::certify::{self, Rejection};
use slewplan_solver::bounds::kinematic::certificate::CertifiedTurn;
use slewplan_solver::bounds::polytope::RatePolytope;
use slewplan_solver::bounds::polytope::certificate::{FacetPremise, NormCertificate};
use slewplan_solver::bounds::polytope::trapezoid::Trapezoid;
use slewplan_solver::model::attitude::Attitude;
use slewplan_tests::motions::half_spaces;
use slewplan_tests::random::Generator;
use std::f64::consts::PI;
use std::process::ExitCode;
use std::time::Instant;

/// Reduction of least times that leaves the proof its margin.
const MARGIN: f64 = 5e-5;
/// Angle by which the ends of turns are missed, rad.
const MISSED: f64 = 1.001e-6;

fn main() -> ExitCode {
    let divisor = std::env::args()
        .nth(1)
        .map_or(1, |text| text.parse().expect("a whole number"));
    let mut generator = Generator::new(21);
    let faults = confirmed(&mut generator, 1000_usize.div_ceil(divisor))
        + refused(&mut generator, 200_usize.div_ceil(divisor));
    println!("faults: {faults}");
    ExitCode::from(u8::from(faults > 0))
}

/// A certificate of a slew at rest at both ends, all of whose facets have ramps of one length.
fn certificate(number: usize, generator: &mut Generator) -> NormCertificate {
    let (normals, limited) = std::iter::repeat_with(|| half_spaces(number as u64, generator))
        .find_map(|normals| Some((RatePolytope::within(&normals)?, normals)))
        .map(|(limited, normals)| (normals, limited))
        .expect("some are limited in all directions");
    let angle = generator.logarithmic(3e-2, PI);
    let turn = Attitude::from_rotation_vector(Vector3::from(generator.direction()) * angle);
    let least_s = limited.least_time(&turn, 1e-4).lower_s * (1.0 - MARGIN);
    let steepest = normals.iter().map(Vector3::norm).fold(0.0, f64::max);
    let left_s = least_s - 2.0 * MISSED * steepest * (1.0 + 1e-9);
    // s(T) = T - ramp for T of two ramps at least, which left_s of one ramp at least gives.
    let ramp_s = left_s * generator.between(0.01, 1.0);
    let share = Trapezoid {
        most: 1.0,
        slope: 1.0 / ramp_s,
        ends: [0.0; 2],
    };
    let premise = |normal: &Vector3<f64>| FacetPremise {
        normal: *normal,
        share,
    };
    NormCertificate {
        facets: normals.iter().map(premise).collect(),
        frame: None,
        turn: CertifiedTurn { turn, least_s },
        attitude_tolerance_rad: MISSED,
        duration_s: (left_s + ramp_s) * (1.0 - 1e-9),
    }
}

/// How many true certificates are not confirmed.
fn confirmed(generator: &mut Generator, count: usize) -> usize {
    let (mut faults, mut times) = (0, Vec::new());
    for number in 0..count {
        let certificate = certificate(number, generator);
        let started = Instant::now();
        let answer = certify::verify_norm(&certificate);
        times.push(started.elapsed().as_secs_f64());
        if let Err(rejection) = answer {
            println!("{number} is not confirmed: {rejection}");
            faults += 1;
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{count} certificates: {faults} not confirmed; median {:.3} s, at most {:.2} s",
        times[count / 2],
        times[count - 1]
    );
    faults
}

/// How many damaged certificates are confirmed.
fn refused(generator: &mut Generator, count: usize) -> usize {
    let mut reasons = [0; 4];
    for number in 0..count {
        let mut damaged = certificate(number, generator);
        damage(&mut damaged, number / 3 % 5);
        let reason = match certify::verify_norm(&damaged) {
            Ok(()) => {
                println!("{number} is confirmed though damaged: {damaged:?}");
                3
            }
            Err(Rejection::Faster { .. }) => 0,
            Err(Rejection::Link { .. }) => 1,
            Err(_) => 2,
        };
        reasons[reason] += 1;
    }
    let [faster, link, other, confirmed] = reasons;
    println!(
        "{count} damaged: {faster} refuted by a faster motion, {link} by the link, {other} not proved, \
         {confirmed} confirmed"
    );
    confirmed
}

/// Makes a claim too large by a thousandth or so, in one of five ways.
fn damage(certificate: &mut NormCertificate, way: usize) {
    match way {
        // The duration.
        0 => certificate.duration_s *= 1.001,
        // The least time of the turn.
        1 => certificate.turn.least_s *= 1.001,
        // The turn: a smaller one about the same axis.
        2 => {
            let turn = &mut certificate.turn.turn;
            let vector = Attitude::identity().nearest_sign(turn).signed_turn_to(turn);
            *turn = Attitude::from_rotation_vector(vector * 0.99);
        }
        // More of every rate than the link grants, but no more in the polytope.
        3 => {
            for facet in &mut certificate.facets {
                facet.share.most *= 1.001;
            }
        }
        // A larger polytope than the one whose least time is known.
        _ => {
            for facet in &mut certificate.facets {
                facet.normal /= 1.001;
            }
        }
    }
}
