//! What the fields of a declared document mean, as a page in Markdown.

use slewplan_solver::model::input::{
    InputForm, Literal, MemberBounds, MemberSchema, NamedSchema, Schema, text_of,
};
use std::fmt::Write;

/// A page with a section for the document and one for everything with a name inside of it.
pub(crate) fn page<F: InputForm>() -> String {
    let mut found = Vec::new();
    collect(&F::schema(), &mut found);
    let sections: Vec<String> = found.iter().map(section).collect();
    sections.join("\n")
}

/// The named parts of a schema that have a section, in the order in which they are met, each once.
fn collect(schema: &Schema, found: &mut Vec<NamedSchema>) {
    match schema {
        Schema::Named(named) => {
            let inside = (named.schema)();
            if is_inline(&inside) || found.contains(named) {
                return;
            }
            found.push(*named);
            collect(&inside, found);
        }
        Schema::List { of, .. } | Schema::Nullable(of) => collect(of, found),
        Schema::Object(members) | Schema::OpenObject(members) => collect_members(members, found),
        Schema::Kinds(kinds) => {
            for (_, _, members) in kinds {
                collect_members(members, found);
            }
        }
        Schema::OneOf(schemas) => {
            for (_, schema) in schemas {
                collect(schema, found);
            }
        }
        Schema::Number
        | Schema::Integer(_)
        | Schema::Boolean
        | Schema::Text
        | Schema::Choice(_) => {}
    }
}

fn collect_members(members: &[MemberSchema], found: &mut Vec<NamedSchema>) {
    for member in members {
        collect(&member.schema, found);
    }
}

/// Whether a part with a name is told where it is used: vectors and matrices are.
fn is_inline(schema: &Schema) -> bool {
    matches!(schema, Schema::List { .. })
}

fn section(named: &NamedSchema) -> String {
    let mut text = format!("## {}\n\n", named.name);
    let said = text_of(named.doc);
    if !said.is_empty() {
        text.push_str(&in_one_line(&said));
        text.push_str("\n\n");
    }
    text + &body(&(named.schema)())
}

fn body(schema: &Schema) -> String {
    match schema {
        Schema::Object(members) | Schema::OpenObject(members) => table(members),
        Schema::Choice(choices) => {
            let line =
                |(name, said): &(&str, String)| format!("- `{name}`: {}\n", in_one_line(said));
            choices.iter().map(line).collect::<Vec<_>>().concat()
        }
        Schema::Kinds(kinds) => {
            let part = |(kind, said, members): &(&str, String, Vec<MemberSchema>)| {
                format!(
                    "`\"kind\": \"{kind}\"`: {}\n\n{}",
                    in_one_line(said),
                    table(members)
                )
            };
            kinds.iter().map(part).collect::<Vec<_>>().join("\n")
        }
        Schema::OneOf(schemas) => {
            let line = |(said, schema): &(String, Schema)| {
                let said = in_one_line(said);
                let space = if said.is_empty() { "" } else { " " };
                format!("- {}{space}{said}\n", form(schema))
            };
            "One of these:\n\n".to_owned() + &schemas.iter().map(line).collect::<Vec<_>>().concat()
        }
        other => form(other) + "\n",
    }
}

fn table(members: &[MemberSchema]) -> String {
    let mut text = String::from("| field | value | without it | meaning |\n|---|---|---|---|\n");
    for member in members {
        // Writing into a text cannot fail.
        let _ = writeln!(
            text,
            "| `{}` | {}{} | {} | {} |",
            member.name,
            form(&member.schema),
            bounds(&member.bounds),
            absence(member),
            in_one_line(&member.text)
        );
    }
    text
}

fn form(schema: &Schema) -> String {
    match schema {
        Schema::Number => "number".into(),
        Schema::Integer(_) => "whole number".into(),
        Schema::Boolean => "`true` or `false`".into(),
        Schema::Text => "text".into(),
        Schema::Nullable(schema) => format!("{} or `null`", form(schema)),
        Schema::List {
            of,
            at_least,
            at_most,
        } => {
            let count = match (at_least, at_most) {
                (Some(least), Some(most)) if least == most => format!(" of {least}"),
                (_, Some(most)) => format!(" of at most {most}"),
                (Some(least), None) => format!(" of at least {least}"),
                (None, None) => String::new(),
            };
            format!("list{count} ({})", form(of))
        }
        Schema::Named(named) => {
            let inside = (named.schema)();
            if is_inline(&inside) {
                return form(&inside);
            }
            format!("[{}](#{})", named.name, named.name.to_lowercase())
        }
        other => unreachable!("only names stand for {other:?}"),
    }
}

fn bounds(bounds: &MemberBounds) -> String {
    let numbers = [
        ("at least", bounds.minimum),
        ("above", bounds.exclusive_minimum),
        ("at most", bounds.maximum),
        ("below", bounds.exclusive_maximum),
    ];
    let lengths = [
        ("at least", bounds.min_length),
        ("at most", bounds.max_length),
    ];
    let numbers = numbers
        .iter()
        .filter_map(|(word, bound)| Some(format!(", {word} {}", (*bound)?)));
    let long = |(word, bound): &(&str, Option<usize>)| Some(format!(", {word} {} long", (*bound)?));
    numbers.chain(lengths.iter().filter_map(long)).collect()
}

fn absence(member: &MemberSchema) -> String {
    match member.default {
        _ if member.required => "required".into(),
        Some(Literal::Number(value)) => format!("`{value}`"),
        Some(Literal::Integer(value)) => format!("`{value}`"),
        Some(Literal::Boolean(value)) => format!("`{value}`"),
        None => member
            .unless
            .map_or_else(String::new, |other| format!("`{other}` instead")),
    }
}

/// A text for a cell of a table.
fn in_one_line(text: &str) -> String {
    text.lines()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::spec::ScenarioSpec;

    #[test]
    fn the_page_of_scenarios_has_every_field_with_its_rules() {
        let page = page::<ScenarioSpec>();
        for row in [
            "## Scenario\n\nA planning problem. ",
            "| `spacecraft` | [SpacecraftOrReference](#spacecraftorreference) | required | The spacecraft. |",
            "| `max_speed_rad_s` | number or `null`, above 0 |  | Limit of the speed ",
            "| `relative_gap` | number, at least 0, below 1 | `0` | Gap at which ",
            "| `inertia_kg_m2` | list of 3 (list of 3 (number)) | required | Inertia of the whole ",
            "| `rate_min_rad_s` | list of 3 (number or `null`) or `null` |  | Lower bounds ",
            "- `standard`: Within 0.05 % of the converged minimum.\n",
            "- [RaDecRollForm](#radecrollform)\n",
        ] {
            assert!(page.contains(row), "{row} is not in\n{page}");
        }
    }

    #[test]
    fn links_lead_to_sections() {
        let page = page::<ScenarioSpec>();
        let headings = page.lines().filter_map(|line| line.strip_prefix("## "));
        let anchors: Vec<String> = headings.map(str::to_lowercase).collect();
        let links = page
            .split("](#")
            .skip(1)
            .filter_map(|tail| tail.split(')').next());
        let links: Vec<&str> = links.collect();
        assert!(links.len() > 10, "{links:?}");
        for link in links {
            assert!(
                anchors.contains(&link.to_owned()),
                "{link} is none of {anchors:?}"
            );
        }
    }
}
