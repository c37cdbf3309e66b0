//! Random trials of the proved bounds, and of their second proof: rotations at twenty ratios of
//! rates, motions that no bound may exceed, the laws that least times obey, certificates true and
//! damaged. Prints what was found; fails if anything was not as it has to be.
//!
//! The full size (10,000 rotations, 100,000 motions, 1,000 certificates) is divided by the argument.

use nalgebra::{UnitQuaternion, Vector3};
use slewplan_solver::bounds::certify::{self, Rejection};
use slewplan_solver::bounds::kinematic::RateBox;
use slewplan_solver::bounds::kinematic::certificate::Certificate;
use slewplan_solver::bounds::kinematic::limits::{EndRates, SlewLimits};
use slewplan_solver::bounds::kinematic::ramps::SlewBound;
use slewplan_solver::model::attitude::Attitude;
use slewplan_tests::motions::{MotionKind, end_of, motion};
use slewplan_tests::random::Generator;
use std::f64::consts::PI;
use std::process::ExitCode;
use std::time::Instant;

/// Ratios of rates: the published spacecraft, equal, nearly equal and extreme ones; random ones
/// complete them to twenty.
const RATIOS: [[f64; 3]; 13] = [
    [0.018_098_04, 0.013_482_02, 0.012_460_02],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, 0.5],
    [1.0, 0.5, 0.5],
    [0.3, 1.0, 1.0],
    [1.0, 1.0 - 1e-9, 1.0 + 1e-9],
    [1.0, 1.0 - 1e-7, 1.0 + 2e-7],
    [1.0, 1.0 - 1e-5, 0.7],
    [0.999, 1.0, 1.001],
    [1.0, 0.8, 0.6],
    [1.0, 0.5, 0.25],
    [10.0, 2.0, 1.0],
    [1.0, 10.0, 2.0],
];
/// Accuracy that is asked for.
const TOLERANCE: f64 = 1e-4;

fn main() -> ExitCode {
    let divisor = std::env::args()
        .nth(1)
        .map_or(1, |text| text.parse().expect("a whole number"));
    let count = |full: usize| full.div_ceil(divisor);
    let mut generator = Generator::new(20);
    let mut ratios: Vec<Vector3<f64>> = RATIOS.map(Vector3::from).into();
    ratios
        .extend((0..7).map(|_| Vector3::from([(); 3].map(|()| generator.logarithmic(0.15, 1.0)))));
    let tables: Vec<_> = ratios
        .into_iter()
        .map(|rates| (rates, RateBox::new(rates).expect("ordinary rates")))
        .collect();
    let faults = rotations(&tables, &mut generator, count(500))
        + motions(&tables, &mut generator, count(1000))
        + laws(&tables, &mut generator, count(100))
        + certificates(&mut generator, count(1000), count(100));
    println!("faults: {faults}");
    ExitCode::from(u8::from(faults > 0))
}

/// A turn: most from everywhere, some small, some near a body axis.
fn turn(generator: &mut Generator) -> Attitude {
    let size = generator.logarithmic(PI / 180.0, PI);
    let vector = match generator.below(5) {
        0 => Vector3::from(generator.direction()) * size,
        1 => {
            let mut axis = Vector3::ith(generator.below(3), 1.0);
            axis += Vector3::from(generator.direction()) * generator.logarithmic(1e-6, 1e-1);
            axis.normalize() * size
        }
        _ => return Attitude::from_xyzw(generator.quaternion()).expect("unit length"),
    };
    Attitude::from_rotation_vector(vector)
}

fn attitude(q: UnitQuaternion<f64>) -> Attitude {
    Attitude::from_xyzw(q.coords.into()).expect("unit length")
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// How many of the answers leave more open than was asked for.
fn rotations(tables: &[(Vector3<f64>, RateBox)], generator: &mut Generator, count: usize) -> usize {
    let (mut all, mut wide, mut worst) = (Vec::new(), 0, 0.0);
    for (rates, table) in tables {
        let (mut times, mut widest) = (Vec::new(), 0.0);
        for _ in 0..count {
            let turn = turn(generator);
            let started = Instant::now();
            let lower = table.lower_bound(&turn, TOLERANCE);
            times.push(started.elapsed().as_secs_f64() * 1e3);
            let answer = table.query(&turn, TOLERANCE);
            let gap = 1.0 - lower.min(answer.lower_s) / answer.upper_s;
            wide += usize::from(gap > TOLERANCE);
            widest = f64::max(widest, gap);
        }
        let most = times.iter().copied().fold(0.0, f64::max);
        all.extend_from_slice(&times);
        println!(
            "rates {:?}: gap at most {widest:.2e}, median {:.4} ms, at most {most:.2} ms",
            rates.as_slice(),
            median(&mut times),
        );
        worst = f64::max(worst, widest);
    }
    println!(
        "{} rotations: gap at most {worst:.2e}, {wide} above {TOLERANCE}; median {:.4} ms",
        all.len(),
        median(&mut all),
    );
    wide
}

/// How many motions are faster than their bound, or extremals than the shortest motion found.
fn motions(tables: &[(Vector3<f64>, RateBox)], generator: &mut Generator, count: usize) -> usize {
    let mut faults = 0;
    for kind in MotionKind::ALL {
        let (mut closest, mut ratio, mut tried) = (f64::INFINITY, f64::INFINITY, 0);
        for (rates, table) in tables {
            for _ in 0..count {
                let arcs = motion(generator, kind, *rates, 4.5);
                let time: f64 = arcs.iter().map(|arc| arc.1).sum();
                let answer = table.query(&attitude(end_of(&arcs)), TOLERANCE);
                closest = closest.min(time / answer.lower_s);
                ratio = ratio.min(time / answer.upper_s);
                faults += usize::from(time < answer.lower_s * (1.0 - 1e-12));
                let room = 1.0 - TOLERANCE - 1e-6 / (time * rates.min());
                faults += usize::from(kind.is_extremal() && time < answer.upper_s * room);
                tried += 1;
            }
        }
        println!(
            "{tried} motions of kind {kind:?}: time over lower bound at least {closest:.9}, over the \
             shortest motion found {ratio:.9}"
        );
    }
    faults
}

/// How often a law of least times is broken.
fn laws(tables: &[(Vector3<f64>, RateBox)], generator: &mut Generator, count: usize) -> usize {
    let (mut broken, mut tried) = ([0; 3], 0);
    for (rates, table) in tables {
        for _ in 0..count {
            let (one, two) = (turn(generator), turn(generator));
            let answers = [one, two, one.then_in_body(&two)].map(|t| table.query(&t, 1e-6));
            let [x, y, z, w] = one.xyzw();
            for image in [
                [-x, -y, -z, w],
                [x, -y, -z, w],
                [-x, y, -z, w],
                [-x, -y, z, -w],
            ] {
                let image = Attitude::from_xyzw(image).expect("unit length");
                let same = table.query(&image, 1e-6);
                let apart = same.lower_s > answers[0].upper_s || answers[0].lower_s > same.upper_s;
                broken[0] += usize::from(apart);
            }
            let detour = answers[0].upper_s + answers[1].upper_s;
            broken[1] += usize::from(answers[2].lower_s > detour);
            let mut larger = *rates;
            larger[generator.below(3)] *= generator.between(1.0, 1.5);
            // A table is dear: one in ten.
            if tried % 10 == 0 {
                let faster = RateBox::new(larger)
                    .expect("ordinary rates")
                    .query(&one, 1e-6);
                broken[2] += usize::from(faster.lower_s > answers[0].upper_s);
            }
            tried += 1;
        }
    }
    println!("{tried} pairs: symmetry, triangle inequality, monotonicity broken {broken:?} times");
    broken.iter().sum()
}

/// A certificate of a slew or a short tour of a random spacecraft.
fn certificate(generator: &mut Generator) -> Certificate {
    let rates = match generator.below(4) {
        0 => Vector3::from(RATIOS[generator.below(RATIOS.len())]),
        _ => Vector3::from([(); 3].map(|()| generator.logarithmic(0.15, 1.0))),
    };
    let ramp = generator.logarithmic(0.01, 2.0) / rates.max();
    let ramps = if generator.coin() {
        Vector3::repeat(ramp)
    } else {
        Vector3::from([(); 3].map(|()| ramp * generator.logarithmic(0.4, 2.5)))
    };
    let limits = SlewLimits {
        rates_rad_s: rates,
        accelerations_rad_s2: rates.component_div(&ramps),
    };
    let end = |generator: &mut Generator| match generator.below(4) {
        0 => Vector3::new(f64::INFINITY, f64::INFINITY, 0.0),
        1 => rates.component_mul(&Vector3::from(generator.vector(0.0, 1.0))),
        _ => Vector3::zeros(),
    };
    let ends = EndRates {
        begin_rad_s: end(generator),
        end_rad_s: end(generator),
    };
    let turns: Vec<_> = (0..[1, 1, 1, 2, 3][generator.below(5)])
        .map(|_| turn(generator))
        .collect();
    let bound = SlewBound::new(limits, ends).expect("ordinary limits");
    bound.certificate(&turns, TOLERANCE)
}

/// How many certificates were not confirmed, or confirmed though damaged.
fn certificates(generator: &mut Generator, good: usize, bad: usize) -> usize {
    let (mut faults, mut times) = (0, Vec::new());
    for _ in 0..good {
        let certificate = certificate(generator);
        let started = Instant::now();
        let answer = certify::verify(&certificate);
        times.push(started.elapsed().as_secs_f64() * 1e3);
        if let Err(rejection) = answer {
            println!("not confirmed: {rejection}: {certificate:?}");
            faults += 1;
        }
    }
    let most = times.iter().copied().fold(0.0, f64::max);
    println!(
        "{} certificates: {faults} not confirmed; median {:.2} ms, at most {most:.1} ms",
        times.len(),
        median(&mut times),
    );
    let mut reasons = [0; 4];
    for number in 0..bad {
        let mut damaged = certificate(generator);
        damage(&mut damaged, number % 5);
        let reason = match certify::verify(&damaged) {
            Ok(()) => {
                println!("confirmed though damaged, {}: {damaged:?}", number % 5);
                faults += 1;
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
        "{bad} damaged: {faster} refuted by a faster motion, {link} by the link, {other} not proved, \
         {confirmed} confirmed"
    );
    faults
}

/// Makes a claim too large by a thousandth or so, in one of five ways.
fn damage(certificate: &mut Certificate, way: usize) {
    match way {
        // The duration.
        0 => certificate.duration_s *= 1.001,
        // A turn's least time, and with it what it bounds.
        1 => certificate.turns[0].least_s *= 1.001,
        // The turn: a smaller one about the same axis.
        2 => {
            let claimed = &mut certificate.turns[0];
            let vector = Attitude::identity()
                .nearest_sign(&claimed.turn)
                .signed_turn_to(&claimed.turn);
            claimed.turn = Attitude::from_rotation_vector(vector * 0.9);
        }
        // Rates and accelerations.
        3 => {
            certificate.limits.rates_rad_s *= 1.001;
            certificate.limits.accelerations_rad_s2 *= 1.001;
        }
        // The box.
        _ => certificate.box_rad_s *= 1.001,
    }
}
