//! Times of many legs of one scenario, part by part: known ones from the store without their
//! motions, missing ones solved.

use super::canonical::{CanonicalForm, CanonicalLeg};
use super::legs::{LegSolver, certify};
use super::places::Places;
use super::tables::CertifiedLeg;
use super::unsolved::leg_status;
use super::{Run, limited};
use crate::model::scenario::Scenario;
use crate::nlp::NlpStatus;
use crate::run::contradiction::{Contradiction, refutes};
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegKind, StoredTime};
use crate::tour::order::Place;

/// The time of a leg.
#[derive(Debug, Clone, PartialEq)]
pub struct LegTime {
    /// Minimum time, s, when solved; never of [`LegKind::Certified`].
    pub duration_s: Option<f64>,
    /// Certified lower bound on the duration of any slew under these conditions, s; `None` where no
    /// bound is proved.
    pub certified_lower_bound_s: Option<f64>,
    /// Wall-clock time of the solve or of the bound, s.
    pub solve_time_s: f64,
    /// How the solve ended (`converged`, ...); for [`LegKind::Certified`] whether there is a bound
    /// (`proved`, `none`).
    pub status: &'static str,
    /// Whether the store knew it.
    pub from_store: bool,
    /// The key under which it is stored, when it is.
    pub key: Option<String>,
}

impl LegTime {
    fn stored(time: StoredTime) -> Self {
        Self {
            duration_s: Some(time.duration_s),
            certified_lower_bound_s: time.certified_lower_bound_s,
            solve_time_s: time.solve_time_s,
            // No others are stored.
            status: NlpStatus::Converged.into_str(),
            from_store: true,
            key: Some(time.key),
        }
    }
}

/// The times of the legs of one kind between the places of a scenario.
///
/// What the legs have in common is prepared once; nothing else is kept between two calls, so that a
/// table of any size can be worked out in parts.
pub struct LegTimeTable<'a> {
    places: Places<'a>,
    kind: LegKind,
    run: Run<'a>,
    stop: StopSignal,
}

impl<'a> LegTimeTable<'a> {
    /// Times of legs of a kind; the time limit of the scenario begins now.
    #[must_use]
    pub fn of(scenario: &'a Scenario, kind: LegKind, run: Run<'a>) -> Self {
        Self {
            places: Places::of(scenario),
            kind,
            run,
            stop: limited(scenario, run.stop),
        }
    }

    /// Identifier of a place: `start`, `end` or a target's identifier.
    #[must_use]
    pub fn name(&self, place: Place) -> String {
        self.places.name(place)
    }

    /// Canonical text of the spacecraft of the legs.
    #[must_use]
    pub fn spacecraft(&self) -> &str {
        self.places.head.spacecraft()
    }

    /// Whether it was asked to stop, or its time is up.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.is_set()
    }

    /// The legs between pairs of places that the store knows; `None` for all others, which are all of
    /// [`LegKind::Certified`].
    #[must_use]
    pub fn known(&self, pairs: &[(Place, Place)]) -> Vec<Option<LegTime>> {
        if self.kind == LegKind::Certified {
            return vec![None; pairs.len()];
        }
        if self.places.with_cones.cones.is_empty() {
            return self.stored(pairs, CanonicalLeg::of);
        }
        let mut times = self.stored(pairs, CanonicalLeg::around_cones);
        // Where none is stored with cones, the leg without them may be clear of all of them.
        let open = (0..pairs.len()).filter(|i| times[*i].is_none());
        let (open, asked): (Vec<usize>, Vec<_>) = open.map(|i| (i, pairs[i])).unzip();
        let free = self.stored(&asked, CanonicalLeg::of);
        let solver = self.solver();
        let found: Vec<_> = asked.into_iter().zip(free).collect();
        let clear = self.run.pool.map(&found, |(pair, time)| {
            let time = time.as_ref()?;
            solver.has_clear_leg(self.kind, *pair).then(|| time.clone())
        });
        for (place, time) in open.into_iter().zip(clear) {
            times[place] = time;
        }
        times
    }

    /// Offers the missing legs between pairs of places, which are going to be asked for next, to others, if
    /// the store of the legs is shared with any.
    pub fn offer(&self, pairs: &[(Place, Place)]) {
        if self.kind != LegKind::Certified {
            self.solver().offer(self.kind, pairs);
        }
    }

    /// All legs between pairs of places: the known ones, and the missing ones solved and stored. `None`
    /// for legs not reached before the stop signal.
    #[must_use]
    pub fn solved(&self, pairs: &[(Place, Place)]) -> Vec<Option<LegTime>> {
        let mut times = self.known(pairs);
        let missing = (0..pairs.len()).filter(|i| times[*i].is_none());
        let (missing, asked): (Vec<usize>, Vec<_>) = missing.map(|i| (i, pairs[i])).unzip();
        let fresh = if self.kind == LegKind::Certified {
            self.proved(&asked)
        } else {
            self.solved_now(&asked)
        };
        for (place, time) in missing.into_iter().zip(fresh) {
            times[place] = time;
        }
        times
    }

    fn solver(&self) -> LegSolver<'_> {
        LegSolver::new(&self.places, self.run, &self.stop)
    }

    /// The same with the motions of known legs read and verified again.
    #[must_use]
    pub fn verified(&self, pairs: &[(Place, Place)]) -> Vec<Option<LegTime>> {
        if self.kind == LegKind::Certified {
            return self.proved(pairs);
        }
        let legs = self.solver().solved_legs(self.kind, pairs);
        let legs: Vec<_> = pairs.iter().zip(legs).collect();
        // Where cones leave no way, finding out that they do takes as long as a solve.
        self.run.pool.map(&legs, |((from, to), leg)| {
            let leg = &leg.as_ref()?.leg;
            Some(LegTime {
                duration_s: leg.solution.duration(),
                certified_lower_bound_s: leg.certified,
                solve_time_s: leg.solve_time,
                status: leg_status(&self.places, [*from, *to], &leg.solution),
                from_store: leg.from_store,
                key: None,
            })
        })
    }

    fn solved_now(&self, pairs: &[(Place, Place)]) -> Vec<Option<LegTime>> {
        if pairs.is_empty() {
            return Vec::new();
        }
        let mut legs = self.verified(pairs);
        // What was solved is stored by now, under a key that the solved leg does not tell.
        for (leg, stored) in legs.iter_mut().zip(self.known(pairs)) {
            if let Some(leg) = leg {
                leg.key = stored.and_then(|stored| stored.key);
            }
        }
        legs
    }

    fn proved(&self, pairs: &[(Place, Place)]) -> Vec<Option<LegTime>> {
        let legs = self.solver().certified_legs(self.kind, pairs);
        let time = |leg: CertifiedLeg| LegTime {
            duration_s: None,
            certified_lower_bound_s: leg.lower_bound,
            solve_time_s: leg.solve_time,
            status: leg.lower_bound.map_or("none", |_| "proved"),
            from_store: false,
            key: None,
        };
        legs.into_iter().map(|leg| leg.map(time)).collect()
    }

    /// The stored times of the legs between pairs of places in their canonical form, in one look-up.
    fn stored(&self, pairs: &[(Place, Place)], form: CanonicalForm) -> Vec<Option<LegTime>> {
        let solver = self.solver();
        let identities = solver.identities(self.kind, pairs, form);
        let asked: Vec<&str> = identities.iter().flatten().map(String::as_str).collect();
        let mut times = self.run.legs.times(&asked).into_iter();
        let mut known = |pair: &(Place, Place), identity: &str| {
            let mut time = times.next().flatten()?;
            if !time.is_bound_current {
                let leg = solver.canonical(self.kind, *pair, form);
                time.certified_lower_bound_s = certify(&self.places, &leg).lower_bound;
            }
            Some(LegTime::stored(self.consistent(identity, time)))
        };
        let legs = pairs.iter().zip(&identities);
        legs.map(|(pair, identity)| known(pair, identity.as_ref()?))
            .collect()
    }

    /// A stored time without a bound that contradicts it.
    fn consistent(&self, identity: &str, mut time: StoredTime) -> StoredTime {
        if let Some(bound_s) = time.certified_lower_bound_s
            && refutes(time.duration_s, bound_s)
        {
            self.run.observer.contradicted(&Contradiction::Leg {
                identity: identity.to_owned(),
                bound_s,
                duration_s: time.duration_s,
            });
            time.certified_lower_bound_s = None;
        }
        time
    }
}
