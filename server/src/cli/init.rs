//! `slewplan init`: a scenario to begin with, and a page that says what its fields mean.

use super::Exit;
use super::failure::Failure;
use super::input;
use super::output::{self, Destination};
use crate::documents::field_page;
use slewplan_solver::model::spec::ScenarioSpec;
use std::path::{Path, PathBuf};

/// Has every field at least once. It is text, so that what belongs together stands in one line.
const SCENARIO: &str = include_str!("init/scenario.json");

/// Arguments of `init`.
#[derive(Debug, clap::Args)]
pub(super) struct InitArguments {
    /// The scenario to write, with a page about its fields beside it that ends in .md; - for standard
    /// output, without the page
    #[arg(value_name = "FILE", default_value = "scenario.json")]
    scenario: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    force: bool,
    /// Print the page about the fields and write nothing
    #[arg(long, conflicts_with_all = ["scenario", "force"])]
    explain: bool,
}

/// Writes both files, or none.
pub(super) fn run(arguments: &InitArguments) -> Result<Exit, Failure> {
    if arguments.explain {
        output::print(&page("a scenario"))?;
        return Ok(Exit::Complete);
    }
    let scenario = &arguments.scenario;
    if input::is_stream(scenario) {
        output::print(SCENARIO)?;
        return Ok(Exit::Complete);
    }
    let beside = scenario.with_extension("md");
    if beside == *scenario {
        return Err(Failure::Setting {
            name: "FILE",
            what: "the page about the fields ends in .md; name the scenario otherwise".into(),
        });
    }
    let paths = [scenario.as_path(), &beside];
    if !arguments.force {
        refuse_existing(&paths)?;
    }
    let [to_scenario, to_page] = [Destination::open(paths[0])?, Destination::open(paths[1])?];
    to_scenario.write(SCENARIO)?;
    to_page.write(&page(&format!("`{}`", name_of(scenario))))?;
    let [scenario, beside] = paths.map(|path| path.display().to_string());
    output::print(&format!(
        "{scenario}: a scenario with every field\n{beside}: what the fields mean\n\
         next: slewplan solve {scenario} --summary\n"
    ))?;
    Ok(Exit::Complete)
}

fn refuse_existing(paths: &[&Path]) -> Result<(), Failure> {
    // A dangling link is there as well.
    let is_there = |path: &&&Path| path.symlink_metadata().is_ok();
    let names: Vec<String> = paths
        .iter()
        .filter(is_there)
        .map(|path| path.display().to_string())
        .collect();
    if names.is_empty() {
        return Ok(());
    }
    Err(Failure::Setting {
        name: "--force",
        what: format!(
            "would replace {}; name another file, or give --force",
            names.join(" and ")
        ),
    })
}

fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

fn page(document: &str) -> String {
    format!(
        "# The fields of {document}\n\nFields that are not required may be left out or `null`. Units are in \
         the names; angles in degrees, rates in rad/s.\nOther names are refused, so that a misspelt limit is \
         not silently no limit.\n\n{}",
        field_page::page::<ScenarioSpec>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use slewplan_solver::model::input::{InputForm, MemberSchema, Schema};

    /// Members of the objects of a schema, with what the document has at their places.
    fn members(schema: &Schema, values: &[&Value], seen: &mut Vec<(String, bool)>) {
        match schema {
            Schema::Named(named) => members(&(named.schema)(), values, seen),
            Schema::Nullable(schema) => members(schema, values, seen),
            Schema::List { of, .. } => {
                let entries = values.iter().filter_map(|value| value.as_array());
                members(of, &entries.flatten().collect::<Vec<_>>(), seen);
            }
            Schema::Object(declared) => {
                let stands_for = |name: &str, other: &MemberSchema| {
                    let is_there = |value: &&Value| value.get(other.name).is_some();
                    other.unless == Some(name) && values.iter().all(is_there)
                };
                for MemberSchema { name, schema, .. } in declared {
                    if declared.iter().any(|other| stands_for(name, other)) {
                        continue;
                    }
                    let inside: Vec<&Value> =
                        values.iter().filter_map(|value| value.get(name)).collect();
                    seen.push(((*name).to_owned(), !inside.is_empty()));
                    members(schema, &inside, seen);
                }
            }
            // Of alternatives those that the document has: nobody needs every form of an attitude.
            Schema::OneOf(schemas) => {
                for (_, schema) in schemas {
                    let Some(first) = first_member(schema) else {
                        continue;
                    };
                    let with_it = values.iter().filter(|value| value.get(first).is_some());
                    let with_it: Vec<&Value> = with_it.copied().collect();
                    if !with_it.is_empty() {
                        members(schema, &with_it, seen);
                    }
                }
            }
            _ => {}
        }
    }

    fn first_member(schema: &Schema) -> Option<&'static str> {
        match schema {
            Schema::Named(named) => first_member(&(named.schema)()),
            Schema::Object(members) => members.first().map(|member| member.name),
            _ => None,
        }
    }

    #[test]
    fn the_scenario_has_every_field() {
        let scenario: Value = serde_json::from_str(SCENARIO).unwrap();
        let mut seen = Vec::new();
        members(&ScenarioSpec::schema(), &[&scenario], &mut seen);
        assert!(seen.len() > 40, "{seen:?}");
        let missing: Vec<_> = seen.iter().filter(|(_, is_there)| !is_there).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
