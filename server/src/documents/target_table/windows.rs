//! Windows in a cell: `60..120 300..360`, in seconds from time zero or as dates.
//!
//! Blanks, commas, semicolons and bars separate windows; begin and end have two dots or, as intervals of
//! ISO 8601 have, a slash between them.

use crate::documents::document::Node;
use slewplan_solver::model::epoch;

/// How a cell of windows is written.
pub(super) const HINT: &str = "write from..to in seconds from time zero or as dates such as \
                               2026-01-31T12:00:00Z, and blanks between several windows";

/// The windows of a cell as a list of a scenario; `None` when it cannot be read.
pub(super) fn read(cell: &str) -> Option<Node> {
    let joined = joined(cell);
    let parts = joined.split(|c: char| c.is_whitespace() || ",;|".contains(c));
    let windows: Option<Vec<Node>> = parts.filter(|part| !part.is_empty()).map(window).collect();
    Some(Node::List(windows?.into()))
}

/// The cell without blanks around the signs between begin and end.
fn joined(cell: &str) -> String {
    let slashes: Vec<&str> = cell.split('/').map(str::trim).collect();
    let dots = slashes.join("..");
    let ends: Vec<&str> = dots.split("..").map(str::trim).collect();
    ends.join("..")
}

fn window(text: &str) -> Option<Node> {
    let (from, to) = text.split_once("..")?;
    let members = [end(from, ["from_s", "from"])?, end(to, ["to_s", "to"])?];
    Some(Node::Object(members.into()))
}

/// One end of a window, with the names that it has in seconds and as a date.
fn end(text: &str, [seconds, date]: [&str; 2]) -> Option<(Box<str>, Node)> {
    if epoch::parse(text).is_some() {
        return Some((date.into(), Node::Text(text.into())));
    }
    let number = text.parse::<f64>().ok()?;
    let number = number.is_finite().then_some(number)?;
    Some((seconds.into(), Node::Number(number)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(cell: &str) -> Option<String> {
        read(cell).map(|node| node.to_json())
    }

    #[test]
    fn seconds_and_dates_are_told_apart() {
        let expected = r#"[{"from_s":60.0,"to_s":120.5},{"from_s":300.0,"to_s":360.0}]"#;
        for cell in [
            "60..120.5 300..360",
            "60/120.5; 300 / 360",
            " 60 .. 120.5,300..360 ",
            "60..120.5|300../360",
        ] {
            let found = json(cell);
            if cell.contains("../") {
                assert_eq!(found, None, "{cell}");
            } else {
                assert_eq!(found.as_deref(), Some(expected), "{cell}");
            }
        }
        assert_eq!(
            json("2026-01-01T00:01:00Z..2026-01-01T00:02:00.5 5..6").as_deref(),
            Some(
                r#"[{"from":"2026-01-01T00:01:00Z","to":"2026-01-01T00:02:00.5"},{"from_s":5.0,"to_s":6.0}]"#
            )
        );
    }

    #[test]
    fn everything_else_is_refused() {
        for cell in [
            "60",
            "60-120",
            "60..",
            "..120",
            "1..2..3",
            "soon..later",
            "0..inf",
            "NaN..1",
            "1..2 3",
            "2026-01-01..2026-01-02",
        ] {
            assert_eq!(json(cell), None, "{cell}");
        }
    }
}
