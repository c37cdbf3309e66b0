//! How large the tree of a document becomes.
//!
//! A value takes twelve times the memory of its shortest text, `0,`, and twice that while a list of
//! them grows, so that a body of nothing but zeros would take far more than its own size; the name of
//! a member takes almost as much as a value. So they are counted before there is a tree of them.

use super::outside::outside_texts;

/// Number of values in a document, those in lists and objects included, and of names of members.
pub(crate) fn values_and_names(text: &[u8]) -> usize {
    // The document itself, then what follows a comma or a colon, and the first of what a bracket opens.
    let mut values = 1;
    let mut opened = false;
    for (_, byte) in outside_texts(text) {
        match byte {
            b' ' | b'\t' | b'\r' | b'\n' => continue,
            b',' | b':' => values += 1,
            b']' | b'}' => {}
            _ => values += usize::from(opened),
        }
        opened = matches!(byte, b'[' | b'{');
    }
    values
}

#[cfg(test)]
mod tests {
    use super::super::{Node, parse};
    use super::*;

    fn counted(node: &Node) -> usize {
        let inside: usize = match node {
            Node::List(items) => items.iter().map(counted).sum(),
            Node::Object(members) => members.iter().map(|(_, value)| 1 + counted(value)).sum(),
            _ => 0,
        };
        1 + inside
    }

    #[test]
    fn as_many_are_counted_as_the_tree_has() {
        let texts = [
            "0",
            "[]",
            "[ ]",
            "{}",
            "[0]",
            "[0,1,[2,[]],{}]",
            r#"{"a": [1, 2], "b,[c": "d,\"[{", "e": {"f": {}}}"#,
            r#"["\\", "[", {"": ["]"]}]"#,
            "[\n\t[[[null]]], [[true], false]]",
        ];
        for text in texts {
            let node = parse(text.as_bytes()).unwrap();
            assert_eq!(values_and_names(text.as_bytes()), counted(&node), "{text}");
        }
    }

    #[test]
    fn what_is_no_document_is_counted_too() {
        assert_eq!(values_and_names(b""), 1);
        assert_eq!(values_and_names(&[b'['; 1000]), 1000);
        values_and_names(b"\"\\");
        values_and_names(b"]]}},,::\xff");
    }
}
