//! Sixty random scenarios of four to seven targets: is the order that the search proves optimal the
//! best of all orders, each flown by the program of the whole tour? Takes some minutes.
//!
//! Rate conditions of every kind and mixed, with and without stored momentum, an end, a dwell and
//! signed quaternions. Ends with a panic at the first that is not.

use slewplan_tests::orders::{Case, assert_search_finds_the_best_order};
use std::time::Instant;

/// How many scenarios have so many targets.
const SIZES: [(usize, usize); 4] = [(4, 24), (5, 20), (6, 12), (7, 4)];

/// A mixture, and each kind alone.
const RATE_KINDS: [Option<usize>; 5] = [None, Some(0), Some(1), Some(2), Some(3)];

fn main() {
    let mut seed = 100;
    for (targets, count) in SIZES {
        for number in 0..count {
            seed += 1;
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
}
