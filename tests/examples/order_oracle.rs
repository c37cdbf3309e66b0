//! Ninety random scenarios of four to seven targets: is the order that the search proves optimal the
//! best of all orders, each flown by the program of the whole tour? Takes some minutes.
//!
//! Rate conditions of every kind and mixed, with and without stored momentum, an end, a dwell and
//! signed quaternions; thirty are ordinary spacecraft, with rate limits and momentum, half of them with
//! only the z rate vanishing at targets. Ends with a panic at the first that is not. With a number,
//! starts at that seed: those with six targets each fly 720 orders, which takes many minutes.

use slewplan_tests::orders::{
    Case, assert_search_finds_the_best_of, assert_search_finds_the_best_order,
};
use slewplan_tests::ordinary;
use std::time::Instant;

/// How many scenarios have so many targets.
const SIZES: [(usize, usize); 4] = [(4, 24), (5, 20), (6, 12), (7, 4)];

/// The same of ordinary spacecraft, the largest wheel of which is so many times as large as the smallest.
const ORDINARY: [(usize, usize); 3] = [(4, 14), (5, 12), (6, 4)];
const SPREAD: f64 = 3.0;

/// A mixture, and each kind alone.
const RATE_KINDS: [Option<usize>; 5] = [None, Some(0), Some(1), Some(2), Some(3)];

fn main() {
    let first: u64 = std::env::args()
        .nth(1)
        .map_or(0, |seed| seed.parse().expect("a seed"));
    let mut seed = 100;
    for (targets, count) in SIZES {
        for number in 0..count {
            seed += 1;
            if seed < first {
                continue;
            }
            let case = Case {
                seed,
                targets,
                rate_kind: RATE_KINDS[number % RATE_KINDS.len()],
                momentum: number % 4 == 1,
                end: number % 3 > 0,
                dwell: number % 10 == 0,
                signed: number % 7 == 3,
            };
            let begin = Instant::now();
            assert_search_finds_the_best_order(&case);
            println!("{case:?}: the same, {:.1} s", begin.elapsed().as_secs_f64());
        }
    }
    for (targets, count) in ORDINARY {
        for number in 0..count {
            seed += 1;
            if seed < first {
                continue;
            }
            let mut spec = ordinary::scenario(seed, targets, SPREAD);
            for target in &mut spec.targets {
                target.zero_rate_axes = (number % 2 == 0).then_some([false, false, true]);
                (target.rate_min_rad_s, target.rate_max_rad_s) = (None, None);
            }
            let (begin, name) = (Instant::now(), spec.name.clone().unwrap_or_default());
            assert_search_finds_the_best_of(&spec, &name);
            println!("{name}: the same, {:.1} s", begin.elapsed().as_secs_f64());
        }
    }
}
