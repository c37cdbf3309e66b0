//! Tabulates the minimum times of all legs between three attitudes, beside their certified bounds.

use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::progress::Silent;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, NoStore};
use slewplan_solver::tour::planner::{Run, Shard, leg_table};
use slewplan_tests::published_targets_spec;

/// The whole table in one part.
const ALL: Shard = Shard { index: 0, of: 1 };

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The published spacecraft; `plan.rs` shows how a description is written.
    let spec = published_targets_spec(&["a", "b"]);
    let validated = Scenario::try_new(&spec).map_err(|problems| format!("{problems:?}"))?;
    let scenario = validated.scenario;

    let (pool, stop) = (SolverPool::new(None)?, StopSignal::new());
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &Silent,
        legs: &NoStore,
        segments: &NoStore,
    };
    let (rows, complete) = leg_table(&scenario, LegKind::RestToRest, ALL, run);
    assert!(complete, "nothing stops this run");
    println!(
        "{:>6} {:>6} {:>9} {:>9}",
        "from", "to", "time, s", "proved, s"
    );
    for row in rows {
        let (Some(time), Some(proved)) = (row.duration_s, row.certified_lower_bound_s) else {
            return Err(format!("{} to {}: {}", row.from, row.to, row.status).into());
        };
        println!("{:>6} {:>6} {time:>9.2} {proved:>9.2}", row.from, row.to);
        assert!(proved <= time);
    }
    Ok(())
}
