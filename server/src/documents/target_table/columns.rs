//! The columns of a table of targets, found by their names.

use super::cell::cell_problem;
use crate::documents::reader::known_names_hint;
use slewplan_solver::model::problem::{Code, Problem};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Id,
    RightAscension,
    Declination,
    Roll,
    RollMin,
    RollMax,
    Pitch,
    Yaw,
    X,
    Y,
    Z,
    W,
    Dwell,
    Settle,
    Windows,
    Value,
}

/// The names of every column, the usual one first.
const NAMES: [(Column, &[&str]); 16] = [
    (Column::Id, &["id", "name", "target"]),
    (
        Column::RightAscension,
        &["ra", "ra_deg", "right_ascension", "right_ascension_deg"],
    ),
    (
        Column::Declination,
        &["dec", "dec_deg", "declination", "declination_deg"],
    ),
    (Column::Roll, &["roll", "roll_deg"]),
    (Column::RollMin, &["roll_min", "roll_min_deg"]),
    (Column::RollMax, &["roll_max", "roll_max_deg"]),
    (Column::Pitch, &["pitch", "pitch_deg"]),
    (Column::Yaw, &["yaw", "yaw_deg"]),
    (Column::X, &["qx", "q_x", "x"]),
    (Column::Y, &["qy", "q_y", "y"]),
    (Column::Z, &["qz", "q_z", "z"]),
    (Column::W, &["qw", "q_w", "w"]),
    (Column::Dwell, &["dwell", "dwell_s"]),
    (Column::Settle, &["settle", "settle_s"]),
    (
        Column::Windows,
        &["windows", "windows_s", "window", "window_s"],
    ),
    (Column::Value, &["value"]),
];

/// The form of the attitudes of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AttitudeColumns {
    /// `ra`, `dec` and perhaps `roll`, or `roll_min` and `roll_max`.
    RaDecRoll,
    /// `roll`, `pitch`, `yaw`.
    RollPitchYaw,
    /// `qx`, `qy`, `qz`, `qw`.
    Quaternion,
}

const FORMS: [(AttitudeColumns, &[Column]); 3] = [
    (
        AttitudeColumns::RaDecRoll,
        &[Column::RightAscension, Column::Declination],
    ),
    (
        AttitudeColumns::RollPitchYaw,
        &[Column::Roll, Column::Pitch, Column::Yaw],
    ),
    (
        AttitudeColumns::Quaternion,
        &[Column::X, Column::Y, Column::Z, Column::W],
    ),
];
const FORM_HINT: &str = "give the attitudes in the columns ra, dec and roll, or roll, pitch and yaw, or \
                         qx, qy, qz and qw";

/// The head of a table.
#[derive(Debug)]
pub(super) struct Columns {
    names: Vec<String>,
    found: Vec<Option<Column>>,
    /// The form of the attitudes.
    pub(super) attitude: AttitudeColumns,
}

impl Columns {
    /// Reads the head. What is wrong with it is recorded; there is no head without attitudes and names.
    pub(super) fn read(
        head: &[&str],
        ignored: &[String],
        problems: &mut Vec<Problem>,
    ) -> Option<Self> {
        let names: Vec<String> = head.iter().map(|name| (*name).to_owned()).collect();
        let mut found: Vec<Option<Column>> = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let column = column_of(name);
            let place = (index, name.as_str());
            if ignored.iter().any(|other| plain(other) == plain(name)) {
                found.push(None);
                continue;
            }
            if column.is_none() {
                problems.push(unknown(place.0, place.1));
            } else if found.contains(&column) {
                let message = "this column is there twice";
                let hint = "keep one of them, or leave one out with --ignore";
                problems.push(cell_problem(
                    1,
                    Some(place),
                    Code::DuplicateField,
                    message,
                    hint,
                ));
            }
            found.push(column);
        }
        if !found.contains(&Some(Column::Id)) {
            let message = "there is no column id";
            let hint =
                "the first line names the columns; give every target a name in the column id";
            problems.push(cell_problem(1, None, Code::MissingField, message, hint));
        }
        let attitude = attitude_of(&found, problems)?;
        found.contains(&Some(Column::Id)).then_some(Self {
            names,
            found,
            attitude,
        })
    }

    /// Number of columns.
    pub(super) fn count(&self) -> usize {
        self.names.len()
    }

    /// The index of a column and its name in the head.
    pub(super) fn place(&self, column: Column) -> Option<(usize, &str)> {
        let index = self.found.iter().position(|other| *other == Some(column))?;
        Some((index, &self.names[index]))
    }
}

/// The form whose columns are there, unless it is none or several.
fn attitude_of(found: &[Option<Column>], problems: &mut Vec<Problem>) -> Option<AttitudeColumns> {
    let is_there = |column: &Column| found.contains(&Some(*column));
    // What says that a form is meant: roll alone belongs to two of them, and its limits to none.
    let is_meant = |columns: &[Column]| columns.iter().any(|c| *c != Column::Roll && is_there(c));
    let meant = FORMS.iter().filter(|(_, columns)| is_meant(columns));
    let meant: Vec<_> = meant.collect();
    let [(form, columns)] = meant[..] else {
        let message = match meant.len() {
            0 => "there are no columns of attitudes",
            _ => "there are columns of several forms of attitudes",
        };
        problems.push(cell_problem(
            1,
            None,
            Code::AttitudeForm,
            message,
            FORM_HINT,
        ));
        return None;
    };
    let missing: Vec<&str> = columns
        .iter()
        .filter(|c| !is_there(c))
        .map(|c| usual_name(*c))
        .collect();
    if missing.is_empty() {
        return Some(*form);
    }
    let message = format!(
        "columns of the attitudes are missing: {}",
        missing.join(", ")
    );
    problems.push(cell_problem(
        1,
        None,
        Code::AttitudeForm,
        message,
        FORM_HINT,
    ));
    None
}

fn unknown(index: usize, name: &str) -> Problem {
    let known: Vec<&str> = NAMES
        .iter()
        .map(|(column, _)| usual_name(*column))
        .collect();
    let hint = format!(
        "{}; --ignore {name:?} leaves the column out",
        known_names_hint(&plain(name), &known)
    );
    let place = Some((index, name));
    cell_problem(
        1,
        place,
        Code::UnknownField,
        "no target has this column",
        hint,
    )
}

pub(super) fn usual_name(column: Column) -> &'static str {
    let named = NAMES.iter().find(|(other, _)| *other == column);
    named.map_or("", |(_, names)| names[0])
}

fn column_of(name: &str) -> Option<Column> {
    let name = plain(name);
    let known = |(_, names): &&(Column, &[&str])| names.contains(&name.as_str());
    NAMES.iter().find(known).map(|(column, _)| *column)
}

/// A name of a column as it is compared: `RA [deg]` is `ra_deg`.
fn plain(name: &str) -> String {
    let parts = name.split(|c: char| !c.is_alphanumeric());
    let parts: Vec<String> = parts
        .filter(|part| !part.is_empty())
        .map(str::to_lowercase)
        .collect();
    parts.join("_")
}
