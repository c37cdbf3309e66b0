//! Reading lists.

use super::Cursor;
use crate::documents::document::Node;

impl<'a> Cursor<'a> {
    /// All values of a list or nothing, but never before every entry has been read and its problems
    /// recorded.
    pub(crate) fn all<T>(&self, read: impl Fn(&Cursor<'a>) -> Option<T>) -> Option<Vec<T>> {
        let length = self.list()?.len();
        // One place at a time: all of them would take more memory than what they say.
        let entry = |index| read(&self.entry(index)?);
        let values: Vec<Option<T>> = (0..length).map(entry).collect();
        values.into_iter().collect()
    }

    /// One entry of a list; `None` when there is none, without a problem.
    pub(crate) fn entry(&self, index: usize) -> Option<Cursor<'a>> {
        let Node::List(entries) = self.node else {
            return None;
        };
        Some(Cursor {
            node: entries.get(index)?,
            pointer: format!("{}/{index}", self.pointer),
            sink: self.sink,
        })
    }

    /// The entries of a list.
    pub(super) fn list(&self) -> Option<&'a [Node]> {
        let Node::List(entries) = self.node else {
            self.wrong_type("a list", "write [..] with one entry for each");
            return None;
        };
        Some(entries)
    }
}
