//! A table of targets, as spreadsheets and catalogues write it: one line for each target.
//!
//! Problems have a line and a column in place of a JSON pointer.

mod cell;
mod columns;

pub(crate) use columns::AttitudeColumns;

use super::document::{Member, Node};
use super::reader::{Cursor, Sink};
use cell::cell_problem;
use columns::{Column, Columns};
use csv::{ReaderBuilder, StringRecord, Trim};
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

/// A line of the table.
struct Row<'a> {
    columns: &'a Columns,
    line: u64,
    record: &'a StringRecord,
}

impl Row<'_> {
    /// The target of the line; null stands for what cannot be read.
    fn target(&self, boresight: [f64; 3], problems: &mut Vec<Problem>) -> Node {
        if self.record.len() != self.columns.count() {
            let (found, columns) = (self.record.len(), self.columns.count());
            let message = format!("expected {columns} cells as in the first line, found {found}");
            let hint = "look for a separator too many or too few, or in a text without quotes";
            problems.push(cell_problem(
                self.line,
                None,
                Code::WrongLength,
                message,
                hint,
            ));
            return Node::Null;
        }
        let id = self.cell(Column::Id).unwrap_or_default();
        if id.is_empty() {
            problems.push(self.problem(
                Column::Id,
                Code::MissingField,
                "there is no name",
                "name every target",
            ));
        }
        let mut members = vec![
            member("id", Node::Text(id.into())),
            self.orientation(boresight, problems),
        ];
        for (column, name) in [(Column::Dwell, "dwell_s"), (Column::Settle, "settle_s")] {
            // An empty cell is the default.
            if self.is_filled(column) {
                members.push(member(name, self.number(column, problems)));
            }
        }
        Node::Object(members.into())
    }

    /// The attitude, or a pointed boresight where the sky is given without a roll.
    fn orientation(&self, boresight: [f64; 3], problems: &mut Vec<Problem>) -> Member {
        let on_sky = self.columns.attitude == AttitudeColumns::RaDecRoll;
        self.check_limits(on_sky, problems);
        if on_sky && !self.is_filled(Column::Roll) {
            member("pointing", self.pointing(boresight, problems))
        } else {
            member("attitude", self.attitude(boresight, problems))
        }
    }

    /// Refuses limits of a roll that is given.
    fn check_limits(&self, on_sky: bool, problems: &mut Vec<Problem>) {
        for column in [Column::RollMin, Column::RollMax] {
            if self.is_filled(column) && (!on_sky || self.is_filled(Column::Roll)) {
                let message = "the roll is given, so it has no limits";
                let hint = "give ra and dec with roll, or with roll_min and roll_max";
                problems.push(self.problem(column, Code::ConflictingFields, message, hint));
            }
        }
    }

    fn pointing(&self, boresight: [f64; 3], problems: &mut Vec<Problem>) -> Node {
        let sky = [Column::RightAscension, Column::Declination];
        let sky = sky.map(|column| self.number(column, problems));
        let mut members = vec![
            member("boresight", Node::List(boresight.map(Node::Number).into())),
            member("ra_dec_deg", Node::List(sky.into())),
        ];
        let limits = [
            (Column::RollMin, "roll_min_deg"),
            (Column::RollMax, "roll_max_deg"),
        ];
        for (column, name) in limits {
            if self.is_filled(column) {
                members.push(member(name, self.number(column, problems)));
            }
        }
        Node::Object(members.into())
    }

    fn attitude(&self, boresight: [f64; 3], problems: &mut Vec<Problem>) -> Node {
        let mut number = |column| self.number(column, problems);
        let members = match self.columns.attitude {
            AttitudeColumns::RaDecRoll => {
                let angles = [Column::RightAscension, Column::Declination, Column::Roll];
                vec![
                    member("ra_dec_roll_deg", Node::List(angles.map(number).into())),
                    member("boresight", Node::List(boresight.map(Node::Number).into())),
                ]
            }
            AttitudeColumns::RollPitchYaw => {
                let angles = [Column::Roll, Column::Pitch, Column::Yaw].map(number);
                vec![member("roll_pitch_yaw_deg", Node::List(angles.into()))]
            }
            AttitudeColumns::Quaternion => {
                let parts = [
                    ("x", Column::X),
                    ("y", Column::Y),
                    ("z", Column::Z),
                    ("w", Column::W),
                ];
                let parts = parts.map(|(name, column)| member(name, number(column)));
                vec![member("quaternion", Node::Object(parts.into()))]
            }
        };
        Node::Object(members.into())
    }

    fn is_filled(&self, column: Column) -> bool {
        self.cell(column).is_some_and(|cell| !cell.is_empty())
    }

    fn cell(&self, column: Column) -> Option<&str> {
        let (index, _) = self.columns.place(column)?;
        self.record.get(index)
    }

    fn number(&self, column: Column, problems: &mut Vec<Problem>) -> Node {
        let cell = self.cell(column).unwrap_or_default();
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => return Node::Number(value),
            _ if cell.is_empty() => {
                let hint = "write a number, or remove the line";
                problems.push(self.problem(column, Code::MissingField, "the cell is empty", hint));
            }
            _ => {
                let message = format!(
                    "expected a number, found {}",
                    Node::Text(cell.into()).description()
                );
                problems.push(self.problem(column, Code::WrongType, message, number_hint(cell)));
            }
        }
        Node::Null
    }

    fn problem(
        &self,
        column: Column,
        code: Code,
        message: impl Into<String>,
        hint: &str,
    ) -> Problem {
        cell_problem(self.line, self.columns.place(column), code, message, hint)
    }
}

fn number_hint(cell: &str) -> &'static str {
    let has_digits = cell.contains(|c: char| c.is_ascii_digit());
    if has_digits && cell.contains([':', '°', 'h']) {
        "write angles in degrees as one number; hours, minutes and seconds are not converted"
    } else if cell.contains(',') {
        "write the number with a decimal point and without separators of thousands"
    } else {
        "write a finite number without its unit: angles in degrees, times in seconds"
    }
}

fn member(name: &str, value: Node) -> Member {
    (name.into(), value)
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
        problems.retain(|problem| problem.pointer.starts_with("/targets"));
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
