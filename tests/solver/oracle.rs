//! Branch and bound against the solution of all orders; ninety more cases are in the example
//! `order_oracle`.

use slewplan_tests::orders::{
    Case, PLAIN, assert_search_finds_the_best_of, assert_search_finds_the_best_order,
};
use slewplan_tests::ordinary;

/// The same for scenarios with one kind of rate condition at every target: seed, targets, stored
/// momentum, end.
fn assert_found_with(rate_kind: usize, cases: [(u64, usize, bool, bool); 2]) {
    for (seed, targets, momentum, end) in cases {
        assert_search_finds_the_best_order(&Case {
            seed,
            targets,
            rate_kind: Some(rate_kind),
            momentum,
            end,
            ..PLAIN
        });
    }
}

#[test]
fn the_best_order_is_found_when_every_target_is_a_rest() {
    assert_found_with(0, [(1, 5, false, true), (2, 4, false, false)]);
}

#[test]
fn the_best_order_is_found_when_only_the_z_rate_vanishes() {
    assert_found_with(1, [(3, 4, false, true), (4, 3, true, true)]);
}

#[test]
fn the_best_order_is_found_when_the_rate_is_free() {
    assert_found_with(2, [(5, 4, false, true), (6, 3, false, false)]);
}

#[test]
fn the_best_order_is_found_when_the_rate_is_bounded() {
    assert_found_with(3, [(7, 3, false, true), (8, 2, true, true)]);
}

#[test]
fn the_best_order_is_found_among_mixed_conditions_with_dwell() {
    assert_search_finds_the_best_order(&Case {
        seed: 9,
        dwell: true,
        ..PLAIN
    });
    assert_search_finds_the_best_order(&Case {
        seed: 10,
        momentum: true,
        end: false,
        dwell: true,
        ..PLAIN
    });
}

#[test]
fn the_best_order_is_found_with_signed_quaternions() {
    assert_search_finds_the_best_order(&Case {
        seed: 11,
        targets: 3,
        rate_kind: Some(1),
        signed: true,
        ..PLAIN
    });
}

#[test]
fn the_best_order_is_found_on_ordinary_spacecraft() {
    for seed in [1, 2, 3] {
        let spec = ordinary::scenario(seed, 4, 3.0);
        assert_search_finds_the_best_of(&spec, &format!("ordinary {seed}"));
    }
}
