//! A table of targets, as spreadsheets and catalogues write it: one line for each target.
//!
//! Problems have a line and a column in place of a JSON pointer.

mod cell;
mod columns;
mod row;
mod windows;

pub(crate) use columns::AttitudeColumns;

use super::document::Node;
use super::reader::{Cursor, Sink};
use cell::cell_problem;
use columns::{Column, Columns};
use csv::{ReaderBuilder, StringRecord, Trim};
use row::Row;
use slewplan_solver::model::input::{InputForm, UpTo};
use slewplan_solver::model::problem::{Code, MAX_KEPT, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{MAX_TARGETS, ScenarioSpec, SpacecraftSpec, TargetSpec};

/// How a table is to be read.
#[derive(Debug)]
pub(crate) struct TableReading<'a> {
    /// The body axis that right ascension and declination point.
    pub(crate) boresight: [f64; 3],
    /// Names of columns that are left out.
    pub(crate) ignored: &'a [String],
}

/// The targets of a table, and where they stand in it.
#[derive(Debug)]
pub(crate) struct TargetTable {
    columns: Columns,
    lines: Vec<u64>,
    targets: Vec<Node>,
}

/// Reads a table.
///
/// # Errors
///
/// Everything that is wrong with it, by line and column.
pub(crate) fn read(bytes: &[u8], reading: &TableReading<'_>) -> Result<TargetTable, Vec<Problem>> {
    let text = text_of(bytes).map_err(|problem| vec![problem])?;
    let mut records = ReaderBuilder::new()
        .delimiter(delimiter(text))
        .trim(Trim::All)
        // A line of another length is one problem of many.
        .flexible(true)
        .has_headers(false)
        .from_reader(text.as_bytes())
        .into_records();
    let mut problems = Vec::new();
    let head = records
        .next()
        .transpose()
        .map_err(|error| vec![unreadable(&error)])?;
    let head: Vec<&str> = head.iter().flat_map(StringRecord::iter).collect();
    let Some(columns) = Columns::read(&head, reading.ignored, &mut problems) else {
        return Err(problems);
    };
    let (mut lines, mut targets) = (Vec::new(), Vec::new());
    for record in records {
        let record = record.map_err(|error| vec![unreadable(&error)])?;
        // Spreadsheets write their empty lines.
        if record.iter().all(str::is_empty) {
            continue;
        }
        let line = line_of(text, &record);
        let row = Row {
            columns: &columns,
            line,
            record: &record,
        };
        targets.push(row.target(reading.boresight, &mut problems));
        lines.push(line);
        if problems.len() >= MAX_KEPT {
            return Err(problems);
        }
    }
    if lines.is_empty() && problems.is_empty() {
        let message = "there is no target below the names of the columns";
        let hint = "write a line for each target";
        problems.push(cell_problem(1, None, Code::MissingField, message, hint));
    }
    let table = TargetTable {
        columns,
        lines,
        targets,
    };
    if problems.is_empty() {
        Ok(table)
    } else {
        Err(problems)
    }
}

fn text_of(bytes: &[u8]) -> Result<&str, Problem> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = before.split(|byte| *byte == b'\n').count() as u64;
        let message = "these are no characters of UTF-8";
        cell_problem(
            line,
            None,
            Code::WrongType,
            message,
            "save the table as CSV in UTF-8",
        )
    })
}

/// What separates the columns: the most frequent of comma, semicolon and tabulator in the head.
fn delimiter(text: &str) -> u8 {
    let head = text.lines().next().unwrap_or_default();
    let count = |delimiter: &u8| head.matches(char::from(*delimiter)).count();
    // Of several the last one is taken.
    b"\t;,".iter().copied().max_by_key(count).unwrap_or(b',')
}

fn unreadable(error: &csv::Error) -> Problem {
    let line = error.position().map_or(1, csv::Position::line);
    cell_problem(
        line,
        None,
        Code::WrongType,
        error.to_string(),
        "save the table as CSV in UTF-8",
    )
}

/// The line on which a record begins; empty lines before it do not count.
fn line_of(text: &str, record: &StringRecord) -> u64 {
    let Some(position) = record.position() else {
        return 1;
    };
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.as_bytes().get(start..).unwrap_or_default();
    let skipped = rest.iter().take_while(|byte| b"\r\n".contains(byte));
    position.line() + skipped.filter(|byte| **byte == b'\n').count() as u64
}

impl TargetTable {
    /// The form of the attitudes.
    pub(crate) fn attitude(&self) -> AttitudeColumns {
        self.columns.attitude
    }

    /// The targets as a list of a scenario.
    pub(crate) fn list(&self) -> Node {
        Node::List(self.targets.clone().into())
    }

    /// What would be wrong with the targets in any scenario.
    pub(crate) fn problems(&self) -> Vec<Problem> {
        let (list, sink) = (self.list(), Sink::default());
        let targets = UpTo::<MAX_TARGETS, TargetSpec>::read(&Cursor::at(&list, "/targets", &sink));
        let mut problems = sink.into_problems();
        let spec = ScenarioSpec {
            spacecraft: SpacecraftSpec::substitute(),
            targets: targets.unwrap_or_default(),
            ..ScenarioSpec::default()
        };
        if let Err(faults) = Scenario::examine(&spec) {
            problems.extend(faults.problems);
        }
        // Dates need the epoch of a scenario, which is for that to give.
        problems.retain(|problem| {
            problem.pointer.starts_with("/targets") && problem.code != Code::EpochRequired
        });
        problems
            .into_iter()
            .map(|problem| self.located(problem))
            .collect()
    }

    /// A problem of a scenario that has the list, by line and column where it is one of the list.
    pub(crate) fn located(&self, problem: Problem) -> Problem {
        let mut parts = problem.pointer.split('/').skip(1);
        let (list, index) = (parts.next(), parts.next().map(str::parse::<usize>));
        let (Some("targets"), Some(Ok(index))) = (list, index) else {
            return problem;
        };
        let Some(line) = self.lines.get(index) else {
            return problem;
        };
        let column = column_of(&parts.collect::<Vec<_>>());
        let place = column.and_then(|column| self.columns.place(column));
        cell_problem(*line, place, problem.code, problem.message, problem.hint)
    }
}

/// The column that a place in a target comes from, if it is one.
fn column_of(place: &[&str]) -> Option<Column> {
    let of = |columns: &[Column], index: &str| columns.get(index.parse::<usize>().ok()?).copied();
    match place {
        ["id"] => Some(Column::Id),
        ["dwell_s"] => Some(Column::Dwell),
        ["settle_s"] => Some(Column::Settle),
        ["windows", ..] => Some(Column::Windows),
        ["value"] => Some(Column::Value),
        ["attitude", "ra_dec_roll_deg", index] => of(
            &[Column::RightAscension, Column::Declination, Column::Roll],
            index,
        ),
        ["pointing", "ra_dec_deg", index] => {
            of(&[Column::RightAscension, Column::Declination], index)
        }
        ["pointing", "roll_min_deg"] => Some(Column::RollMin),
        ["pointing", "roll_max_deg"] => Some(Column::RollMax),
        ["attitude", "roll_pitch_yaw_deg", index] => {
            of(&[Column::Roll, Column::Pitch, Column::Yaw], index)
        }
        ["attitude", "quaternion", "x"] => Some(Column::X),
        ["attitude", "quaternion", "y"] => Some(Column::Y),
        ["attitude", "quaternion", "z"] => Some(Column::Z),
        ["attitude", "quaternion", "w"] => Some(Column::W),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
