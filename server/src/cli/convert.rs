//! `slewplan convert`: makes targets of a table.

use super::failure::Failure;
use super::output::{self, Destination};
use super::{Exit, input};
use crate::documents::document::{Member, Node};
use crate::documents::reader::{Cursor, Sink};
use crate::documents::scenario;
use crate::documents::target_table::{self, AttitudeColumns, TableReading, TargetTable};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::spec::BoresightSpec;
use std::path::PathBuf;

/// Arguments of `convert`.
#[derive(Debug, clap::Args)]
pub(super) struct ConvertArguments {
    /// The table as CSV, - for standard input: a line of column names, then one line for each target
    table: PathBuf,
    /// Print this scenario with the targets in place of its own
    #[arg(long, value_name = "SCENARIO")]
    into: Option<PathBuf>,
    /// The axis that right ascension and declination point: a boresight of the scenario, x, y, z, -x,
    /// -y or -z [default: the only boresight of the scenario, or z]
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    boresight: Option<String>,
    /// Leave a column out; repeatable
    #[arg(long, value_name = "COLUMN")]
    ignore: Vec<String>,
    /// Write to this file
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Writes the list of the targets, or the scenario with them, if a scenario can have them.
pub(super) fn run(arguments: &ConvertArguments) -> Result<Exit, Failure> {
    let mut inputs = vec![arguments.table.as_path()];
    inputs.extend(arguments.into.as_deref());
    input::one_stream_at_most(&inputs)?;
    let destination = Destination::open(&arguments.output)?;
    let scenario = arguments.into.as_deref().map(input::document).transpose()?;
    let axis = axis(arguments.boresight.as_deref(), scenario.as_ref())?;
    let reading = TableReading {
        boresight: axis,
        ignored: &arguments.ignore,
    };
    let invalid = |problems| Failure::Invalid {
        name: input::name(&arguments.table),
        problems,
    };
    let table = target_table::read(&input::read(&arguments.table)?, &reading).map_err(invalid)?;
    let document = if let Some(scenario) = scenario {
        filled(arguments, scenario, &table)?
    } else {
        let problems = table.problems();
        if !problems.is_empty() {
            return Err(invalid(problems));
        }
        table.list()
    };
    destination.write(&output::json(&document)?)?;
    let is_assumed = arguments.boresight.is_none() && arguments.into.is_none();
    if is_assumed && table.attitude() == AttitudeColumns::RaDecRoll {
        output::complain("ra and dec point body z; --boresight names another axis");
    }
    Ok(Exit::Complete)
}

/// The scenario with the targets of the table.
fn filled(
    arguments: &ConvertArguments,
    mut scenario: Node,
    table: &TargetTable,
) -> Result<Node, Failure> {
    match scenario.member_mut("targets") {
        Some(targets) => *targets = table.list(),
        None => scenario = with_member(scenario, ("targets".into(), table.list())),
    }
    let Err(faults) = scenario::examine(&scenario, None) else {
        return Ok(scenario);
    };
    let (table_name, scenario_name) = (&arguments.table, arguments.into.as_ref());
    let named = |problem: Problem| {
        let located = table.located(problem.clone());
        let file = if located == problem {
            scenario_name
        } else {
            Some(table_name)
        };
        (file.map(|path| input::name(path)), located)
    };
    let mut problems: Vec<_> = faults.problems.into_iter().map(named).collect();
    // Those of one file stand together.
    problems.sort_by(|(one, _), (other, _)| one.cmp(other));
    Err(Failure::Misfits { problems })
}

fn with_member(document: Node, member: Member) -> Node {
    match document {
        Node::Object(members) => {
            let mut members = members.into_vec();
            members.push(member);
            Node::Object(members.into())
        }
        // Refused as what it is.
        other => other,
    }
}

/// The body axis that is pointed.
fn axis(named: Option<&str>, scenario: Option<&Node>) -> Result<[f64; 3], Failure> {
    let boresights = scenario.map(boresights).unwrap_or_default();
    let wrong = |what: String| Failure::Setting {
        name: "--boresight",
        what,
    };
    let names = || {
        let names: Vec<&str> = boresights.iter().map(|it| it.name.as_str()).collect();
        names.join(", ")
    };
    let Some(named) = named else {
        return match &boresights[..] {
            [] => Ok([0.0, 0.0, 1.0]),
            [only] => Ok(only.axis),
            _ => Err(wrong(format!(
                "the scenario has several boresights; name one of {}",
                names()
            ))),
        };
    };
    if let Some(found) = boresights.iter().find(|boresight| boresight.name == named) {
        return Ok(found.axis);
    }
    body_axis(named).ok_or_else(|| {
        let known = if boresights.is_empty() {
            String::new()
        } else {
            names() + ", "
        };
        wrong(format!("{named:?} is none of {known}x, y, z, -x, -y, -z"))
    })
}

fn body_axis(name: &str) -> Option<[f64; 3]> {
    let (length, name) = match name.strip_prefix('-') {
        Some(name) => (-1.0, name),
        None => (1.0, name),
    };
    let index = ["x", "y", "z"].iter().position(|axis| *axis == name)?;
    let mut axis = [0.0; 3];
    axis[index] = length;
    Some(axis)
}

/// The boresights of a scenario, as far as they can be read: it is examined with its targets.
fn boresights(scenario: &Node) -> Vec<BoresightSpec> {
    let listed = scenario
        .member("spacecraft")
        .and_then(|it| it.member("boresights"));
    let sink = Sink::default();
    let read = listed.and_then(|list| Vec::<BoresightSpec>::read(&Cursor::root(list, &sink)));
    read.unwrap_or_default()
}
