//! A cursor over a document that knows its JSON pointer and collects every problem.
//!
//! A reading method that fails records why and returns `None`; the caller goes on with a benign
//! substitute, so that one pass finds everything that is wrong.

use super::document::Node;
use slewplan_solver::model::problem::{Code, MAX_KEPT, Problem};
use std::cell::RefCell;

mod fields;
mod lists;
mod place;
mod spelling;

pub(crate) use fields::Fields;
pub(crate) use spelling::hint as known_names_hint;

/// Collects problems while cursors walk a document.
#[derive(Debug, Default)]
pub(crate) struct Sink(RefCell<Vec<Problem>>);

impl Sink {
    /// Records a problem, unless there are very many.
    pub(crate) fn push(&self, problem: Problem) {
        if !self.is_full() {
            self.0.borrow_mut().push(problem);
        }
    }

    /// Whether there are very many.
    fn is_full(&self) -> bool {
        self.0.borrow().len() >= MAX_KEPT
    }

    /// All problems in the order of their discovery.
    pub(crate) fn into_problems(self) -> Vec<Problem> {
        self.0.into_inner()
    }
}

/// A place in a document.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    node: &'a Node,
    pointer: String,
    sink: &'a Sink,
}

impl<'a> Cursor<'a> {
    /// The whole document.
    pub(crate) fn root(node: &'a Node, sink: &'a Sink) -> Self {
        Self::at(node, "", sink)
    }

    /// A part of a larger document that stands at this JSON pointer.
    pub(crate) fn at(node: &'a Node, pointer: &str, sink: &'a Sink) -> Self {
        Self {
            node,
            pointer: pointer.to_owned(),
            sink,
        }
    }

    /// Records a problem at this place.
    pub(crate) fn report(&self, code: Code, message: impl Into<String>, hint: impl Into<String>) {
        self.sink
            .push(Problem::new(&self.pointer, code, message, hint));
    }

    fn wrong_type(&self, expected: &str, hint: &str) {
        let found = self.node.description();
        self.report(
            Code::WrongType,
            format!("expected {expected}, found {found}"),
            hint,
        );
    }

    /// An object of which only these members are known.
    pub(crate) fn object(&self, known: &[&str]) -> Option<Fields<'a>> {
        let fields = self.open_object()?;
        fields.report_unknown(known);
        Some(fields)
    }

    /// An object that may have further members.
    pub(crate) fn open_object(&self) -> Option<Fields<'a>> {
        let Node::Object(members) = self.node else {
            self.wrong_type("an object", "write {\"name\": value, ...}");
            return None;
        };
        let fields = Fields::of(members, self.clone());
        fields.report_duplicates();
        Some(fields)
    }

    /// A member of an object; `None` for anything else, without a problem.
    pub(crate) fn member(&self, name: &str) -> Option<Cursor<'a>> {
        Some(Cursor {
            node: self.node.member(name)?,
            pointer: self.pointer_to(name),
            sink: self.sink,
        })
    }

    fn pointer_to(&self, name: &str) -> String {
        // RFC 6901: first the escape character itself, then the separator.
        let escaped = name.replace('~', "~0").replace('/', "~1");
        format!("{}/{escaped}", self.pointer)
    }

    /// A number.
    pub(crate) fn number(&self) -> Option<f64> {
        match self.node {
            Node::Integer(value) => Some(*value as f64),
            Node::Number(value) => Some(*value),
            _ => {
                self.wrong_type(
                    "a number",
                    "write a plain JSON number, without quotes or units",
                );
                None
            }
        }
    }

    /// A whole number from zero on.
    pub(crate) fn integer(&self) -> Option<u64> {
        if let Node::Integer(value) = self.node {
            return Some(*value);
        }
        let hint = "write a whole number from 0 to 18446744073709551615";
        self.wrong_type("a whole number of at least 0", hint);
        None
    }

    /// A text.
    pub(crate) fn text(&self) -> Option<&'a str> {
        if let Node::Text(text) = self.node {
            return Some(text);
        }
        self.wrong_type("a text", "write it in double quotes");
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;
    use slewplan_solver::model::input::InputForm;

    fn problems_of(text: &str, read: impl Fn(Cursor<'_>)) -> Vec<(String, Code)> {
        let node = parse(text.as_bytes()).unwrap();
        let sink = Sink::default();
        read(Cursor::root(&node, &sink));
        sink.into_problems()
            .into_iter()
            .map(|p| (p.pointer, p.code))
            .collect()
    }

    #[test]
    fn pointers_escape_tilde_and_slash() {
        let found = problems_of(r#"{"a/b~c": 1}"#, |root| {
            root.object(&["known"]);
        });
        assert_eq!(found, [("/a~1b~0c".to_owned(), Code::UnknownField)]);
    }

    #[test]
    fn every_entry_of_a_list_is_reported() {
        let found = problems_of(r#"["a", 1, null]"#, |root| {
            assert_eq!(<[f64; 3]>::read(&root), None);
        });
        assert_eq!(
            found,
            [
                ("/0".to_owned(), Code::WrongType),
                ("/2".to_owned(), Code::WrongType)
            ]
        );
    }

    #[test]
    fn missing_duplicate_and_short_are_told_apart() {
        let found = problems_of(r#"{"a": [1, 2], "a": 3, "a": 4}"#, |root| {
            let fields = root.object(&["a", "b"]).unwrap();
            assert!(fields.required("b").is_none());
            assert_eq!(<[f64; 3]>::read(&fields.required("a").unwrap()), None);
        });
        let expected = [
            ("/a".to_owned(), Code::DuplicateField),
            ("/b".to_owned(), Code::MissingField),
            ("/a".to_owned(), Code::WrongLength),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn integers_are_not_rounded() {
        let found = problems_of("[0, 1.5, -1, 18446744073709551615]", |root| {
            let read = |index| root.entry(index)?.integer();
            assert_eq!(
                [0, 1, 2, 3].map(read),
                [Some(0), None, None, Some(u64::MAX)]
            );
        });
        assert_eq!(found.len(), 2);
    }
}
