//! Every form of a table is read back as it was written.

use super::*;
use crate::documents::leg_rows::{LegEnd, Source};
use crate::documents::number::Number;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::RowAccessor as _;

const HEAD: TableHead<'_> = TableHead {
    kind: "rest_to_rest",
    spacecraft_key: Some("5a"),
    named: false,
};

fn rows() -> Vec<LegAnswerDocument> {
    let row = |to: usize, duration_s: Option<f64>, source| LegAnswerDocument {
        from: LegEnd::Position(0),
        to: LegEnd::Position(to),
        duration_s: duration_s.map(Number),
        certified_lower_bound_s: None,
        status: duration_s.map(|_| "converged".to_owned()),
        source,
        key: duration_s.map(|_| "abc".to_owned()),
    };
    vec![
        row(1, Some(0.1 + 0.2), Source::Computed),
        row(2, None, Source::Missing),
        row(3, Some(1e300), Source::Cached),
    ]
}

fn written(form: TableForm) -> Vec<u8> {
    let mut writer = TableWriter::begin(form, HEAD, Vec::new()).expect("begun");
    // In two parts.
    let (first, second) = (&rows()[..1], &rows()[1..]);
    writer.rows(first).expect("written");
    writer.rows(second).expect("written");
    writer.finish().expect("finished")
}

#[test]
fn json_and_its_lines_hold_the_same_rows() {
    let json: serde_json::Value = serde_json::from_slice(&written(TableForm::Json)).expect("JSON");
    assert_eq!(
        (&json["kind"], &json["spacecraft_key"]),
        (&"rest_to_rest".into(), &"5a".into())
    );
    let lines = String::from_utf8(written(TableForm::Ndjson)).expect("text");
    let lines: Vec<serde_json::Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(json["legs"], serde_json::Value::from(lines));
    let expected = serde_json::to_value(rows()).expect("JSON");
    assert_eq!(json["legs"], expected);
}

#[test]
fn a_comma_separated_table_has_empty_cells_for_what_is_not_known() {
    let text = String::from_utf8(written(TableForm::Csv)).expect("text");
    assert_eq!(
        text,
        "from,to,duration_s,certified_lower_bound_s,status,source,key\n\
         0,1,0.30000000000000004,,converged,computed,abc\n\
         0,2,,,,missing,\n\
         0,3,1e300,,converged,cached,abc\n"
    );
}

#[test]
fn parquet_is_read_as_it_was_written() {
    let bytes = bytes::Bytes::from(written(TableForm::Parquet));
    let reader = SerializedFileReader::new(bytes).expect("Parquet");
    let head = reader.metadata().file_metadata().key_value_metadata();
    let head = head.expect("a head");
    assert!(
        head.iter()
            .any(|said| said.key == "kind" && said.value.as_deref() == Some("rest_to_rest"))
    );
    let read = reader.get_row_iter(None).expect("rows");
    let read: Vec<_> = read.map(|row| row.expect("a row")).collect();
    assert_eq!(read.len(), 3);
    for (read, row) in read.iter().zip(rows()) {
        assert_eq!(
            read.get_int(0).map(|at| at.to_string()).ok(),
            Some(row.from.to_string())
        );
        assert_eq!(
            read.get_int(1).map(|at| at.to_string()).ok(),
            Some(row.to.to_string())
        );
        let bits = |value: Option<f64>| value.map(f64::to_bits);
        assert_eq!(
            bits(read.get_double(2).ok()),
            bits(row.duration_s.map(|n| n.0))
        );
        assert!(read.get_double(3).is_err());
        assert_eq!(read.get_string(4).ok(), row.status.as_ref());
        assert_eq!(
            read.get_string(5).map(String::as_str).ok(),
            Some(row.source.into())
        );
        assert_eq!(read.get_string(6).ok(), row.key.as_ref());
    }
}

#[test]
fn no_rows_are_a_table_too() {
    for form in [
        TableForm::Json,
        TableForm::Ndjson,
        TableForm::Csv,
        TableForm::Parquet,
    ] {
        let writer = TableWriter::begin(form, HEAD, Vec::new()).expect("begun");
        let bytes = writer.finish().expect("finished");
        match form {
            TableForm::Json => {
                let json: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
                assert_eq!(json["legs"], serde_json::json!([]));
            }
            TableForm::Ndjson => assert_eq!(bytes, b""),
            TableForm::Csv => assert_eq!(bytes.split(|byte| *byte == b'\n').count(), 2),
            TableForm::Parquet => {
                let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).expect("Parquet");
                assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
            }
        }
    }
}

#[test]
fn places_with_names_are_columns_of_text() {
    let mut rows = rows();
    for row in &mut rows {
        row.from = LegEnd::Name("start".into());
        row.to = LegEnd::Name(format!("target {}", row.to));
    }
    let head = TableHead {
        named: true,
        ..HEAD
    };
    let mut writer = TableWriter::begin(TableForm::Parquet, head, Vec::new()).expect("begun");
    writer.rows(&rows).expect("written");
    let bytes = bytes::Bytes::from(writer.finish().expect("finished"));
    let reader = SerializedFileReader::new(bytes).expect("Parquet");
    let read = reader
        .get_row_iter(None)
        .expect("rows")
        .map(|row| row.expect("a row"));
    for (read, row) in read.zip(&rows) {
        assert_eq!(read.get_string(0).ok(), Some(&"start".to_owned()));
        assert_eq!(read.get_string(1).ok(), Some(&row.to.to_string()));
    }
}
