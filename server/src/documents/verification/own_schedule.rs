//! What a plan says of its schedule: its value, the targets that it leaves out, and its waits.

use super::number;
use crate::documents::document::Node;
use slewplan_solver::checker::ScheduleClaims;
use slewplan_solver::model::plan::Wait;

/// The claims of a plan. Members of other forms are not looked at, as in plans of other origin.
pub(super) fn claims(plan: &Node) -> ScheduleClaims {
    let list = |name: &str| match plan.member(name) {
        Some(Node::List(entries)) => Some(entries),
        _ => None,
    };
    let skipped = list("skipped").map(|entries| {
        let targets = entries.iter().filter_map(|entry| text(entry, "target"));
        targets.collect()
    });
    let waits = list("waits").map_or_else(Vec::new, |entries| {
        entries.iter().filter_map(wait).collect()
    });
    ScheduleClaims {
        value: number(plan, "value"),
        skipped,
        waits,
    }
}

fn wait(entry: &Node) -> Option<Wait> {
    Some(Wait {
        target: text(entry, "target")?,
        from_s: number(entry, "from_s")?,
        to_s: number(entry, "to_s")?,
    })
}

fn text(object: &Node, name: &str) -> Option<String> {
    match object.member(name)? {
        Node::Text(text) => Some(text.to_string()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;

    #[test]
    fn claims_are_read_and_other_forms_left_alone() {
        let read = |text: &str| claims(&parse(text.as_bytes()).expect("JSON"));
        let plan = r#"{"value": 3, "skipped": [{"target": "c", "reason": "time_is_up"}, 7],
            "waits": [{"target": "a", "from_s": 1.5, "to_s": 2}, {"target": "a"}]}"#;
        let expected = ScheduleClaims {
            value: Some(3.0),
            skipped: Some(vec!["c".to_owned()]),
            waits: vec![Wait {
                target: "a".to_owned(),
                from_s: 1.5,
                to_s: 2.0,
            }],
        };
        assert_eq!(read(plan), expected);
        for other in ["{}", r#"{"value": "much", "skipped": null, "waits": 3}"#] {
            assert_eq!(read(other), ScheduleClaims::default(), "{other}");
        }
    }
}
