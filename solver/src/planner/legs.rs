//! The tables of leg times.

use super::places::Places;
use super::{LegKind, Run};
use crate::multiphase::Flown;
use crate::nlp::NlpStatus;
use crate::profile::Profile;
use crate::progress::{Progress, Stage};
use crate::sequence::Place;
use crate::slew;
use crate::stop::StopSignal;
use crate::transcription::Waypoint;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Attitudes closer than this are the same place, rad; a rest-to-rest leg between them takes no
/// time.
const SAME_ATTITUDE: f64 = 1e-11;

/// A solved leg.
#[derive(Debug, Clone)]
pub(super) struct SolvedLeg {
    /// The motion and how it ended.
    pub(super) flown: Flown,
    /// NLPs solved for it.
    pub(super) solves: u64,
    /// Wall-clock time of all starts.
    pub(super) took: Duration,
}

/// Legs of one kind between pairs of places.
pub(super) struct LegTable {
    places: usize,
    legs: Vec<Option<SolvedLeg>>,
}

impl LegTable {
    /// The leg between two places, when it has been solved.
    pub(super) fn get(&self, from: Place, to: Place) -> Option<&SolvedLeg> {
        self.legs[index(from, self.places) * self.places + index(to, self.places)].as_ref()
    }

    /// All solved legs.
    pub(super) fn solved(&self) -> impl Iterator<Item = &SolvedLeg> {
        self.legs.iter().flatten()
    }
}

fn index(place: Place, places: usize) -> usize {
    match place {
        Place::Start => 0,
        Place::Target(i) => 1 + i,
        Place::End => places - 1,
    }
}

/// Solves the legs of a kind between the given pairs, on the pool; reversible pairs once.
pub(super) fn solve_table(
    places: &Places<'_>,
    kind: LegKind,
    pairs: &[(Place, Place)],
    run: Run<'_>,
    stop: &StopSignal,
) -> LegTable {
    let count = 2 + places.scenario.targets().len();
    let mut table = LegTable {
        places: count,
        legs: vec![None; count * count],
    };
    let at = |(from, to): (Place, Place)| index(from, count) * count + index(to, count);
    let mirrored = |(from, to): (Place, Place)| {
        let (back, forth) = ((to, from), index(to, count) < index(from, count));
        let ends = [&end_of(places, kind, from), &end_of(places, kind, to)];
        (forth && pairs.contains(&back) && places.reversible(ends)).then_some(back)
    };
    let (copies, fresh): (Vec<_>, Vec<_>) =
        pairs.iter().partition(|pair| mirrored(**pair).is_some());
    let done = AtomicU64::new(0);
    let solved = run.pool.map(&fresh, |(from, to)| {
        let leg = (!stop.is_set()).then(|| solve_leg(places, kind, *from, *to, stop));
        run.observer.progress(Progress {
            stage: Stage::Legs,
            done: done.fetch_add(1, Ordering::Relaxed) + 1,
            total: Some(fresh.len() as u64),
            incumbent_s: None,
            lower_bound_s: None,
        });
        leg
    });
    for (pair, leg) in fresh.iter().zip(solved) {
        table.legs[at(*pair)] = leg.filter(|leg| leg.flown.status != NlpStatus::Stopped);
    }
    for pair in copies {
        let original = mirrored(pair)
            .map(at)
            .and_then(|at| table.legs[at].as_ref());
        table.legs[at(pair)] = original.map(SolvedLeg::reversed);
    }
    table
}

fn end_of(places: &Places<'_>, kind: LegKind, place: Place) -> Waypoint {
    match kind {
        LegKind::RestToRest => places.at_rest(place),
        LegKind::LowerBound => places.waypoint(place),
    }
}

fn solve_leg(
    places: &Places<'_>,
    kind: LegKind,
    from: Place,
    to: Place,
    stop: &StopSignal,
) -> SolvedLeg {
    let begin = Instant::now();
    let (from, to) = (end_of(places, kind, from), end_of(places, kind, to));
    let slew = places.slew(&from, &to);
    let solved = standstill(places, &from, &to).map_or_else(
        || slew::solve(&slew, &|| stop.is_set()),
        |flown| slew::Slew { flown, solves: 0 },
    );
    SolvedLeg {
        flown: solved.flown,
        solves: solved.solves,
        took: begin.elapsed(),
    }
}

/// The leg between two equal rests: nothing moves and no time passes.
fn standstill(places: &Places<'_>, from: &Waypoint, to: &Waypoint) -> Option<Flown> {
    let dynamics = &places.dynamics;
    let turn = match places.arrival {
        slew::kinematic::Arrival::Rotation => from.attitude.angle_to(&to.attitude),
        slew::kinematic::Arrival::Quaternion => from.attitude.signed_turn_to(&to.attitude).norm(),
    };
    let same = turn <= SAME_ATTITUDE && from.rate == to.rate && from.wheels == to.wheels;
    (same && from.is_fixed(dynamics)).then(|| {
        let wheels = dynamics.wheels_at(&from.attitude, &nalgebra::Vector3::zeros(), &places.null);
        Flown {
            status: NlpStatus::Converged,
            profile: Profile::standstill(from.attitude, wheels, slew::INTERVALS),
            iterations: 0,
            infeasibility: 0.0,
        }
    })
}

impl SolvedLeg {
    fn reversed(&self) -> Self {
        let flown = Flown {
            profile: self.flown.profile.reversed(),
            ..self.flown.clone()
        };
        Self {
            flown,
            solves: 0,
            took: self.took,
        }
    }
}
