//! Reading objects: members by their names, and what is wrong with the names.

use super::{Cursor, spelling};
use crate::documents::document::{Member, Node};
use slewplan_solver::model::problem::{Code, Problem};

/// The members of an object.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    members: &'a [Member],
    place: Cursor<'a>,
}

impl<'a> Fields<'a> {
    /// The members of the object at a place.
    pub(super) fn of(members: &'a [Member], place: Cursor<'a>) -> Self {
        Self { members, place }
    }

    /// A member as written, `null` included; the first one when it is there twice.
    pub(crate) fn raw(&self, name: &str) -> Option<Cursor<'a>> {
        self.place.member(name)
    }

    /// A member that may be left out or `null`.
    pub(crate) fn optional(&self, name: &str) -> Option<Cursor<'a>> {
        self.raw(name).filter(|cursor| *cursor.node != Node::Null)
    }

    /// A member that must be there.
    pub(crate) fn required(&self, name: &str) -> Option<Cursor<'a>> {
        self.found(name, || format!("add {name:?} to this object"))
    }

    /// A member that must be there, or another one instead of it.
    pub(super) fn required_unless(&self, name: &str, other: &str) -> Option<Cursor<'a>> {
        self.found(name, || format!("add {name:?} or {other:?} to this object"))
    }

    fn found(&self, name: &str, hint: impl FnOnce() -> String) -> Option<Cursor<'a>> {
        let found = self.raw(name);
        if found.is_none() {
            self.place.sink.push(Problem::new(
                self.place.pointer_to(name),
                Code::MissingField,
                format!("the required field {name:?} is missing"),
                hint(),
            ));
        }
        found
    }

    pub(super) fn report_unknown(&self, known: &[&str]) {
        for (name, _) in self.members {
            if self.place.sink.is_full() {
                return;
            }
            if !known.contains(&&**name) {
                self.place.sink.push(Problem::new(
                    self.place.pointer_to(name),
                    Code::UnknownField,
                    format!("{name:?} is not a field of this object"),
                    spelling::hint(name, known),
                ));
            }
        }
    }

    pub(super) fn report_duplicates(&self) {
        // Sorted: to compare each name with each takes a million steps in the largest object.
        let mut names: Vec<&str> = self.members.iter().map(|(name, _)| &**name).collect();
        names.sort_unstable();
        let mut reported = None;
        for pair in names.windows(2).filter(|pair| pair[0] == pair[1]) {
            if reported != Some(pair[0]) {
                reported = Some(pair[0]);
                self.place.sink.push(Problem::new(
                    self.place.pointer_to(pair[0]),
                    Code::DuplicateField,
                    format!("the field {:?} is there more than once", pair[0]),
                    "keep the one that is meant",
                ));
            }
        }
    }
}
