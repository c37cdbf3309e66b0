//! `slewplan legs`: the table of leg times, whole, as a shard, or merged from shards.

use super::answer::AnswerOptions;
use super::database::LegDatabaseOption;
use super::failure::Failure;
use super::remembered::CommandLegCache;
use super::shard::ShardArgument;
use super::solve::{Threads, start_pool};
use super::{Exit, input, output};
use crate::cli::progress::{self, ProgressMode};
use crate::cli::signals::{self, Received};
use crate::documents;
use crate::documents::document::Node;
use crate::documents::leg_rows::LegAnswerDocument;
use crate::documents::legs::{LegTable, LegTableDocument};
use crate::render::leg_table::{TableForm, TableHead, TableWriter};
use crate::render::report;
use clap::ValueEnum;
use recorder::Recorder;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, LegStore, NoStore};
use slewplan_solver::tour::planner::{self, Run};
use std::path::PathBuf;

mod merge;
mod recorder;

/// Arguments of `legs`.
#[derive(Debug, clap::Args)]
pub(super) struct LegsArguments {
    /// The scenario, - for standard input
    #[arg(required_unless_present = "merge")]
    scenario: Option<PathBuf>,
    /// Merge the files of all shards of a table
    #[arg(long, value_name = "FILE", num_args = 1..,
        conflicts_with_all = ["scenario", "kind", "shard", "trajectories", "database", "threads"])]
    merge: Vec<PathBuf>,
    /// The conditions at the two ends of a leg
    #[arg(long, value_enum, default_value_t = TableKind::RestToRest)]
    kind: TableKind,
    /// Solve only shard I of N, counted from 1; all shards together are the whole table; with
    /// indexed/N, in a pod of a Kubernetes Indexed Job, the shard of that pod
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: ShardArgument,
    /// Write the motions and the scenario too, so that the file can be imported
    #[arg(long)]
    trajectories: bool,
    /// Write the rows in this form; only json can be merged and imported
    #[arg(long, value_enum, default_value_t = TableForm::Json, conflicts_with = "trajectories")]
    format: TableForm,
    #[command(flatten)]
    database: LegDatabaseOption,
    #[command(flatten)]
    answer: AnswerOptions,
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum TableKind {
    /// All rates zero at both ends
    #[value(name = "rest_to_rest")]
    RestToRest,
    /// Each end with its own conditions only, everything else free
    #[value(name = "lower_bound")]
    LowerBound,
    /// All rates zero at both ends: proved bounds of the times, without solving any slew
    #[value(name = "certified")]
    Certified,
}

impl From<TableKind> for LegKind {
    fn from(kind: TableKind) -> Self {
        match kind {
            TableKind::RestToRest => Self::RestToRest,
            TableKind::LowerBound => Self::LowerBound,
            TableKind::Certified => Self::Certified,
        }
    }
}

/// Solves the legs, or merges shards, and writes the table.
pub(super) fn run(arguments: &LegsArguments) -> Result<Exit, Failure> {
    let answer = arguments.answer.open()?;
    let table = match &arguments.scenario {
        None => merge::table(&arguments.merge)?,
        Some(path) => {
            let node = input::document(path)?;
            let read = documents::scenario::read_node(&node, None);
            let scenario = read.map_err(|problems| Failure::Invalid {
                name: input::name(path),
                problems,
            })?;
            let scenario = scenario.scenario;
            let obstacles = planner::feasibility_problems(&scenario);
            if !obstacles.is_empty() {
                for obstacle in &obstacles {
                    output::complain(&report::problem(obstacle, &scenario));
                }
                return Ok(Exit::Negative);
            }
            let (table, received) = solve(arguments, node, &scenario)?;
            let nothing = table.rows.is_empty() && !table.complete;
            if let (true, Some(code)) = (nothing, received.exit_code()) {
                return Ok(Exit::Signalled(code));
            }
            table
        }
    };
    answer.write_content(
        || written(&table, arguments.format),
        || report::legs(&table),
    )?;
    Ok(exit(&table))
}

/// The table in a form.
fn written(table: &LegTable, form: TableForm) -> Result<Vec<u8>, Failure> {
    let unspeakable = |error: &dyn std::fmt::Display| Failure::Unspeakable(error.to_string());
    if form == TableForm::Json {
        let document = LegTableDocument::new(table).map_err(|error| unspeakable(&error))?;
        return Ok(output::json(&document)?.into());
    }
    let head = TableHead {
        kind: table.kind.into(),
        spacecraft_key: None,
        named: true,
    };
    let rows: Vec<_> = table.rows.iter().map(LegAnswerDocument::from).collect();
    let written = TableWriter::begin(form, head, Vec::new()).and_then(|mut writer| {
        writer.rows(&rows)?;
        writer.finish()
    });
    written.map_err(|error| unspeakable(&error))
}

fn solve(
    arguments: &LegsArguments,
    node: Node,
    scenario: &Scenario,
) -> Result<(LegTable, Received), Failure> {
    let (kind, shard) = (arguments.kind.into(), arguments.shard.resolve()?);
    if arguments.trajectories && kind == LegKind::Certified {
        return Err(Failure::Setting {
            name: "--trajectories",
            what: "bounds are proved without any motion".into(),
        });
    }
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let observer = progress::observer(arguments.progress, scenario.options().time_limit_s);
    let database = arguments.database.database.as_ref();
    let remembered = database.map(CommandLegCache::open).transpose()?;
    let legs = remembered.as_ref();
    let legs = legs.map_or(&NoStore as &dyn LegStore, CommandLegCache::legs);
    let recorder = arguments.trajectories.then(|| Recorder::new(legs));
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: recorder.as_ref().map_or(legs, |recorder| recorder),
        segments: &NoStore,
    };
    let (rows, complete) = planner::leg_table(scenario, kind, shard, run);
    let table = LegTable {
        version: env!("CARGO_PKG_VERSION").into(),
        kind,
        scenario_key: documents::legs::scenario_key(&node),
        shard,
        complete,
        scenario: arguments.trajectories.then_some(node),
        rows,
        motions: recorder.map(Recorder::into_motions),
    };
    Ok((table, received))
}

fn exit(table: &LegTable) -> Exit {
    if !table.complete {
        return Exit::Stopped;
    }
    // A leg without a proved bound is a complete answer.
    if table.kind == LegKind::Certified {
        return Exit::Complete;
    }
    let rows = table.rows.iter();
    let unsolved = rows.filter(|row| row.duration_s.is_none()).count();
    if unsolved == 0 {
        return Exit::Complete;
    }
    output::complain(&format!(
        "{unsolved} of {} legs could not be solved",
        table.rows.len()
    ));
    Exit::Failed
}
