//! `slewplan legs`: the table of leg times.

use super::failure::Failure;
use super::output::{self, Destination};
use super::solve::{Threads, start_pool};
use super::{Exit, input};
use crate::progress::{self, ProgressMode};
use crate::signals;
use crate::wire::legs::LegTableDocument;
use clap::ValueEnum;
use slewplan_solver::legs::{LegKind, NoStore};
use slewplan_solver::planner::{self, LegRow, Run, Shard};
use slewplan_solver::stop::StopSignal;
use std::path::PathBuf;
use std::str::FromStr;

/// What `legs` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// The conditions at the two ends of a leg
    #[arg(long, value_enum, default_value_t = Kind::RestToRest)]
    kind: Kind,
    /// Solve only part I of N, counted from 1; the parts together are the whole table
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: ShardArgument,
    /// Write the table to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// All rates zero at both ends
    #[value(name = "rest_to_rest")]
    RestToRest,
    /// Each end with only its own conditions, the rest free
    #[value(name = "lower_bound")]
    LowerBound,
    /// All rates zero at both ends: proved bounds of the times, without solving any slew
    #[value(name = "certified")]
    Certified,
}

impl From<Kind> for LegKind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::RestToRest => Self::RestToRest,
            Kind::LowerBound => Self::LowerBound,
            Kind::Certified => Self::Certified,
        }
    }
}

/// A part of the table as written on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ShardArgument(Shard);

impl FromStr for ShardArgument {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text
            .split_once('/')
            .map(|(index, of)| (index.parse(), of.parse()));
        match parts {
            Some((Ok(index), Ok(of))) if (1..=of).contains(&index) => {
                let index: usize = index;
                Ok(Self(Shard {
                    index: index - 1,
                    of,
                }))
            }
            _ => Err("expected I/N with 1 <= I <= N, for example 2/4"),
        }
    }
}

/// Solves the legs and writes the table.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let scenario = input::scenario(&arguments.scenario, None)?.scenario;
    let obstacles = planner::feasibility_problems(&scenario);
    if !obstacles.is_empty() {
        for obstacle in &obstacles {
            output::complain(&obstacle.to_string());
        }
        return Ok(Exit::Negative);
    }
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let (kind, shard) = (arguments.kind.into(), arguments.shard.0);
    let observer = progress::observer(arguments.progress);
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: &NoStore,
        segments: &NoStore,
    };
    let (rows, complete) = planner::leg_table(&scenario, kind, shard, run);
    drop(observer);
    if let (true, Some(code)) = (rows.is_empty() && !complete, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    destination.write(&output::json(&LegTableDocument::new(
        kind, shard, &rows, complete,
    ))?)?;
    Ok(exit(kind, &rows, complete))
}

fn exit(kind: LegKind, rows: &[LegRow], complete: bool) -> Exit {
    if !complete {
        return Exit::Stopped;
    }
    // That nothing is proved of a leg is an answer.
    if kind == LegKind::Certified {
        return Exit::Complete;
    }
    let unsolved = rows.iter().filter(|row| row.duration_s.is_none()).count();
    if unsolved == 0 {
        return Exit::Complete;
    }
    output::complain(&format!(
        "{unsolved} of {} legs could not be solved",
        rows.len()
    ));
    Exit::Failed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_count_from_one() {
        assert_eq!("2/4".parse(), Ok(ShardArgument(Shard { index: 1, of: 4 })));
        for wrong in ["0/4", "5/4", "1/0", "1", "a/b", "1/2/3", "-1/2", ""] {
            assert!(wrong.parse::<ShardArgument>().is_err(), "{wrong}");
        }
    }
}
