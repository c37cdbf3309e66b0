//! Published orienteering problems with windows: value, bound and time of the search on tables.
//!
//! ```sh
//! cargo run --release -p slewplan-tests --example orienteering -- [LIMIT_S]
//! ```

use slewplan_solver::tour::schedule::{SearchLimits, search};
use slewplan_tests::orienteering::instances;
use std::time::{Duration, Instant};

fn main() {
    let limit = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let limit = Duration::from_secs(limit.unwrap_or(60));
    for instance in instances() {
        let (problem, distances) = instance.problem();
        let begin = Instant::now();
        let stop = || begin.elapsed() > limit;
        let (mut reached_s, mut value) = (f64::INFINITY, 0.0);
        let found = search(
            &problem,
            &distances,
            SearchLimits::default(),
            &stop,
            &mut |now| {
                let known = now.best.as_ref().map_or(0.0, |best| best.value);
                if known > value {
                    (reached_s, value) = (begin.elapsed().as_secs_f64(), known);
                }
            },
        );
        println!(
            "{:5} of {:3}: best known {:4}, found {value:4} after {reached_s:7.3} s, at most {:4}, {} after \
             {:7.3} s, {} labels",
            instance.name,
            instance.customers,
            instance.best,
            found.value_bound,
            if found.complete { "proved" } else { "open" },
            begin.elapsed().as_secs_f64(),
            found.labels,
        );
    }
}
