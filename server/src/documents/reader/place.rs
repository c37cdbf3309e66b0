//! A cursor as the place from which declared documents are read.

use super::{Cursor, Fields, spelling};
use crate::documents::document::Node;
use slewplan_solver::model::input::InputPlace;
use slewplan_solver::model::problem::Code;

impl InputPlace for Cursor<'_> {
    fn pointer(&self) -> &str {
        &self.pointer
    }

    fn report(&self, code: Code, message: impl Into<String>, hint: impl Into<String>) {
        Cursor::report(self, code, message, hint);
    }

    fn is_null(&self) -> bool {
        *self.node == Node::Null
    }

    fn is_number(&self) -> bool {
        matches!(self.node, Node::Integer(_) | Node::Number(_))
    }

    fn is_text(&self) -> bool {
        matches!(self.node, Node::Text(_))
    }

    fn is_list(&self) -> bool {
        matches!(self.node, Node::List(_))
    }

    fn number(&self) -> Option<f64> {
        Cursor::number(self)
    }

    fn integer(&self) -> Option<u64> {
        Cursor::integer(self)
    }

    fn boolean(&self) -> Option<bool> {
        if let Node::Bool(value) = self.node {
            return Some(*value);
        }
        self.wrong_type("true or false", "write true or false without quotes");
        None
    }

    fn text(&self) -> Option<&str> {
        Cursor::text(self)
    }

    fn choice(&self, texts: &[&str]) -> Option<usize> {
        let text = self.text()?;
        let found = texts.iter().position(|known| *known == text);
        if found.is_none() {
            self.report(
                Code::UnknownChoice,
                format!("{text:?} is not one of the choices"),
                spelling::hint(text, texts),
            );
        }
        found
    }

    fn is_object(&self, known: Option<&[&str]>) -> bool {
        match known {
            Some(known) => self.object(known).is_some(),
            None => self.open_object().is_some(),
        }
    }

    fn member(&self, name: &str) -> Option<Self> {
        Cursor::member(self, name)
    }

    fn required(&self, name: &str) -> Option<Self> {
        let Node::Object(members) = self.node else {
            return None;
        };
        Fields::of(members, self.clone()).required(name)
    }

    fn required_unless(&self, name: &str, other: &str) -> Option<Self> {
        let Node::Object(members) = self.node else {
            return None;
        };
        Fields::of(members, self.clone()).required_unless(name, other)
    }

    fn entries(&self) -> Option<usize> {
        self.list().map(<[Node]>::len)
    }

    fn entry(&self, index: usize) -> Option<Self> {
        Cursor::entry(self, index)
    }
}
