//! Arc sequences: their interiors are products of arcs, and the terminal arcs that close them are
//! found.

use super::super::rates::{Octant, Rates, flipped};
use super::super::sequence::ArcSequence;
use super::super::terminal_arcs::{Allowed, TargetView};
use super::super::turn::{QuatInterval, product};
use crate::bounds::interval::Interval;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;
use proptest::prelude::*;

/// Tolerance for the half durations of the terminal arcs, which are known to some 1e-5 only in
/// ill-conditioned cases.
const NEAR: f64 = 1e-3;
/// Step of finite differences.
const STEP: f64 = 1e-5;

fn rates(given: [f64; 3]) -> Rates {
    Rates::around(&given.into()).expect("positive rates")
}

/// The turn of an arc: a rotation about the corner of an octant.
fn arc(rates: &Rates, octant: Octant, duration: f64) -> Attitude {
    let corner = rates.corner(octant).map(Interval::middle);
    Attitude::from_rotation_vector(Vector3::from(corner) * duration)
}

/// The turn of alternating arcs of one duration, and the octant of the last arc of the sequence.
fn interior(
    rates: &Rates,
    (first, axes, arcs): (Octant, [usize; 2], usize),
    duration: f64,
) -> (Attitude, Octant) {
    let mut octant = first;
    let mut all = Attitude::identity();
    for flip in 0..arcs {
        octant = flipped(octant, axes[flip % 2]);
        all = all.then_in_body(&arc(rates, octant, duration));
    }
    (all, flipped(octant, axes[arcs % 2]))
}

fn exactly(turn: &Attitude) -> QuatInterval {
    turn.xyzw().map(Interval::exactly)
}

/// First octant, axes and number of arcs.
fn kinds() -> impl Strategy<Value = (Octant, [usize; 2], usize)> {
    let axes = prop::sample::select(vec![[0, 1], [1, 0], [1, 2], [2, 1], [0, 2], [2, 0]]);
    (prop::array::uniform3(any::<bool>()), axes, 1..14_usize)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn interiors_are_products_of_their_arcs(
        given in prop::array::uniform3(0.2..1.0_f64),
        kind in kinds(),
        duration in 0.05..2.0_f64,
    ) {
        let (rates, (first, axes, arcs)) = (rates(given), kind);
        let sequence = ArcSequence::alternating(first, axes, arcs);
        let (expected, last) = interior(&rates, kind, duration);
        prop_assert_eq!(sequence.last, last);
        let moving = sequence.at(&rates, duration);
        let [before, after] = [-STEP, STEP]
            .map(|step| interior(&rates, kind, duration + step).0.xyzw());
        for (i, component) in expected.xyzw().into_iter().enumerate() {
            let found = moving.turn[i];
            prop_assert!(found.low - 1e-14 <= component && component <= found.high + 1e-14);
            prop_assert!(found.high - found.low < 1e-11, "{found:?}");
            let slope = (after[i] - before[i]) / (2.0 * STEP);
            // Third derivatives grow with the cube of the number of arcs.
            let error = 1e-9 + 0.1 * (arcs as f64 * STEP).powi(2) * arcs as f64;
            prop_assert!((moving.slope[i].middle() - slope).abs() < error, "{slope}");
        }
    }

    #[test]
    fn terminal_arcs_that_close_a_sequence_are_found(
        given in prop::array::uniform3(0.2..1.0_f64),
        kind in kinds(),
        duration in 0.05..2.0_f64,
        halves in prop::array::uniform2(0.02..1.4_f64),
    ) {
        let (rates, (first, axes, arcs)) = (rates(given), kind);
        let sequence = ArcSequence::alternating(first, axes, arcs);
        let (middle, last) = interior(&rates, kind, duration);
        let [begin, end] = [(first, halves[0]), (last, halves[1])]
            .map(|(octant, half)| exactly(&arc(&rates, octant, 2.0 * half)));
        let middle = exactly(&middle);
        let target = product(&product(&begin, &middle), &end);
        let view = TargetView::new(&rates, &target, &sequence);
        prop_assert!(!view.misses(&sequence.at(&rates, duration), Interval::ZERO, Interval::exactly(1e-12)));
        let terminal = view.terminal_arcs(&middle, Interval::exactly(1e-9));
        let Some(terminal) = terminal else {
            panic!("nothing closes the sequence");
        };
        let (longer, both) = (halves[0].max(halves[1]), halves[0] + halves[1]);
        let allowed = |each: f64, both: f64| Allowed { each, both };
        prop_assert!(!terminal.impossible(allowed(longer + NEAR, both + NEAR)));
        // All other durations that close it are longer by half turns.
        prop_assert!(terminal.impossible(allowed(longer + NEAR, both - NEAR)), "{terminal:?}");
        prop_assert!(terminal.impossible(allowed(longer - NEAR, both + NEAR)), "{terminal:?}");
        for (found, half) in terminal.candidate().into_iter().zip(halves) {
            prop_assert!((found - 2.0 * half).abs() < NEAR, "{found} for {half}");
        }
    }
}
