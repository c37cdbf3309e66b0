//! Texts that are almost JSON, or another format.

/// What a text that is no JSON probably is, and what to do about it.
pub(super) struct Lookalike {
    /// What it is, as the cause of the error.
    pub(super) what: &'static str,
    /// What to do about it.
    pub(super) hint: &'static str,
}

const YAML: Lookalike = Lookalike {
    what: "this looks like YAML, and only JSON is read",
    hint: "convert the document, with yq -o json for example, or write it as one JSON object",
};
const COMMENT: Lookalike = Lookalike {
    what: "a comment, which JSON does not have",
    hint: "remove the comments; there is a name for a short remark",
};

/// Recognises a text by how it begins and by what stands at its first error, line and column counted
/// from 1.
pub(super) fn of(text: &[u8], line: usize, column: usize) -> Option<Lookalike> {
    if is_yaml(text) {
        return Some(YAML);
    }
    let line = text
        .split(|byte| *byte == b'\n')
        .nth(line.checked_sub(1)?)?;
    is_comment(line, column).then_some(COMMENT)
}

/// Whether a comment begins at a column; the parser may have read its first character.
fn is_comment(line: &[u8], column: usize) -> bool {
    let begins = |column: usize| {
        let rest = line.get(column.wrapping_sub(1)..).unwrap_or_default();
        let marks: [&[u8]; 3] = [b"//", b"/*", b"#"];
        marks.iter().any(|mark| rest.starts_with(mark))
    };
    begins(column) || begins(column.saturating_sub(1))
}

/// Whether the first line that is neither empty nor a comment begins a document in YAML.
fn is_yaml(text: &[u8]) -> bool {
    let lines = text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    let Some(first) = lines.next() else {
        return false;
    };
    let name = first.iter().position(|byte| !is_of_name(*byte));
    let after_name = name.map_or(&first[..0], |end| &first[end..]);
    let is_member = name != Some(0) && (after_name == b":" || after_name.starts_with(b": "));
    is_member || first == b"---" || first.starts_with(b"%YAML") || first.starts_with(b"- ")
}

fn is_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-'
}

#[cfg(test)]
mod tests {
    use crate::documents::document::parse;

    fn message_and_hint(text: &str) -> (String, String) {
        let problem = parse(text.as_bytes()).expect_err(text);
        (problem.message, problem.hint)
    }

    #[test]
    fn yaml_is_told_from_json_with_an_error() {
        for text in [
            "name: two-looks\nspacecraft:\n  wheels: []\n",
            "# a scenario\n\nspacecraft:\n",
            "---\nname: a\n",
            "- id: a\n",
        ] {
            let (message, hint) = message_and_hint(text);
            assert!(
                message.contains("line 1, column ") || text.starts_with('#'),
                "{message}"
            );
            assert!(
                message.contains("YAML") && hint.contains("JSON"),
                "{text}: {message}"
            );
        }
        for text in [
            "nonsense",
            "{name: 1}",
            "-1.5.2",
            "{\"a\": b: c}",
            "\"a: b\" x",
        ] {
            let (message, _) = message_and_hint(text);
            assert!(!message.contains("YAML"), "{text}: {message}");
        }
    }

    #[test]
    fn comments_are_named_wherever_they_stand() {
        for text in [
            "// a scenario\n{}",
            "# a scenario\n{}",
            "/* a scenario */ {}",
            "{ // first\n\"a\": 1}",
            "{\"a\": 1, // first\n \"b\": 2}",
            "{\"a\": 1 // last\n}",
            "{\"a\": /* one */ 1}",
            "{\"a\" /* one */: 1}",
            "{\"a\": [1, # one\n 2]}",
            "{\"a\": [1 # one\n]}",
            "{\"a\": 1} // end",
            "{\n  \"a\": 1,\n  // \"b\": 2\n  \"c\": 3\n}",
        ] {
            let (message, hint) = message_and_hint(text);
            assert!(message.contains(": a comment"), "{text}: {message}");
            assert!(hint.contains("remove the comments"), "{hint}");
        }
        for text in ["{\"a\": \"// no comment\", }", "{\"a\": 1 / 2}"] {
            let (message, _) = message_and_hint(text);
            assert!(!message.contains("comment"), "{text}: {message}");
        }
    }
}
