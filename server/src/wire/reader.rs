//! A cursor over a document that knows its JSON pointer and collects every problem.
//!
//! A reading method that fails records why and returns `None`; the caller goes on with a benign
//! substitute, so that one pass finds everything that is wrong.

use super::document::Node;
use slewplan_solver::problem::{Code, MOST_KEPT, Problem};
use std::cell::RefCell;

mod spelling;

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
        self.0.borrow().len() >= MOST_KEPT
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

    /// The JSON pointer of the place.
    pub(crate) fn pointer(&self) -> &str {
        &self.pointer
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
    pub(crate) fn object(&self, known: &'static [&'static str]) -> Option<Fields<'a>> {
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
        let fields = Fields {
            members,
            place: self.clone(),
        };
        fields.report_duplicates();
        Some(fields)
    }

    /// A member of an object; `None` for anything else, without a problem.
    pub(crate) fn member(&self, name: &str) -> Option<Cursor<'a>> {
        let Node::Object(members) = self.node else {
            return None;
        };
        Fields {
            members,
            place: self.clone(),
        }
        .raw(name)
    }

    /// What is read of every entry of a list.
    pub(crate) fn each<T>(&self, read: impl Fn(&Cursor<'a>) -> T) -> Option<Vec<T>> {
        let entries = self.entries()?.iter().enumerate();
        // One place at a time: all of them would take more memory than what they say.
        Some(entries.map(|entry| read(&self.place(entry))).collect())
    }

    /// What is read of every entry of a list; a longer one is not looked into.
    pub(crate) fn each_of_at_most<T>(
        &self,
        most: usize,
        read: impl Fn(&Cursor<'a>) -> T,
    ) -> Option<Vec<T>> {
        let length = self.entries()?.len();
        if length > most {
            self.sink
                .push(Problem::too_long(&self.pointer, length, most));
            return None;
        }
        self.each(read)
    }

    /// All values of a list or nothing, but never before every entry has been read and its problems
    /// recorded.
    pub(crate) fn all<T>(&self, read: impl Fn(&Cursor<'a>) -> Option<T>) -> Option<Vec<T>> {
        self.each(read)?.into_iter().collect()
    }

    /// One entry of a list; `None` when there is none, without a problem.
    pub(crate) fn entry(&self, index: usize) -> Option<Cursor<'a>> {
        let Node::List(entries) = self.node else {
            return None;
        };
        Some(self.place((index, entries.get(index)?)))
    }

    /// Number of entries of a list; `None` for anything else, without a problem.
    pub(crate) fn length(&self) -> Option<usize> {
        match self.node {
            Node::List(entries) => Some(entries.len()),
            _ => None,
        }
    }

    fn entries(&self) -> Option<&'a [Node]> {
        let Node::List(entries) = self.node else {
            self.wrong_type("a list", "write [..] with one entry for each");
            return None;
        };
        Some(entries)
    }

    fn place(&self, (index, node): (usize, &'a Node)) -> Cursor<'a> {
        Cursor {
            node,
            pointer: format!("{}/{index}", self.pointer),
            sink: self.sink,
        }
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

    /// `true` or `false`.
    pub(crate) fn boolean(&self) -> Option<bool> {
        if let Node::Bool(value) = self.node {
            return Some(*value);
        }
        self.wrong_type("true or false", "write true or false without quotes");
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

    /// A text among choices.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let text = self.text()?;
        let found = choices.iter().find(|(name, _)| *name == text);
        if found.is_none() {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            self.report(
                Code::UnknownChoice,
                format!("{text:?} is not one of the choices"),
                spelling::hint(text, &names),
            );
        }
        found.map(|(_, value)| *value)
    }

    /// The member `kind` of an object, among choices; other members are looked at later.
    pub(crate) fn kind<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        self.open_object()?.required("kind")?.choice(choices)
    }

    /// A list of exactly `N` numbers.
    pub(crate) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        self.array(Cursor::number)
    }

    /// A list of exactly `N` numbers, each of which may be `null`.
    pub(crate) fn nullable_numbers<const N: usize>(&self) -> Option<[Option<f64>; N]> {
        self.array(|entry| match entry.node {
            Node::Null => Some(None),
            _ => entry.number().map(Some),
        })
    }

    /// Three rows of three numbers.
    pub(crate) fn matrix(&self) -> Option<[[f64; 3]; 3]> {
        self.array(Cursor::numbers::<3>)
    }

    /// A list of numbers of any length.
    pub(crate) fn any_numbers(&self) -> Option<Vec<f64>> {
        self.all(Cursor::number)
    }

    /// A list of texts of any length.
    pub(crate) fn texts(&self) -> Option<Vec<String>> {
        self.all(|entry| entry.text().map(str::to_owned))
    }

    fn array<T, const N: usize>(&self, read: impl Fn(&Cursor<'a>) -> Option<T>) -> Option<[T; N]> {
        let length = self.entries()?.len();
        if length != N {
            self.report(
                Code::WrongLength,
                format!("expected {N} entries, found {length}"),
                format!("write exactly {N} entries"),
            );
            return None;
        }
        self.all(read)?.try_into().ok()
    }
}

/// The members of an object.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    members: &'a [(String, Node)],
    place: Cursor<'a>,
}

impl<'a> Fields<'a> {
    /// A member as written, `null` included; the first one when it is there twice.
    pub(crate) fn raw(&self, name: &str) -> Option<Cursor<'a>> {
        let (_, node) = self.members.iter().find(|(key, _)| key == name)?;
        Some(Cursor {
            node,
            pointer: self.pointer_to(name),
            sink: self.place.sink,
        })
    }

    /// A member that may be left out or `null`.
    pub(crate) fn optional(&self, name: &str) -> Option<Cursor<'a>> {
        self.raw(name).filter(|cursor| *cursor.node != Node::Null)
    }

    /// A member that must be there.
    pub(crate) fn required(&self, name: &str) -> Option<Cursor<'a>> {
        let found = self.raw(name);
        if found.is_none() {
            self.place.sink.push(Problem::new(
                self.pointer_to(name),
                Code::MissingField,
                format!("the required field {name:?} is missing"),
                format!("add {name:?} to this object"),
            ));
        }
        found
    }

    fn pointer_to(&self, name: &str) -> String {
        // RFC 6901: first the escape character itself, then the separator.
        let escaped = name.replace('~', "~0").replace('/', "~1");
        format!("{}/{escaped}", self.place.pointer)
    }

    fn report_unknown(&self, known: &[&str]) {
        for (name, _) in self.members {
            if self.place.sink.is_full() {
                return;
            }
            if !known.contains(&name.as_str()) {
                self.place.sink.push(Problem::new(
                    self.pointer_to(name),
                    Code::UnknownField,
                    format!("{name:?} is not a field of this object"),
                    spelling::hint(name, known),
                ));
            }
        }
    }

    fn report_duplicates(&self) {
        // Sorted, so that an object of a million members costs no million squared.
        let mut names: Vec<&str> = self.members.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        let mut reported = None;
        for pair in names.windows(2).filter(|pair| pair[0] == pair[1]) {
            if reported != Some(pair[0]) {
                reported = Some(pair[0]);
                self.place.sink.push(Problem::new(
                    self.pointer_to(pair[0]),
                    Code::DuplicateField,
                    format!("the field {:?} is there more than once", pair[0]),
                    "keep the one that is meant",
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::document::parse;

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
            assert_eq!(root.numbers::<3>(), None);
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
            assert_eq!(fields.required("a").unwrap().numbers::<3>(), None);
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
            let read = root.each(Cursor::integer).unwrap();
            assert_eq!(read, [Some(0), None, None, Some(u64::MAX)]);
        });
        assert_eq!(found.len(), 2);
    }
}
