//! Reading a query for leg times, and writing its answer.

use super::document::Node;
use super::number::Number;
use super::reader::{Cursor, Fields, Sink};
use super::{attitude, scenario, spacecraft};
use serde::Serialize;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner;
use utoipa::ToSchema;

/// A valid query.
#[derive(Debug)]
pub(crate) struct LegQuery {
    /// The conditions at the ends.
    pub(crate) kind: LegKind,
    /// Whether unknown legs are solved.
    pub(crate) compute: bool,
    /// All its attitudes as targets of one scenario.
    pub(crate) scenario: Scenario,
    /// The legs that are asked for.
    pub(crate) pairs: Vec<Pair>,
}

/// A leg that is asked for.
#[derive(Debug)]
pub(crate) struct Pair {
    /// Position of the begin: in `attitudes`, or of the pair in `pairs`.
    pub(crate) from: usize,
    /// Position of the end.
    pub(crate) to: usize,
    /// The targets of the query's scenario between which the leg is.
    pub(crate) targets: (usize, usize),
    /// A scenario of which the leg is that from the first target to the second.
    pub(crate) scenario: Scenario,
}

/// The attitudes of a query, and where they stand in it.
struct Places {
    targets: Vec<TargetSpec>,
    pointers: Vec<String>,
    /// Whether every ordered pair is asked for, or each attitude with an even index with its
    /// successor.
    all_pairs: bool,
}

impl Places {
    /// Indices of the targets at the begin and the end of each leg.
    fn pairs(&self) -> Vec<(usize, usize)> {
        let count = self.targets.len();
        if self.all_pairs {
            let from_each = (0..count).flat_map(|from| (0..count).map(move |to| (from, to)));
            from_each.filter(|(from, to)| from != to).collect()
        } else {
            (0..count / 2).map(|leg| (2 * leg, 2 * leg + 1)).collect()
        }
    }
}

/// Reads a query for at most so many legs.
///
/// # Errors
///
/// Everything that is wrong with it, or, as a number, how many legs it asks for.
pub(crate) fn read(node: &Node, most: usize) -> Result<LegQuery, Refusal> {
    let sink = Sink::default();
    let known = &[
        "spacecraft",
        "attitudes",
        "pairs",
        "kind",
        "mode",
        "start",
        "zero_rate_axes",
        "options",
    ];
    let fields = Cursor::root(node, &sink).object(known);
    // Counted before they are read, since a short list of attitudes has many pairs.
    let count = fields.as_ref().map_or(0, legs_asked_for);
    if count > most {
        return Err(Refusal::TooMany(count));
    }
    let read = fields.map(|fields| {
        (
            read_base(&fields),
            read_places(&fields),
            kind_and_mode(&fields),
        )
    });
    let problems = sink.into_problems();
    let (base, places, (kind, compute)) = match read {
        Some((base, Some(places), modes)) if problems.is_empty() => (base, places, modes),
        _ => return Err(Refusal::Invalid(problems)),
    };
    let scenario = check(&base, &places).map_err(Refusal::Invalid)?;
    let pairs = places.pairs();
    let pairs = pairs.into_iter().enumerate().map(|(index, (from, to))| {
        let between = (from, to);
        let targets = vec![places.targets[from].clone(), places.targets[to].clone()];
        let spec = ScenarioSpec {
            targets,
            ..base.clone()
        };
        let valid = Scenario::try_new(&spec).map_err(Refusal::Invalid)?;
        let (from, to) = if places.all_pairs {
            (from, to)
        } else {
            (index, index)
        };
        Ok(Pair {
            from,
            to,
            targets: between,
            scenario: valid.scenario,
        })
    });
    Ok(LegQuery {
        kind,
        compute,
        pairs: pairs.collect::<Result<_, _>>()?,
        scenario,
    })
}

/// Why a query is not answered.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// Everything that is wrong with it.
    Invalid(Vec<Problem>),
    /// It asks for so many legs.
    TooMany(usize),
}

/// Number of legs that a query asks for, whatever they are.
fn legs_asked_for(fields: &Fields<'_>) -> usize {
    let length = |name| fields.raw(name).and_then(|list| list.length()).unwrap_or(0);
    let attitudes = length("attitudes");
    let matrix = attitudes.saturating_mul(attitudes.saturating_sub(1));
    matrix.max(length("pairs"))
}

fn read_base(fields: &Fields<'_>) -> ScenarioSpec {
    ScenarioSpec {
        spacecraft: fields
            .required("spacecraft")
            .map_or_else(spacecraft::substitute, |cursor| spacecraft::read(&cursor)),
        start: fields
            .optional("start")
            .map(|cursor| scenario::state(&cursor))
            .unwrap_or_default(),
        options: fields
            .optional("options")
            .map(|cursor| scenario::options(&cursor))
            .unwrap_or_default(),
        ..ScenarioSpec::default()
    }
}

fn kind_and_mode(fields: &Fields<'_>) -> (LegKind, bool) {
    let kinds = [LegKind::RestToRest, LegKind::LowerBound, LegKind::Certified]
        .map(|kind| (kind.into(), kind));
    let kind = fields.optional("kind").and_then(|text| text.choice(&kinds));
    let modes = [("cached_only", false), ("compute", true)];
    let compute = fields.optional("mode").and_then(|text| text.choice(&modes));
    (
        kind.unwrap_or(LegKind::RestToRest),
        compute.unwrap_or(false),
    )
}

fn read_places(fields: &Fields<'_>) -> Option<Places> {
    let axes = fields
        .optional("zero_rate_axes")
        .and_then(|axes| scenario::zero_rate_axes(&axes));
    let target = |(index, attitude): (usize, AttitudeSpec)| TargetSpec {
        id: index.to_string(),
        attitude,
        zero_rate_axes: axes,
        ..TargetSpec::default()
    };
    let ((attitudes, pointers), all_pairs) =
        match (fields.optional("attitudes"), fields.optional("pairs")) {
            (Some(list), None) => (read_list(&list)?, true),
            (None, Some(list)) => (read_pairs(&list)?, false),
            (Some(both), Some(_)) => {
                both.report(
                    Code::ConflictingFields,
                    "both attitudes and pairs are given",
                    "give attitudes for the full matrix, or pairs",
                );
                return None;
            }
            (None, None) => {
                fields.required("attitudes");
                return None;
            }
        };
    let targets = attitudes.into_iter().enumerate().map(target).collect();
    Some(Places {
        targets,
        pointers,
        all_pairs,
    })
}

fn read_list(list: &Cursor<'_>) -> Option<(Vec<AttitudeSpec>, Vec<String>)> {
    let items = list.each(|place| (attitude::read(place), place.pointer().to_owned()))?;
    if items.len() < 2 {
        let message = format!("{} attitudes have no leg between them", items.len());
        list.report(Code::WrongLength, message, "list at least two attitudes");
        return None;
    }
    Some(items.into_iter().unzip())
}

fn read_pairs(list: &Cursor<'_>) -> Option<(Vec<AttitudeSpec>, Vec<String>)> {
    let ends = |pair: &Cursor<'_>| {
        let fields = pair.object(&["from", "to"]);
        ["from", "to"].map(|name| {
            let end = fields.as_ref().and_then(|fields| fields.required(name));
            let pointer = format!("{}/{name}", pair.pointer());
            (
                end.map(|end| attitude::read(&end)).unwrap_or_default(),
                pointer,
            )
        })
    };
    let pairs = list.each(ends)?;
    if pairs.is_empty() {
        list.report(
            Code::WrongLength,
            "there is no pair",
            "list at least one pair",
        );
        return None;
    }
    Some(pairs.into_iter().flatten().unzip())
}

/// A scenario with all attitudes as targets, or what is wrong with spacecraft and attitudes, or keeps
/// the wheels from holding a rest.
fn check(base: &ScenarioSpec, places: &Places) -> Result<Scenario, Vec<Problem>> {
    let spec = ScenarioSpec {
        targets: places.targets.clone(),
        ..base.clone()
    };
    let problems = match Scenario::try_new(&spec) {
        Ok(valid) => {
            let problems = planner::feasibility_problems(&valid.scenario);
            if problems.is_empty() {
                return Ok(valid.scenario);
            }
            problems
        }
        Err(problems) => problems,
    };
    Err(problems
        .into_iter()
        .map(|problem| moved(problem, &places.pointers))
        .collect())
}

/// A problem of a scenario's target with a pointer into the query.
fn moved(problem: Problem, pointers: &[String]) -> Problem {
    let place = problem.pointer.strip_prefix("/targets/").and_then(|rest| {
        let (index, rest) = rest.split_once('/').unwrap_or((rest, ""));
        let inside = rest.strip_prefix("attitude").unwrap_or("");
        Some(format!(
            "{}{inside}",
            pointers.get(index.parse::<usize>().ok()?)?
        ))
    });
    match place {
        Some(pointer) => Problem { pointer, ..problem },
        None => problem,
    }
}

/// The answer to a query.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegAnswers)]
pub(crate) struct LegAnswersDocument {
    /// `rest_to_rest`, `lower_bound` or `certified`.
    pub(crate) kind: &'static str,
    /// SHA-256 of the canonical text of the spacecraft; `null` when no leg is known.
    pub(crate) spacecraft_key: Option<String>,
    /// One entry for every leg, in the order of the query.
    pub(crate) legs: Vec<LegAnswerDocument>,
}

/// The answer for one leg.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegAnswer)]
pub(crate) struct LegAnswerDocument {
    /// Position in `attitudes` of the begin, or position of the pair.
    pub(crate) from: usize,
    /// Position in `attitudes` of the end, or position of the pair.
    pub(crate) to: usize,
    /// Minimum time, s; `null` when it is not known, and for `certified`, which solves nothing.
    pub(crate) duration_s: Option<Number>,
    /// No slew between these attitudes under the conditions of the kind takes less, s, proved, for
    /// `certified` those of `rest_to_rest`; `null` where nothing is proved or nothing is known.
    pub(crate) certified_lower_bound_s: Option<Number>,
    /// How the solve ended (for `certified`: `proved`, or `none` without a bound); `null` when it was
    /// not tried.
    pub(crate) status: Option<String>,
    /// Where the time comes from.
    pub(crate) source: Source,
    /// Key of the cached leg; `null` when it is not stored.
    pub(crate) key: Option<String>,
}

/// Where a leg time comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[schema(as = LegSource)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Source {
    /// It was known.
    Cached,
    /// It was solved for this query.
    Computed,
    /// It is not known.
    Missing,
}
