//! A line of a table as a target.

use super::cell::cell_problem;
use super::columns::{AttitudeColumns, Column, Columns};
use super::windows;
use crate::documents::document::{Member, Node};
use csv::StringRecord;
use slewplan_solver::model::problem::{Code, Problem};

/// A line of the table.
pub(super) struct Row<'a> {
    pub(super) columns: &'a Columns,
    pub(super) line: u64,
    pub(super) record: &'a StringRecord,
}

impl Row<'_> {
    /// The target of the line; null stands for what cannot be read.
    pub(super) fn target(&self, boresight: [f64; 3], problems: &mut Vec<Problem>) -> Node {
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
        let numbers = [
            (Column::Dwell, "dwell_s"),
            (Column::Settle, "settle_s"),
            (Column::Value, "value"),
        ];
        for (column, name) in numbers {
            // An empty cell is the default.
            if self.is_filled(column) {
                members.push(member(name, self.number(column, problems)));
            }
        }
        if self.is_filled(Column::Windows) {
            members.push(member("windows", self.windows(problems)));
        }
        Node::Object(members.into())
    }

    fn windows(&self, problems: &mut Vec<Problem>) -> Node {
        let cell = self.cell(Column::Windows).unwrap_or_default();
        windows::read(cell).unwrap_or_else(|| {
            let found = Node::Text(cell.into()).description();
            let message = format!("expected windows, found {found}");
            problems.push(self.problem(Column::Windows, Code::WrongType, message, windows::HINT));
            Node::Null
        })
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
