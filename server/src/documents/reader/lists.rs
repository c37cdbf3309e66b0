//! Reading lists: entry by entry, or numbers and texts at once.

use super::Cursor;
use crate::documents::document::Node;
use slewplan_solver::model::problem::{Code, Problem};

impl<'a> Cursor<'a> {
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
