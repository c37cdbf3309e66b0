//! Tables of leg times in the forms that programs read, written row by row.

mod parquet_form;

use crate::documents::leg_rows::LegAnswerDocument;
use parquet_form::ParquetRows;
use std::io::{self, Write};

/// A form of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumString, clap::ValueEnum)]
#[strum(serialize_all = "lowercase")]
pub(crate) enum TableForm {
    /// One object with all rows.
    Json,
    /// An object a line.
    Ndjson,
    /// Comma-separated values, with names in the first line.
    Csv,
    /// Apache Parquet.
    Parquet,
}

impl TableForm {
    /// The media type.
    pub(crate) const fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Ndjson => "application/x-ndjson",
            Self::Csv => "text/csv",
            Self::Parquet => "application/vnd.apache.parquet",
        }
    }
}

/// What a table is a table of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TableHead<'a> {
    /// `rest_to_rest`, `lower_bound` or `certified`.
    pub(crate) kind: &'static str,
    /// SHA-256 of the canonical text of the spacecraft; in JSON always.
    pub(crate) spacecraft_key: Option<&'a str>,
    /// Whether legs lie between named places, not between positions of a query.
    pub(crate) named: bool,
}

/// Writes a table. Rows are given in parts; what is written must be finished.
pub(crate) enum TableWriter<W: Write + Send> {
    /// The output, and what stands before the next row.
    Json(W, &'static [u8]),
    /// Lines of JSON.
    Ndjson(W),
    /// Comma-separated values.
    Csv(Box<csv::Writer<W>>),
    /// Apache Parquet.
    Parquet(Box<ParquetRows<W>>),
}

impl<W: Write + Send> TableWriter<W> {
    /// Begins a table.
    ///
    /// # Errors
    ///
    /// Those of the output.
    pub(crate) fn begin(form: TableForm, head: TableHead<'_>, mut output: W) -> io::Result<Self> {
        Ok(match form {
            TableForm::Json => {
                // Neither has characters that need escaping.
                let (kind, key) = (head.kind, head.spacecraft_key.unwrap_or(""));
                write!(
                    output,
                    r#"{{"kind":"{kind}","spacecraft_key":"{key}","legs":["#
                )?;
                Self::Json(output, b"")
            }
            TableForm::Ndjson => Self::Ndjson(output),
            TableForm::Csv => {
                let mut writer = csv::Writer::from_writer(output);
                writer.write_record(COLUMNS)?;
                Self::Csv(Box::new(writer))
            }
            TableForm::Parquet => Self::Parquet(Box::new(ParquetRows::begin(head, output)?)),
        })
    }

    /// Writes rows.
    ///
    /// # Errors
    ///
    /// Those of the output, and numbers that are not finite.
    pub(crate) fn rows(&mut self, rows: &[LegAnswerDocument]) -> io::Result<()> {
        match self {
            Self::Json(output, before) => {
                for row in rows {
                    output.write_all(before)?;
                    serde_json::to_writer(&mut *output, row)?;
                    *before = b",";
                }
            }
            Self::Ndjson(output) => {
                for row in rows {
                    serde_json::to_writer(&mut *output, row)?;
                    output.write_all(b"\n")?;
                }
            }
            Self::Csv(writer) => {
                for row in rows {
                    writer.write_record(cells(row))?;
                }
            }
            Self::Parquet(writer) => writer.rows(rows)?,
        }
        Ok(())
    }

    /// Ends the table, and returns its output.
    ///
    /// # Errors
    ///
    /// Those of the output.
    pub(crate) fn finish(self) -> io::Result<W> {
        match self {
            Self::Json(mut output, _) => {
                output.write_all(b"]}")?;
                Ok(output)
            }
            Self::Ndjson(output) => Ok(output),
            Self::Csv(writer) => writer.into_inner().map_err(csv::IntoInnerError::into_error),
            Self::Parquet(writer) => writer.finish(),
        }
    }
}

/// The columns of a table, in all forms.
const COLUMNS: [&str; 7] = [
    "from",
    "to",
    "duration_s",
    "certified_lower_bound_s",
    "status",
    "source",
    "key",
];

/// A row as text. What is not known is empty.
fn cells(row: &LegAnswerDocument) -> [String; 7] {
    let number = |number: Option<crate::documents::number::Number>| {
        // The shortest text that is read as the same number.
        number.map_or_else(String::new, |number| format!("{:?}", number.0))
    };
    [
        row.from.to_string(),
        row.to.to_string(),
        number(row.duration_s),
        number(row.certified_lower_bound_s),
        row.status.clone().unwrap_or_default(),
        <&str>::from(row.source).to_owned(),
        row.key.clone().unwrap_or_default(),
    ]
}

#[cfg(test)]
mod tests;
