//! Random scenarios with windows, values, rules and rates of every kind against enumeration over subsets
//! and orders.
//!
//! ```sh
//! cargo run --release -p slewplan-tests --example clock_oracle -- [rest|any] FIRST_SEED COUNT
//! ```

use slewplan_solver::model::plan::{Optimality, Outcome};
use slewplan_tests::solving::outcome_of;
use slewplan_tests::windows::{Rates, best_by_enumeration, random_windows, standing};
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: u64| -> u64 {
        let given = arguments.get(at).and_then(|text| text.parse().ok());
        given.unwrap_or(default)
    };
    let rates = match arguments.first().map(String::as_str) {
        Some("rest") => Rates::Rest,
        _ => Rates::Any,
    };
    let (first, count) = (number(1, 0), number(2, 60));
    let mut agreed = 0;
    for seed in first..first + count {
        let targets = 4 + usize::try_from(seed % 4).unwrap_or(0);
        let spec = random_windows(seed, targets, rates);
        let begin = Instant::now();
        let outcome = outcome_of(&spec);
        let searched_s = begin.elapsed().as_secs_f64();
        let expected = best_by_enumeration(&spec, rates);
        let (found, proved) = match &outcome {
            Outcome::Planned(plan) => {
                (Some(standing(plan)), plan.optimality == Optimality::Optimal)
            }
            Outcome::Infeasible(_) => (None, true),
            Outcome::Failed(_) | Outcome::StoppedEmpty => (None, false),
        };
        let same = match (found, expected) {
            (Some((value, time_s)), Some((best, best_s))) => {
                (value - best).abs() < 1e-9 && (time_s - best_s).abs() <= 1e-6 * best_s
            }
            (found, expected) => found.is_none() == expected.is_none(),
        };
        agreed += u64::from(same && proved);
        println!(
            "{} seed {seed}, {targets} targets: {found:?} in {searched_s:.2} s, proved {proved}; \
             enumeration {expected:?} after {:.2} s",
            if same { "same" } else { "DIFFERENT" },
            begin.elapsed().as_secs_f64(),
        );
    }
    println!("{agreed} of {count} the same, with proof");
}
