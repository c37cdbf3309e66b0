//! Reading a query for leg times.

use super::document::Node;
use super::reader::{Cursor, Sink};
use slewplan_solver::model::epoch;
use slewplan_solver::model::input::{
    InputForm, InputPlace, UpTo, input_choice, input_object, optional, or, required_or,
};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    ConeSpec, MAX_CONES, OptionsSpec, OrientationSpec, RateAxes, ReferenceFrame, ScenarioSpec,
    SpacecraftOrReference, SpacecraftSpec, StateSpec, TargetSpec, TimeSystem,
};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::order::Place;
use slewplan_solver::tour::planner;

input_object! {
    /// A query for leg times: of `attitudes` and `pairs` exactly one.
    pub(crate) struct LegQuerySpec as "LegQueryBody" {
        /// Epoch of time zero in the time system, which says where the Sun is.
        epoch: Option<String> = optional().pattern(epoch::PATTERN),
        /// Time system of the epoch, UTC without it.
        time_system: Option<TimeSystem> = optional(),
        /// Reference frame of all attitudes and directions, EME2000 without it.
        reference_frame: Option<ReferenceFrame> = optional(),
        /// The spacecraft.
        spacecraft: SpacecraftSpec as SpacecraftOrReference
            = required_or(SpacecraftSpec::substitute()),
        /// The state whose momentum is conserved; at rest without it.
        start: StateSpec = or(StateSpec::default()),
        /// Options of a scenario; those about the search do not matter.
        options: OptionsSpec = or(OptionsSpec::default()),
        /// For `lower_bound`: which rate components vanish at both ends; all without it.
        zero_rate_axes: Option<[bool; 3]> as Option<RateAxes> = optional(),
        /// Cones in which a boresight must not point: along legs those that apply `always`, at their ends
        /// those `at_targets` too. `report` changes nothing. Cones do not change what is `certified`.
        keep_out: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// Cones in which a boresight must point; likewise.
        keep_in: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// The legs between all of these, both directions.
        attitudes: Option<Vec<OrientationSpec>> = optional().min_length(2),
        /// The legs of these pairs.
        pairs: Option<Vec<LegEndsSpec>> = optional().min_length(1),
        /// The conditions at the two ends; `rest_to_rest` without it. `certified` asks for proved bounds
        /// of the rest-to-rest times only: they are computed, in `compute`, without solving any slew, and
        /// not stored.
        kind: LegKind = or(LegKind::RestToRest),
        /// Whether unknown legs are solved; `cached_only` without it.
        mode: LegQueryMode = or(LegQueryMode::CachedOnly),
    }
}

input_object! {
    /// From one attitude, or pointed boresight, to another.
    struct LegEndsSpec as "LegEnds" {
        /// Where the leg begins.
        from: OrientationSpec = required_or(OrientationSpec::default()),
        /// Where the leg ends.
        to: OrientationSpec = required_or(OrientationSpec::default()),
    }
}

input_choice! {
    /// What is done about legs that are not stored.
    enum LegQueryMode as "Mode" {
        /// They are reported as missing.
        CachedOnly = "cached_only",
        /// They are solved.
        Compute = "compute",
    }
}

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
    pub(crate) pairs: PairList,
}

/// Maximum number of legs of a table: those of 1,000 attitudes.
pub(crate) const MAX_LEGS: usize = 1_000_000;

/// The legs of a query in their order.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PairList {
    /// From each of so many attitudes to each other.
    Matrix(usize),
    /// So many pairs.
    Pairs(usize),
}

impl PairList {
    /// Number of legs.
    pub(crate) fn len(self) -> usize {
        match self {
            Self::Matrix(attitudes) => attitudes * attitudes.saturating_sub(1),
            Self::Pairs(pairs) => pairs,
        }
    }

    /// The leg at a position.
    pub(crate) fn get(self, position: usize) -> Pair {
        match self {
            Self::Matrix(attitudes) => {
                let others = attitudes.saturating_sub(1).max(1);
                let (from, to) = (position / others, position % others);
                let to = to + usize::from(to >= from);
                Pair {
                    from,
                    to,
                    targets: (from, to),
                }
            }
            Self::Pairs(_) => Pair {
                from: position,
                to: position,
                targets: (2 * position, 2 * position + 1),
            },
        }
    }

    /// The legs of a part of the list.
    pub(crate) fn part(self, first: usize, legs: usize) -> Vec<Pair> {
        let end = self.len().min(first + legs);
        (first..end).map(|position| self.get(position)).collect()
    }
}

/// A leg that is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pair {
    /// Position of the begin: in `attitudes`, or of the pair in `pairs`.
    pub(crate) from: usize,
    /// Position of the end.
    pub(crate) to: usize,
    /// The targets of the query's scenario between which the leg is.
    pub(crate) targets: (usize, usize),
}

impl Pair {
    /// The places of the query's scenario between which the leg is.
    pub(crate) fn places(&self) -> (Place, Place) {
        let (from, to) = self.targets;
        (Place::Target(from), Place::Target(to))
    }
}

/// The attitudes of a query, and where they stand in it.
struct QueriedAttitudes {
    targets: Vec<TargetSpec>,
    pointers: Vec<String>,
    /// Whether every ordered pair is asked for, or each attitude with an even index with its
    /// successor.
    all_pairs: bool,
}

impl QueriedAttitudes {
    /// The places of a query of the right shape.
    fn of(spec: &LegQuerySpec) -> Self {
        let pairs = spec.pairs.iter().flatten();
        let ends = pairs.enumerate().flat_map(|(i, pair)| {
            [("from", &pair.from), ("to", &pair.to)]
                .map(|(end, attitude)| (format!("/pairs/{i}/{end}"), attitude))
        });
        let attitudes = spec.attitudes.iter().flatten().enumerate();
        let listed = attitudes.map(|(i, attitude)| (format!("/attitudes/{i}"), attitude));
        let (pointers, attitudes): (Vec<String>, Vec<_>) = listed.chain(ends).unzip();
        // Messages name targets by their identifiers.
        let target = |(id, orientation): (&String, &OrientationSpec)| {
            let (attitude, pointing) = orientation.clone().into_members();
            TargetSpec {
                id: id.clone(),
                attitude,
                pointing,
                zero_rate_axes: spec.zero_rate_axes,
                ..TargetSpec::default()
            }
        };
        Self {
            targets: pointers.iter().zip(attitudes).map(target).collect(),
            pointers,
            all_pairs: spec.attitudes.is_some(),
        }
    }

    /// The legs between them.
    fn pairs(&self) -> PairList {
        let count = self.targets.len();
        if self.all_pairs {
            PairList::Matrix(count)
        } else {
            PairList::Pairs(count / 2)
        }
    }
}

/// Reads a query for at most [`MAX_LEGS`].
///
/// # Errors
///
/// Everything that is wrong with it, or, as a number, how many legs it asks for.
pub(crate) fn read(node: &Node) -> Result<LegQuery, Refusal> {
    // Counted before they are read, since a short list of attitudes has many pairs.
    let count = legs_asked_for(node);
    if count > MAX_LEGS {
        return Err(Refusal::TooMany(count));
    }
    let spec = decode(node).map_err(Refusal::Invalid)?;
    build(&spec).map_err(Refusal::Invalid)
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
fn legs_asked_for(node: &Node) -> usize {
    let attitudes = listed(node, "attitudes").unwrap_or(0);
    let matrix = attitudes.saturating_mul(attitudes.saturating_sub(1));
    matrix.max(listed(node, "pairs").unwrap_or(0))
}

/// Number of entries of a list of a query, readable or not.
fn listed(node: &Node, name: &str) -> Option<usize> {
    match node.member(name)? {
        Node::List(entries) => Some(entries.len()),
        _ => None,
    }
}

/// A query of the right shape.
fn decode(node: &Node) -> Result<LegQuerySpec, Vec<Problem>> {
    let sink = Sink::default();
    let root = Cursor::root(node, &sink);
    let spec = LegQuerySpec::read(&root);
    check_lists(node, &root);
    let problems = sink.into_problems();
    spec.filter(|_| problems.is_empty()).ok_or(problems)
}

/// Of attitudes and pairs exactly one is given, and there is a leg in it.
fn check_lists(node: &Node, root: &Cursor<'_>) {
    let given = |name| root.member(name).filter(|list| !list.is_null());
    match (given("attitudes"), given("pairs")) {
        (Some(both), Some(_)) => both.report(
            Code::ConflictingFields,
            "both attitudes and pairs are given",
            "give attitudes for the full matrix, or pairs",
        ),
        (None, None) => {
            // Tells that it is missing, or that null is no list.
            root.required("attitudes").and_then(|null| null.entries());
        }
        (Some(list), None) => {
            if let Some(few @ ..2) = listed(node, "attitudes") {
                let message = format!("{few} attitudes have no leg between them");
                list.report(Code::WrongLength, message, "list at least two attitudes");
            }
        }
        (None, Some(list)) => {
            if listed(node, "pairs") == Some(0) {
                let hint = "list at least one pair";
                list.report(Code::WrongLength, "there is no pair", hint);
            }
        }
    }
}

/// A valid query.
fn build(spec: &LegQuerySpec) -> Result<LegQuery, Vec<Problem>> {
    let places = QueriedAttitudes::of(spec);
    let scenario = check(spec, &places)?;
    Ok(LegQuery {
        kind: spec.kind,
        compute: spec.mode == LegQueryMode::Compute,
        pairs: places.pairs(),
        scenario,
    })
}

/// A scenario with all attitudes as targets, or what is wrong with spacecraft, attitudes and
/// cones, or keeps the wheels from holding a rest.
fn check(query: &LegQuerySpec, places: &QueriedAttitudes) -> Result<Scenario, Vec<Problem>> {
    let spec = ScenarioSpec {
        epoch: query.epoch.clone(),
        time_system: query.time_system,
        reference_frame: query.reference_frame,
        spacecraft: query.spacecraft.clone(),
        start: query.start.clone(),
        targets: places.targets.clone(),
        keep_out: query.keep_out.clone(),
        keep_in: query.keep_in.clone(),
        options: query.options.clone(),
        ..ScenarioSpec::default()
    };
    let problems = match Scenario::try_new(&spec) {
        Ok(valid) => {
            let mut problems = planner::feasibility_problems(&valid.scenario);
            problems.retain(|problem| !is_of_start(problem));
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

/// Whether a cone is violated at the start, from which no leg leads.
fn is_of_start(problem: &Problem) -> bool {
    problem.code == Code::AttitudeViolatesCone && problem.pointer == "/start"
}

/// A problem of a scenario's target with a pointer into the query.
fn moved(problem: Problem, pointers: &[String]) -> Problem {
    let place = problem.pointer.strip_prefix("/targets/").and_then(|rest| {
        let (index, rest) = rest.split_once('/').unwrap_or((rest, ""));
        // An attitude stands at the place itself, a pointing in a member there.
        let inside = match rest.strip_prefix("attitude") {
            Some(inside) => inside.to_owned(),
            None if rest.starts_with("pointing") => format!("/{rest}"),
            None => String::new(),
        };
        let place = pointers.get(index.parse::<usize>().ok()?)?;
        Some(format!("{place}{inside}"))
    });
    match place {
        Some(pointer) => Problem { pointer, ..problem },
        None => problem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_lists_every_ordered_pair_once_and_in_order() {
        let matrix = PairList::Matrix(5);
        let listed: Vec<_> = (0..matrix.len()).map(|i| matrix.get(i).targets).collect();
        let from_each = (0..5).flat_map(|from| (0..5).map(move |to| (from, to)));
        let expected: Vec<_> = from_each.filter(|(from, to)| from != to).collect();
        assert_eq!(listed, expected);
        assert_eq!(matrix.part(18, 5), [matrix.get(18), matrix.get(19)]);
        assert_eq!(PairList::Pairs(3).get(2).targets, (4, 5));
        assert_eq!(PairList::Matrix(1).len(), 0);
    }
}
