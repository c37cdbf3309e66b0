//! Solves legs between places, one by one and in tables.
//!
//! Pairs of places are reduced to canonical legs first. Equal problems are solved once: within a
//! table, between the tables of one solve and, through the store, between solves.

mod solving;
mod stopping;

use super::Run;
use super::bounds_by_form::BoundsByForm;
use super::canonical::{CanonicalForm, CanonicalLeg, missing_from};
use super::from_store::{leg_from_store, stored_leg};
use super::legs_ahead::{LegsAhead, offer};
use super::places::Places;
use super::tables::{CertifiedLeg, SolvedLeg, SolvedTable, Table, TabulatedLeg};
use super::verified::flight_faults;
use crate::leg::multiphase::LegSolution;
use crate::leg::solve::around_cones::is_clear;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::run::contradiction::{Contradiction, refutes};
use crate::run::progress::{Progress, Stage};
use crate::run::stop::{StopReason, StopSignal};
use crate::tour::legs::{LegKind, SegmentStore, StoredLeg};
use crate::tour::order::Place;
use solving::solve;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Solves canonical legs and keeps them for the tables and tours of one solve.
pub(super) struct LegSolver<'a> {
    places: &'a Places<'a>,
    run: Run<'a>,
    stop: &'a StopSignal,
    /// By [`CanonicalLeg::key`].
    known: Mutex<HashMap<String, Arc<SolvedLeg>>>,
    certified: BoundsByForm,
    /// Number of legs solved.
    solved: AtomicU64,
    /// Number of legs taken from the store.
    from_store: AtomicU64,
    /// Number of NLPs solved for legs.
    nlp_solves: AtomicU64,
    /// Number of certified bounds that a flight has contradicted.
    contradictions: AtomicU64,
}

impl<'a> LegSolver<'a> {
    pub(super) fn new(places: &'a Places<'a>, run: Run<'a>, stop: &'a StopSignal) -> Self {
        Self {
            places,
            run,
            stop,
            known: Mutex::default(),
            certified: BoundsByForm::default(),
            solved: AtomicU64::new(0),
            from_store: AtomicU64::new(0),
            nlp_solves: AtomicU64::new(0),
            contradictions: AtomicU64::new(0),
        }
    }

    /// The places whose legs are solved.
    pub(super) fn places(&self) -> &'a Places<'a> {
        self.places
    }

    /// The store of tour segments.
    pub(super) fn segments(&self) -> &'a dyn SegmentStore {
        self.run.segments
    }

    /// Reports that work has begun.
    pub(super) fn report_begin(&self) {
        self.report_bounds(None, None);
    }

    /// Reports the duration of a first tour and a lower bound on all tours, s, where they are known.
    pub(super) fn report_bounds(&self, incumbent_s: Option<f64>, lower_bound_s: Option<f64>) {
        self.run.observer.progress(Progress {
            incumbent_s,
            lower_bound_s,
            ..Progress::of_stage(Stage::Legs, 0, None)
        });
    }

    fn report_progress(&self, done: u64, total: Option<u64>) {
        let progress = Progress::of_stage(Stage::Legs, done, total);
        self.run.observer.progress(progress);
    }

    /// Numbers of legs solved, of legs from the store, and of NLPs.
    pub(super) fn work(&self) -> [u64; 3] {
        [&self.solved, &self.from_store, &self.nlp_solves].map(|count| count.load(Relaxed))
    }

    /// Counts the NLP of a leg that is not kept.
    pub(super) fn count_solve(&self) {
        self.nlp_solves.fetch_add(1, Relaxed);
    }

    /// Reports a contradiction. From now on no certified bound is trusted.
    pub(super) fn contradicted(&self, contradiction: &Contradiction) {
        self.contradictions.fetch_add(1, Relaxed);
        self.run.observer.contradicted(contradiction);
    }

    /// Whether no flight has contradicted a certified bound so far.
    pub(super) fn bounds_are_trusted(&self) -> bool {
        self.contradictions.load(Relaxed) == 0
    }

    /// Offers the legs of a kind between pairs of places to others, which are going to be solved here next.
    pub(super) fn offer(&self, kind: LegKind, pairs: &[(Place, Place)]) {
        if self.run.legs.is_shared() {
            let canonical = self.all_canonical(kind, pairs);
            let missing = missing_from(&lock(&self.known), &canonical);
            offer(self.run.legs, kind, pairs, &missing);
        }
    }

    /// Solves the legs of a kind between pairs of places; `None` for legs not reached before the stop
    /// signal.
    pub(super) fn solved_legs(
        &self,
        kind: LegKind,
        pairs: &[(Place, Place)],
    ) -> Vec<Option<TabulatedLeg>> {
        let tell = |done, total| self.report_progress(done, Some(total));
        let mut canonical = self.all_canonical(kind, pairs);
        self.solve_missing(kind, &canonical, tell);
        if !self.places.with_cones.cones.is_empty() {
            let legs: Vec<_> = pairs.iter().zip(&canonical).collect();
            let around = self.run.pool.map(&legs, |(pair, canonical)| {
                let free = self.known(pair.0, canonical.as_ref()?)?;
                self.around_cones(kind, **pair, &free)
            });
            self.solve_missing(kind, &around, tell);
            for (leg, around) in canonical.iter_mut().zip(around) {
                *leg = around.or(leg.take());
            }
        }
        self.tabulated(&canonical)
    }

    /// The same without cones, and without reports of progress: for use after the stage of the legs.
    pub(super) fn table_without_cones(
        &self,
        kind: LegKind,
        pairs: &[(Place, Place)],
    ) -> SolvedTable {
        let canonical = self.all_canonical(kind, pairs);
        self.solve_missing(kind, &canonical, |_, _| {});
        let legs = self.tabulated(&canonical);
        Table::new(self.places, pairs.iter().copied().zip(legs))
    }

    /// Legs as far as they are known.
    fn tabulated(&self, canonical: &[Option<CanonicalLeg>]) -> Vec<Option<TabulatedLeg>> {
        let known = lock(&self.known);
        let entry = |canonical: &Option<CanonicalLeg>| {
            let canonical = canonical.as_ref()?;
            Some(TabulatedLeg {
                leg: Arc::clone(known.get(canonical.key())?),
                mirrored: canonical.mirrored,
            })
        };
        canonical.iter().map(entry).collect()
    }

    /// The leg of a kind between two places, solved if it is not known.
    pub(super) fn leg(&self, kind: LegKind, from: Place, to: Place) -> LegSolution {
        let free = self.known_or_solved(
            kind,
            from,
            &self.canonical(kind, (from, to), CanonicalLeg::of),
        );
        self.around_cones(kind, (from, to), &free)
            .map_or(free, |around| self.known_or_solved(kind, from, &around))
    }

    /// A known leg that begins at a place.
    fn known(&self, from: Place, canonical: &CanonicalLeg) -> Option<LegSolution> {
        let leg = lock(&self.known).get(canonical.key()).cloned();
        let leg = leg.filter(|leg| !leg.is_condensed)?;
        Some(self.placed(from, leg, canonical.mirrored))
    }

    /// A leg that begins at a place, solved if it is not known.
    fn known_or_solved(&self, kind: LegKind, from: Place, canonical: &CanonicalLeg) -> LegSolution {
        self.known(from, canonical).unwrap_or_else(|| {
            let stored = self.load(canonical);
            let from_store = stored.is_some();
            let leg = Arc::new(stored.unwrap_or_else(|| self.solve(kind, canonical)));
            self.keep(canonical, &leg, from_store);
            self.placed(from, leg, canonical.mirrored)
        })
    }

    fn placed(&self, from: Place, leg: Arc<SolvedLeg>, mirrored: bool) -> LegSolution {
        let leg = TabulatedLeg { leg, mirrored };
        leg.beginning_at(&self.places.waypoint(from).attitude)
    }

    /// The leg with cones, where the one without them enters a cone.
    fn around_cones(
        &self,
        kind: LegKind,
        (from, to): (Place, Place),
        free: &LegSolution,
    ) -> Option<CanonicalLeg> {
        // After the stop signal too: a leg that is not solved is missing, one through a cone is wrong.
        if free.duration().is_none() || is_clear(&self.places.with_cones, &free.profile) {
            return None;
        }
        let [from, to] = [from, to].map(|place| end_of(self.places, kind, place));
        let around = CanonicalLeg::around_cones(self.places, &from, &to);
        Some(around.knowing(free, [&from, &to]))
    }

    /// Certified bounds on the legs of a kind between pairs of places; no leg is solved. `None` for
    /// pairs not reached before the stop signal.
    pub(super) fn certified_legs(
        &self,
        kind: LegKind,
        pairs: &[(Place, Place)],
    ) -> Vec<Option<CertifiedLeg>> {
        let canonical = self.all_canonical(kind, pairs);
        let bound =
            |_, leg: &CanonicalLeg| (!self.stop.is_set()).then(|| certify(self.places, leg));
        self.certified.of(&canonical, self.run.pool, |_| (), bound)
    }

    /// The leg of a kind between two places in a canonical form.
    pub(super) fn canonical(
        &self,
        kind: LegKind,
        (from, to): (Place, Place),
        form: CanonicalForm,
    ) -> CanonicalLeg {
        let [from, to] = [from, to].map(|place| end_of(self.places, kind, place));
        form(self.places, &from, &to)
    }

    /// The canonical legs of many pairs; `None` for pairs not reached before the stop signal.
    pub(super) fn all_canonical(
        &self,
        kind: LegKind,
        pairs: &[(Place, Place)],
    ) -> Vec<Option<CanonicalLeg>> {
        self.run.pool.map_short(pairs.to_vec(), |(from, to)| {
            (!self.is_abandoned()).then(|| self.canonical(kind, (from, to), CanonicalLeg::of))
        })
    }

    /// Their identities alone, without the cones that the scenario enforces or with them, whether or not the legs
    /// without them are clear.
    pub(super) fn identities(
        &self,
        kind: LegKind,
        pairs: &[(Place, Place)],
        form: CanonicalForm,
    ) -> Vec<Option<String>> {
        self.run.pool.map_short(pairs.to_vec(), |pair| {
            (!self.is_abandoned()).then(|| self.canonical(kind, pair, form).identity)
        })
    }

    /// Whether the leg without cones is known, and clear of all that the scenario enforces.
    pub(super) fn has_clear_leg(&self, kind: LegKind, (from, to): (Place, Place)) -> bool {
        let canonical = self.canonical(kind, (from, to), CanonicalLeg::of);
        let stored = self.load(&canonical).map(Arc::new);
        let leg = stored.map(|leg| self.placed(from, leg, canonical.mirrored));
        leg.is_some_and(|leg| is_clear(&self.places.with_cones, &leg.profile))
    }

    /// Whether the solve is cancelled or out of time, so that not even stored legs are of use.
    /// After a request for the best plan so far they still are.
    fn is_abandoned(&self) -> bool {
        let reason = self.stop.reason();
        reason.is_some_and(|reason| reason != StopReason::Requested)
    }

    fn solve_missing(
        &self,
        kind: LegKind,
        canonical: &[Option<CanonicalLeg>],
        tell: impl Fn(u64, u64) + Sync,
    ) {
        let missing = missing_from(&lock(&self.known), canonical);
        let done = AtomicU64::new(0);
        let total = missing.len() as u64;
        let legs: Vec<_> = missing.into_iter().map(|(_, leg)| leg).collect();
        let ahead = LegsAhead::new(self.run.legs, &legs);
        // In the order of the list, whichever worker is free: others may solve its end.
        let next = AtomicUsize::new(0);
        self.run.pool.map(&legs, |_| {
            let place = next.fetch_add(1, Relaxed);
            let leg = legs[place];
            // With thousands of legs, store look-ups alone would delay the stop noticeably.
            if self.is_abandoned() {
                return;
            }
            if !self.keep_stored(&ahead, place, leg) && !self.stop.is_set() {
                self.keep(leg, &Arc::new(self.solve(kind, leg)), false);
            }
            tell(done.fetch_add(1, Relaxed) + 1, total);
        });
    }

    /// Takes legs from the store in as few look-ups as it allows; what it lacks stays unknown.
    pub(super) fn load_all(&self, kind: LegKind, pairs: &[(Place, Place)]) {
        let canonical = self.all_canonical(kind, pairs);
        let missing = missing_from(&lock(&self.known), &canonical);
        let legs: Vec<_> = missing.into_iter().map(|(_, leg)| leg).collect();
        let ahead = LegsAhead::new(self.run.legs, &legs);
        for (place, leg) in legs.iter().enumerate() {
            if self.is_abandoned() {
                return;
            }
            self.keep_stored(&ahead, place, leg);
        }
    }

    /// Keeps a leg at a place of a list if the store has it; whether it has.
    fn keep_stored(&self, ahead: &LegsAhead<'_>, place: usize, leg: &CanonicalLeg) -> bool {
        let row = ahead.take(place);
        let Some(stored) = row.and_then(|row| self.verified(leg, row)) else {
            return false;
        };
        self.keep(leg, &Arc::new(stored), true);
        true
    }

    /// A leg from the store, if its motion passes verification.
    fn load(&self, leg: &CanonicalLeg) -> Option<SolvedLeg> {
        self.verified(leg, self.run.legs.get(&leg.identity)?)
    }

    /// A stored leg, if its motion passes verification. A bound that the store does not vouch for is
    /// computed again.
    fn verified(&self, leg: &CanonicalLeg, row: StoredLeg) -> Option<SolvedLeg> {
        let unproved = row.certified_lower_bound_s.is_none().then(|| row.clone());
        let mut stored = leg_from_store(leg, row)?;
        let faults = flight_faults(self.places, leg, &stored.solution.profile);
        if !faults.is_empty() {
            let identity = leg.identity.clone();
            self.run
                .observer
                .contradicted(&Contradiction::StoredLeg { identity, faults });
            return None;
        }
        if let Some(row) = unproved {
            self.prove_stored(leg, row, &mut stored);
        }
        self.compare_with_bound(leg, &mut stored);
        Some(stored)
    }

    /// Computes the certified bound of a leg that is stored without one, or with one of another
    /// version, and stores it.
    fn prove_stored(&self, leg: &CanonicalLeg, row: StoredLeg, solved: &mut SolvedLeg) {
        let known = self.certified.known(leg);
        let bound = known.unwrap_or_else(|| certify(self.places, leg));
        solved.certified = bound.lower_bound;
        if bound.lower_bound.is_some() {
            let certified_lower_bound_s = bound.lower_bound;
            let proved = StoredLeg {
                certified_lower_bound_s,
                ..row
            };
            self.run.legs.put(&leg.identity, &proved);
        }
    }

    /// Drops the certified bound of a leg whose duration is below it, and reports the
    /// contradiction.
    fn compare_with_bound(&self, leg: &CanonicalLeg, solved: &mut SolvedLeg) {
        let Some((bound_s, solved_s)) = solved.certified.zip(solved.solution.duration()) else {
            return;
        };
        if refutes(solved_s, bound_s) {
            self.contradicted(&Contradiction::Leg {
                identity: leg.identity.clone(),
                bound_s,
                duration_s: solved_s,
            });
            solved.certified = None;
        }
    }

    /// Solves a leg, and stores it.
    fn solve(&self, kind: LegKind, leg: &CanonicalLeg) -> SolvedLeg {
        let bound = self.certified.known(leg);
        let mut fresh = solve(self.places, leg, bound, self.stop);
        self.compare_with_bound(leg, &mut fresh);
        if fresh.solution.status == NlpStatus::Converged && !self.stop.is_set() {
            // Stored at once, so that a killed process loses little work. A stopped solve may have
            // skipped starts, and its leg is not stored.
            self.run
                .legs
                .put(&leg.identity, &stored_leg(leg, kind, &fresh));
        }
        fresh
    }

    /// Whether hardly anybody will ask for the motion of a leg: between two of many places that leave
    /// something free it is part of longer motions, which do not begin with it. Who asks for it has it
    /// loaded or solved again, with the same result.
    fn is_condensable(&self, leg: &CanonicalLeg) -> bool {
        let is_free = |end: &Waypoint| !end.is_fixed(&leg.dynamics);
        !self.places.needs_all_legs()
            && self.places.with_cones.cones.is_empty()
            && is_free(&leg.from)
            && is_free(&leg.to)
    }

    /// Keeps a leg for this solve unless its solve was interrupted.
    fn keep(&self, leg: &CanonicalLeg, solved: &Arc<SolvedLeg>, from_store: bool) {
        if solved.solution.status.is_interrupted() {
            return;
        }
        if from_store {
            self.from_store.fetch_add(1, Relaxed);
        } else {
            self.solved.fetch_add(1, Relaxed);
            self.nlp_solves.fetch_add(solved.solves, Relaxed);
        }
        let kept = if self.is_condensable(leg) {
            Arc::new(solved.condensed())
        } else {
            Arc::clone(solved)
        };
        lock(&self.known).insert(leg.key().to_owned(), kept);
    }
}

fn lock<T>(remembered: &Mutex<HashMap<String, T>>) -> MutexGuard<'_, HashMap<String, T>> {
    // A panic under the lock leaves the map consistent.
    remembered.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The waypoint of a place in a leg of this kind.
pub(super) fn end_of(places: &Places<'_>, kind: LegKind, place: Place) -> Waypoint {
    match kind {
        LegKind::RestToRest | LegKind::Certified => places.at_rest(place),
        LegKind::LowerBound => places.waypoint(place),
    }
}

/// Computes the certified bound of a leg.
pub(super) fn certify(places: &Places<'_>, leg: &CanonicalLeg) -> CertifiedLeg {
    let begin = Instant::now();
    CertifiedLeg {
        lower_bound: places
            .certified
            .leg(&leg.from, &leg.to, &leg.dynamics.momentum),
        solve_time: begin.elapsed().as_secs_f64(),
    }
}

#[cfg(test)]
mod tests;
