//! A JSON document as a tree that keeps what `serde_json::Value` would drop: the order of the
//! members and duplicate keys.

mod lookalikes;
mod numbers;
mod outside;
mod size;

pub(crate) use size::values_and_names;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};
use slewplan_solver::model::problem::{Code, Problem};
use std::fmt;

/// Most members of an object: far more than any form has, few enough to look for each name in all of
/// them.
const MAX_MEMBERS: usize = 1000;

/// A name of an object and its value.
pub(crate) type Member = (Box<str>, Node);

/// One JSON value, in no more memory than it needs once it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) enum Node {
    /// `null`.
    #[default]
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number from 0 to 2^64 - 1, exact.
    Integer(u64),
    /// Any other number.
    Number(f64),
    /// A text.
    Text(Box<str>),
    /// A list.
    List(Box<[Node]>),
    /// An object, members in the order of the document, duplicates included.
    Object(Box<[Member]>),
}

impl Node {
    /// A member of an object, the first one when it is there twice; `None` for anything else.
    pub(crate) fn member(&self, name: &str) -> Option<&Self> {
        let Self::Object(members) = self else {
            return None;
        };
        let (_, value) = members.iter().find(|(key, _)| **key == *name)?;
        Some(value)
    }

    /// The same, to be changed.
    pub(crate) fn member_mut(&mut self, name: &str) -> Option<&mut Self> {
        let Self::Object(members) = self else {
            return None;
        };
        let (_, value) = members.iter_mut().find(|(key, _)| **key == *name)?;
        Some(value)
    }

    /// What the value is, for messages: `the text "NaN"`.
    pub(crate) fn description(&self) -> String {
        match self {
            Self::Null => "null".into(),
            Self::Bool(value) => value.to_string(),
            Self::Integer(value) => format!("the number {value}"),
            Self::Number(value) => format!("the number {value}"),
            Self::Text(text) => format!("the text {:?}", shortened(text)),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Object(_) => "an object".into(),
        }
    }
}

/// The first characters of a text of unknown length.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut short: String = text.chars().take(LONGEST).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push_str("...");
    }
    short
}

/// Parses a document.
///
/// # Errors
///
/// One problem with line and column: after the first error of syntax nothing can be trusted.
pub(crate) fn parse(bytes: &[u8]) -> Result<Node, Problem> {
    // A byte order mark is no part of JSON, but some editors write one.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    numbers::check(text)?;
    serde_json::from_slice(text).map_err(|error| malformed(text, &error))
}

fn malformed(text: &[u8], error: &serde_json::Error) -> Problem {
    let (line, column) = (error.line(), error.column());
    let full = error.to_string();
    let what = full.split(" at line ").next().unwrap_or(&full);
    let (what, hint) = match lookalikes::of(text, line, column) {
        Some(lookalike) => (lookalike.what, lookalike.hint),
        None => (what, malformed_hint(text, error, what)),
    };
    let message = format!("line {line}, column {column}: {what}");
    Problem::new("", Code::MalformedJson, message, hint)
}

fn malformed_hint(text: &[u8], error: &serde_json::Error, what: &str) -> &'static str {
    // As bytes: what is no text would take three times its size to become one.
    let line = text
        .split(|byte| *byte == b'\n')
        .nth(error.line().saturating_sub(1))
        .unwrap_or_default();
    if text.iter().all(u8::is_ascii_whitespace) {
        "the document is empty; write one JSON object"
    } else if error.is_eof() {
        "the document ends too early; look for a missing bracket, brace or quote"
    } else if what.contains("number out of range") {
        "the number does not fit a 64-bit float; write a finite value, or null where no limit is meant"
    } else if what.contains("recursion limit") {
        "the document is nested too deeply; no scenario or plan needs more than ten levels"
    } else if what.contains("members") {
        "no object of a document for this has more than some twenty members"
    } else if what.contains("key must be a string") {
        "write every name in double quotes, and no comma after the last member"
    } else if what.contains("trailing comma") {
        "remove the comma before the closing bracket"
    } else if ["NaN", "nan", "Inf", "inf"]
        .iter()
        .any(|word| contains(line, word.as_bytes()))
    {
        "JSON has no NaN and no infinity; write a finite number, or null where no limit is meant"
    } else {
        "correct the JSON syntax there"
    }
}

fn contains(line: &[u8], word: &[u8]) -> bool {
    line.windows(word.len()).any(|part| part == word)
}

impl Node {
    /// The tree as JSON text again.
    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a parsed tree has only finite numbers and text keys")
    }
}

impl Serialize for Node {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => serializer.serialize_unit(),
            Self::Bool(value) => serializer.serialize_bool(*value),
            Self::Integer(value) => serializer.serialize_u64(*value),
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Text(text) => serializer.serialize_str(text),
            Self::List(items) => serializer.collect_seq(items),
            Self::Object(members) => {
                let mut map = serializer.serialize_map(Some(members.len()))?;
                for (name, value) in members {
                    map.serialize_entry(name, value)?;
                }
                map.end()
            }
        }
    }
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Bool(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Node, E> {
        Ok(Node::Integer(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Number(value as f64))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Text(value.into()))
    }

    fn visit_string<E>(self, value: String) -> Result<Node, E> {
        Ok(Node::Text(value.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Node, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            list.push(item);
        }
        Ok(Node::List(list.into()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Node, A::Error> {
        let mut members = Vec::new();
        while let Some(member) = entries.next_entry()? {
            if members.len() == MAX_MEMBERS {
                let message = format!("an object of more than {MAX_MEMBERS} members");
                return Err(A::Error::custom(message));
            }
            members.push(member);
        }
        Ok(Node::Object(members.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn duplicate_keys_and_large_integers_survive() {
        let node = parse(br#"{"a": 1, "a": 18446744073709551615, "b": -2}"#).unwrap();
        let expected = [
            ("a".into(), Node::Integer(1)),
            ("a".into(), Node::Integer(u64::MAX)),
            ("b".into(), Node::Number(-2.0)),
        ];
        assert_eq!(node, Node::Object(expected.into()));
    }

    #[test]
    fn a_tree_is_written_as_it_was_read() {
        let text = r#"{"b":[1,-2.0,1e-7,true,null],"a":{"x":"y"},"b":18446744073709551615}"#;
        assert_eq!(parse(text.as_bytes()).unwrap().to_json(), text);
    }

    #[test]
    fn syntax_errors_name_line_column_and_cause() {
        let many = format!("{{{}", r#""a": 0, "#.repeat(MAX_MEMBERS + 1));
        let cases: [(&[u8], &str, &str); 7] = [
            (many.as_bytes(), "line 1, column 80", "twenty members"),
            (b"", "line 1, column 0", "empty"),
            (b"{\n \"a\": NaN}", "line 2, column 7", "no NaN"),
            (b"[-Infinity]", "line 1, column 3", "no infinity"),
            (b"[1e400]", "line 1, column 6", "64-bit float"),
            (b"[1,]", "line 1, column 4", "comma"),
            (b"{\"a\": [1", "line 1, column 8", "ends too early"),
        ];
        for (text, place, hint) in cases {
            let problem = parse(text).unwrap_err();
            assert_eq!(problem.code, Code::MalformedJson);
            assert!(problem.message.contains(place), "{problem}");
            assert!(problem.hint.contains(hint), "{problem}");
        }
    }

    #[test]
    fn deep_nesting_is_refused_without_exhausting_the_stack() {
        let problem = parse("[".repeat(1_000_000).as_bytes()).unwrap_err();
        assert!(problem.hint.contains("nested too deeply"), "{problem}");
    }

    #[test]
    fn a_byte_order_mark_is_skipped() {
        assert_eq!(parse(b"\xef\xbb\xbfnull"), Ok(Node::Null));
    }
}
