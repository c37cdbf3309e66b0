//! The memory estimate beside the growth of the resident memory that was measured.

use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner::memory_estimate;
use slewplan_tests::schedules::{RateConditions, Region, schedule};

const AT_REST: RateConditions = RateConditions::AllZero;
const FREE: RateConditions = RateConditions::ZeroAboutZ;

/// How much more than with two targets at rest `slewplan solve --threads 2` took at most, MiB, within
/// a minute, on a machine with other work; the last column is 4 where the estimate is at most four
/// times that. The others are below 16 MiB, or end before they need the tables of a hard search.
const MEASURED: [(Region, RateConditions, usize, f64, f64); 18] = [
    (Region::Strip, FREE, 12, 2.4, 8.0),
    (Region::Strip, FREE, 14, 6.8, 8.0),
    (Region::Strip, FREE, 16, 23.5, 4.0),
    (Region::Sphere, FREE, 16, 12.2, 8.0),
    (Region::Sphere, AT_REST, 16, 9.3, 8.0),
    (Region::Sphere, AT_REST, 18, 37.9, 4.0),
    (Region::Strip, FREE, 18, 80.8, 4.0),
    (Region::Sphere, FREE, 18, 44.5, 4.0),
    (Region::Strip, FREE, 25, 34.0, 4.0),
    (Region::Sphere, FREE, 40, 27.1, 4.0),
    (Region::Strip, FREE, 40, 14.4, 8.0),
    (Region::Sphere, AT_REST, 40, 6.0, 8.0),
    (Region::Strip, FREE, 200, 80.0, 4.0),
    (Region::Sphere, AT_REST, 200, 23.8, 4.0),
    (Region::Sphere, FREE, 1000, 257.0, 4.0),
    (Region::Strip, FREE, 1000, 357.0, 4.0),
    (Region::Sphere, AT_REST, 1000, 75.4, 4.0),
    (Region::Sphere, AT_REST, 6, 0.6, 16.0),
];

#[test]
fn the_estimate_is_above_the_peak_and_near_it() {
    for (region, rates, targets, peak_mib, most) in MEASURED {
        let spec = schedule(region, rates, targets, 1);
        let scenario = Scenario::try_new(&spec).expect("valid").scenario;
        let mib = memory_estimate(&scenario) as f64 / f64::from(1 << 20);
        let ratio = mib / peak_mib;
        assert!(
            (1.0..=most).contains(&ratio),
            "{region:?}, {rates:?}, {targets} targets: {mib:.0} MiB, measured {peak_mib} MiB"
        );
    }
}

/// What `--max-targets` admits stays within what the documentation says of a job.
#[test]
fn many_targets_are_estimated_by_their_number() {
    let mib = |targets| {
        let spec = schedule(Region::Strip, FREE, targets, 1);
        let scenario = Scenario::try_new(&spec).expect("valid").scenario;
        memory_estimate(&scenario) >> 20
    };
    assert!(mib(200) < 160, "{} MiB", mib(200));
    assert!(mib(1000) < 640, "{} MiB", mib(1000));
}

/// A search that is stopped early keeps less.
#[test]
fn the_estimate_follows_the_time_limit() {
    let estimate = |limit_s| {
        let mut spec = schedule(Region::Strip, FREE, 30, 1);
        spec.options.time_limit_s = limit_s;
        memory_estimate(&Scenario::try_new(&spec).expect("valid").scenario)
    };
    let limits = [Some(1.0), Some(10.0), Some(60.0), None];
    let estimates = limits.map(estimate);
    assert!(estimates.is_sorted(), "{estimates:?}");
    assert!(3 * estimates[0] < estimates[2], "{estimates:?}");
}
