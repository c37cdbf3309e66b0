use super::*;
use crate::attitude::Attitude;
use crate::scenario::{RateCondition, Scenario};
use crate::spec::{AttitudeEquivalence, AttitudeSpec};
use crate::transcription::WheelCondition;

const RPY: [[f64; 3]; 19] = [
    [0.0, 0.0, 0.0],
    [15.0, 0.0, 10.0], [25.0, 0.0, 50.0], [15.0, 0.0, 130.0], [25.0, 0.0, 170.0], [15.0, 0.0, 250.0], [25.0, 0.0, 290.0],
    [40.0, 0.0, 10.0], [50.0, 0.0, 50.0], [40.0, 0.0, 130.0], [50.0, 0.0, 170.0], [40.0, 0.0, 250.0], [50.0, 0.0, 290.0],
    [85.0, 0.0, 10.0], [95.0, 0.0, 50.0], [85.0, 0.0, 130.0], [95.0, 0.0, 170.0], [85.0, 0.0, 250.0], [95.0, 0.0, 290.0],
];

fn at_rest(rpy: [f64; 3]) -> Waypoint {
    let spec = AttitudeSpec::RollPitchYawDeg(rpy);
    let attitude = Attitude::try_new(&spec, AttitudeEquivalence::Rotation, "").expect("valid").0;
    Waypoint { attitude, rate: [RateCondition::Fixed(0.0); 3], wheels: WheelCondition::Free }
}

#[test]
fn explore() {
    let scenario = Scenario::try_new(&crate::scenario::reference::experiment_a()).expect("valid").scenario;
    let dynamics = Dynamics::of(&scenario);
    let null = DVector::zeros(0);
    let mut sums = [0.0; 4];
    let mut wins = [0; 4];
    let mut its = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
    let begin = std::time::Instant::now();
    let names: Vec<char> = "0abcdefghijklmnopqr".chars().collect();
    for i in 0..19 {
        for j in i + 1..19 {
            let (from, to) = (at_rest(RPY[i]), at_rest(RPY[j]));
            let mut results = Vec::new();
            for (g, guess) in guesses(&dynamics, &from, &to, Arrival::Rotation, &null).iter().enumerate() {
                let mut signed = to.clone();
                signed.attitude = to.attitude.nearest_sign(guess.attitudes.last().unwrap());
                let flown = fly(&dynamics, &[from.clone(), signed], &[INTERVALS], guess, &|| false);
                its[g].push(flown.iterations);
                results.push((flown.duration().unwrap_or(f64::NAN), flown.status, flown.iterations, guess.duration()));
            }
            let best = results.iter().map(|r| r.0).fold(f64::INFINITY, f64::min);
            let win = results.iter().position(|r| r.0 <= best * 1.0001).unwrap_or(3);
            wins[win] += 1;
            sums[3] += best;
            for (s, r) in sums.iter_mut().zip(&results) { *s += r.0; }
            if win > 0 || results.iter().any(|r| r.0.is_nan()) {
                println!("{}-{} {best:.4} {results:.3?}", names[i], names[j]);
            }
        }
    }
    for list in &mut its { list.sort_unstable(); }
    println!("sums {sums:?} wins {wins:?} time {:?}", begin.elapsed());
    for list in &its { if !list.is_empty() { println!("median {} p90 {} max {}", list[list.len()/2], list[list.len()*9/10], list[list.len()-1]); } }
}
