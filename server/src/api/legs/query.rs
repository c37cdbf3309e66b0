//! `POST /v1/legs/query`: leg times between attitudes.

use super::super::access::Caller;
use super::super::describe::{self, BodyErrors, LegQueryBody, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::JsonBody;
use super::super::{App, computing, stored};
use crate::base::contradictions::ContradictionObserver;
use crate::documents::leg_query::{
    self, LegAnswerDocument, LegAnswersDocument, LegQuery, Pair, Refusal, Source,
};
use crate::documents::number::Number;
use crate::store::leg_key;
use axum::Json;
use axum::extract::State;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, LegStore, NoStore, StoredLeg};
use slewplan_solver::tour::order::Place;
use slewplan_solver::tour::planner::{self, LegRow, Run};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::runtime::Handle;

/// Maximum number of legs of one query: the full matrix of 32 attitudes.
pub(in crate::api) const MAX_PAIRS: usize = 1000;

/// Query leg times
///
/// For pairs of attitudes, or the full matrix of a list. `cached_only` answers at once with the
/// cached legs; `compute` also solves the missing ones, for at most a minute. Legs of the kind
/// `certified` are only computed, without solving any slew, and not stored.
#[utoipa::path(
    post, path = "/v1/legs/query", tag = "legs", operation_id = "query_legs",
    request_body(content = LegQueryBody, examples(
        ("matrix" = (summary = "The full matrix of three attitudes",
            value = json!(describe::leg_matrix()))),
        ("pair" = (summary = "One leg, only if it is known",
            value = json!(describe::leg_pair()))),
    )),
    responses(
        (status = 200, description = "One answer for every leg", body = LegAnswersDocument),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Json<LegAnswersDocument>, ApiError> {
    let (node, _) = stored::write_out(&app, &caller, body.node, "").await?;
    let query = leg_query::read(&node, MAX_PAIRS).map_err(|refusal| match refusal {
        Refusal::Invalid(problems) => ApiError::input(problems),
        Refusal::TooMany(count) => {
            let detail = format!("{count} legs; the limit is {MAX_PAIRS} (max_leg_pairs)");
            ApiError::new(ErrorCode::TooManyPairs, detail)
        }
    })?;
    if !query.compute {
        let stop = StopSignal::new();
        stop.request();
        let answers =
            computing::at_once(&app, stop, computing::LONGEST, work(&app, query, false)).await;
        return answers.map(Json);
    }
    computing::in_turn(&app, computing::LONGEST, work(&app, query, true))
        .await
        .map(Json)
}

/// The work of a query.
fn work(
    app: &App,
    query: LegQuery,
    compute: bool,
) -> impl FnOnce(&StopSignal) -> LegAnswersDocument + Send + use<> {
    let cache = app.jobs().legs(Handle::current());
    let pool = Arc::clone(if compute { &app.0.pool } else { &app.0.lookups });
    move |stop| {
        let answers = answers(&query, &pool, stop, &cache);
        // Stores new legs before the answer names their keys.
        drop(cache);
        answers
    }
}

fn answers(
    query: &LegQuery,
    pool: &SolverPool,
    stop: &StopSignal,
    cache: &dyn LegStore,
) -> LegAnswersDocument {
    let answered = if query.kind == LegKind::Certified {
        certified(query, pool, stop)
    } else {
        pool.map(&query.pairs, |pair| answer(query, pair, pool, stop, cache))
    };
    let spacecraft_key = answered
        .iter()
        .find_map(|(_, spacecraft)| spacecraft.clone());
    LegAnswersDocument {
        kind: query.kind.into(),
        spacecraft_key,
        legs: answered.into_iter().map(|(leg, _)| leg).collect(),
    }
}

/// The answers for certified legs, computed together because they share the preparation of the
/// spacecraft.
fn certified(
    query: &LegQuery,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Vec<(LegAnswerDocument, Option<String>)> {
    let places: Vec<_> = query.pairs.iter().map(places).collect();
    let run = Run {
        pool,
        stop,
        observer: &ContradictionObserver,
        legs: &NoStore,
        segments: &NoStore,
    };
    let rows = planner::legs_between(&query.scenario, query.kind, &places, run);
    let answer = |(pair, row): (&Pair, Option<LegRow>)| {
        let source = row.as_ref().map_or(Source::Missing, |_| Source::Computed);
        (document(pair, row, source, None), None)
    };
    query.pairs.iter().zip(rows).map(answer).collect()
}

/// The places of the query's scenario between which a leg is.
fn places(pair: &Pair) -> (Place, Place) {
    let (from, to) = pair.targets;
    (Place::Target(from), Place::Target(to))
}

/// The answer for a leg and the key of its spacecraft.
fn answer(
    query: &LegQuery,
    pair: &Pair,
    pool: &SolverPool,
    stop: &StopSignal,
    cache: &dyn LegStore,
) -> (LegAnswerDocument, Option<String>) {
    let store = ObservedStore {
        cache,
        seen: Mutex::default(),
    };
    let run = Run {
        pool,
        stop,
        observer: &ContradictionObserver,
        legs: &store,
        segments: &NoStore,
    };
    let rows = planner::legs_between(&query.scenario, query.kind, &[places(pair)], run);
    let seen = store
        .seen
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    let row = rows.into_iter().flatten().next();
    let source = match (&row, &seen) {
        (Some(_), Some(seen)) if seen.found => Source::Cached,
        (Some(row), _) if row.duration_s.is_some() => Source::Computed,
        _ => Source::Missing,
    };
    let document = document(pair, row, source, seen.as_ref());
    (document, seen.map(|seen| seen.spacecraft))
}

fn document(
    pair: &Pair,
    row: Option<LegRow>,
    source: Source,
    seen: Option<&Seen>,
) -> LegAnswerDocument {
    LegAnswerDocument {
        from: pair.from,
        to: pair.to,
        duration_s: row.as_ref().and_then(|row| row.duration_s).map(Number),
        certified_lower_bound_s: row
            .as_ref()
            .and_then(|row| row.certified_lower_bound_s)
            .map(Number),
        status: row.map(|row| row.status),
        source,
        key: seen.map(|seen| seen.key.clone()),
    }
}

/// A leg store that records the last leg that the solver looked for, if it read or wrote it: where the
/// leg without cones enters one, the leg around it comes after it.
struct ObservedStore<'a> {
    cache: &'a dyn LegStore,
    seen: Mutex<Option<Seen>>,
}

struct Seen {
    key: String,
    spacecraft: String,
    found: bool,
}

impl Seen {
    fn of(identity: &str, leg: &StoredLeg, found: bool) -> Self {
        Self {
            key: leg_key(identity),
            spacecraft: leg_key(&leg.spacecraft),
            found,
        }
    }
}

impl ObservedStore<'_> {
    fn note(&self, seen: Option<Seen>) {
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = seen;
    }
}

impl LegStore for ObservedStore<'_> {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        let leg = self.cache.get(identity);
        let seen = leg.as_ref().map(|leg| Seen::of(identity, leg, true));
        self.note(seen);
        leg
    }

    fn put(&self, identity: &str, leg: &StoredLeg) {
        self.cache.put(identity, leg);
        self.note(Some(Seen::of(identity, leg, false)));
    }
}
