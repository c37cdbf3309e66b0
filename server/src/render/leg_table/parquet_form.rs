//! Tables of leg times as Apache Parquet.

use super::{COLUMNS, TableHead};
use crate::documents::leg_rows::{LegAnswerDocument, LegEnd};
use parquet::basic::{Compression, GzipLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::io::{self, Write};
use std::sync::Arc;

/// What the two columns of ends are.
const POSITIONS: &str = "required int32 from; required int32 to;";
const NAMES: &str = "required binary from (utf8); required binary to (utf8);";
/// All other columns.
const COLUMNS_OF_TIMES: &str = "
    optional double duration_s;
    optional double certified_lower_bound_s;
    optional binary status (utf8);
    required binary source (utf8);
    optional binary key (utf8);";
/// Rows of a row group; fewer are kept until there are so many.
const GROUP: usize = 1 << 16;

/// Writes rows in groups.
pub(crate) struct ParquetRows<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    waiting: Columns,
}

/// Rows that are not written yet, by column.
#[derive(Default)]
struct Columns {
    ends: [EndColumn; 2],
    numbers: [Optional<f64>; 2],
    source: Vec<ByteArray>,
    texts: [Optional<ByteArray>; 2],
}

/// A column of begins or ends, of which one is filled.
#[derive(Default)]
struct EndColumn {
    positions: Vec<i32>,
    names: Vec<ByteArray>,
}

impl EndColumn {
    fn push(&mut self, end: &LegEnd) {
        match end {
            // Tables end at a million legs.
            LegEnd::Position(at) => self.positions.push(i32::try_from(*at).unwrap_or(i32::MAX)),
            LegEnd::Name(name) => self.names.push(name.as_str().into()),
        }
    }

    fn write(&self, column: &mut Column<'_>) -> Result<usize, ParquetError> {
        if self.names.is_empty() {
            let column = column.typed::<Int32Type>();
            return column.write_batch(&self.positions, None, None);
        }
        let column = column.typed::<ByteArrayType>();
        column.write_batch(&self.names, None, None)
    }
}

/// The values of an optional column, and which of its rows have one.
#[derive(Default)]
struct Optional<T> {
    values: Vec<T>,
    defined: Vec<i16>,
}

impl<T> Optional<T> {
    fn push(&mut self, value: Option<T>) {
        self.defined.push(i16::from(value.is_some()));
        self.values.extend(value);
    }
}

impl<W: Write + Send> ParquetRows<W> {
    pub(super) fn begin(head: TableHead<'_>, output: W) -> io::Result<Self> {
        let said = [
            ("kind", Some(head.kind)),
            ("spacecraft_key", head.spacecraft_key),
        ];
        let said = said
            .into_iter()
            .filter_map(|(name, text)| Some((name, text?)));
        let said = said.map(|(name, text)| KeyValue::new(name.to_owned(), text.to_owned()));
        let properties = WriterProperties::builder()
            .set_compression(Compression::GZIP(GzipLevel::try_new(1).map_err(failed)?))
            .set_created_by(concat!("slewplan ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_key_value_metadata(Some(said.collect()))
            .build();
        let ends = if head.named { NAMES } else { POSITIONS };
        let schema = format!("message leg_times {{ {ends} {COLUMNS_OF_TIMES} }}");
        let schema = Arc::new(parse_message_type(&schema).map_err(failed)?);
        let writer = SerializedFileWriter::new(output, schema, Arc::new(properties));
        Ok(Self {
            writer: writer.map_err(failed)?,
            waiting: Columns::default(),
        })
    }

    pub(super) fn rows(&mut self, rows: &[LegAnswerDocument]) -> io::Result<()> {
        for row in rows {
            self.waiting.push(row);
            if self.waiting.source.len() >= GROUP {
                self.write_group()?;
            }
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<W> {
        if !self.waiting.source.is_empty() {
            self.write_group()?;
        }
        self.writer.into_inner().map_err(failed)
    }

    fn write_group(&mut self) -> io::Result<()> {
        let columns = std::mem::take(&mut self.waiting);
        let mut group = self.writer.next_row_group().map_err(failed)?;
        columns.write(&mut group).map_err(failed)?;
        group.close().map_err(failed)?;
        Ok(())
    }
}

impl Columns {
    fn push(&mut self, row: &LegAnswerDocument) {
        for (column, end) in self.ends.iter_mut().zip([&row.from, &row.to]) {
            column.push(end);
        }
        let numbers = [row.duration_s, row.certified_lower_bound_s];
        for (column, number) in self.numbers.iter_mut().zip(numbers) {
            column.push(number.map(|number| number.0));
        }
        self.source.push(<&str>::from(row.source).into());
        for (column, text) in self.texts.iter_mut().zip([&row.status, &row.key]) {
            column.push(text.as_deref().map(ByteArray::from));
        }
    }

    fn write<W: Write + Send>(
        &self,
        group: &mut SerializedRowGroupWriter<'_, W>,
    ) -> Result<(), ParquetError> {
        for name in COLUMNS {
            let Some(mut column) = group.next_column()? else {
                return Err(ParquetError::General(format!("no column {name}")));
            };
            match name {
                "from" => self.ends[0].write(&mut column)?,
                "to" => self.ends[1].write(&mut column)?,
                "duration_s" => self.numbers[0].write_numbers(&mut column)?,
                "certified_lower_bound_s" => self.numbers[1].write_numbers(&mut column)?,
                "status" => self.texts[0].write_texts(&mut column)?,
                "source" => {
                    column
                        .typed::<ByteArrayType>()
                        .write_batch(&self.source, None, None)?
                }
                _ => self.texts[1].write_texts(&mut column)?,
            };
            column.close()?;
        }
        Ok(())
    }
}

type Column<'a> = parquet::file::writer::SerializedColumnWriter<'a>;

impl Optional<f64> {
    fn write_numbers(&self, column: &mut Column<'_>) -> Result<usize, ParquetError> {
        let column = column.typed::<DoubleType>();
        column.write_batch(&self.values, Some(&self.defined), None)
    }
}

impl Optional<ByteArray> {
    fn write_texts(&self, column: &mut Column<'_>) -> Result<usize, ParquetError> {
        let column = column.typed::<ByteArrayType>();
        column.write_batch(&self.values, Some(&self.defined), None)
    }
}

fn failed(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(source) => io::Error::other(source),
        },
        error => io::Error::other(error),
    }
}
