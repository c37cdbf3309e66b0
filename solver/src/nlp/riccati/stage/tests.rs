//! Factors and products of single stages.

use super::*;

/// Links of three states, two of which controls are added to, in blocks with room for more.
fn links() -> LinkModel {
    let general = [0.9, 0.1, -0.2, 0.3, 0.4, -0.5];
    let added = [
        [0.0, 1.0, 0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 1.0, 0.0],
    ];
    LinkModel {
        vars: 6,
        link_jacobian: general.into_iter().chain(added.concat()).collect(),
        hessian: vec![0.0; 36],
        ..LinkModel::default()
    }
}

#[test]
fn rows_that_add_a_control_are_recognised_and_multiply_like_any() {
    let mut adding = Stage::<4, 5>::default();
    adding.read_links(&links(), 3);
    assert_eq!((adding.general, adding.rows), (1, 3));
    let any = Stage {
        general: 3,
        ..adding.clone()
    };
    let mut other = links();
    other.link_jacobian[6 + 2] = 0.1;
    let mut unlike = Stage::<4, 5>::default();
    unlike.read_links(&other, 3);
    assert_eq!(unlike.general, 3);

    let next = std::array::from_fn(|i| std::array::from_fn(|j| 1.0 / (1 + i + j) as f64));
    let sums = [&adding, &any].map(|stage| {
        let mut blocks = Blocks::<4, 5>::condensed(&links(), 3, &[], 0.1, true);
        blocks.add_cost_to_go(stage, &next);
        [
            blocks.states.concat(),
            blocks.mixed.concat(),
            blocks.controls.concat(),
        ]
        .concat()
    });
    let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
    assert!(close(&sums[0], &sums[1]));
    let (state, control) = ([1.0, -2.0, 0.5, 0.0], [0.3, 0.2, -0.4, 0.0, 0.0]);
    let arrivals = [&adding, &any].map(|stage| stage.arrival(&state, &control, [0.1; 4]));
    assert!(close(&arrivals[0], &arrivals[1]));
}

#[test]
fn cholesky_solves_and_refuses_indefinite() {
    let full = [[4.0, 2.0, -1.0], [2.0, 5.0, 1.0], [-1.0, 1.0, 3.0]];
    let mut factor = full;
    assert!(cholesky(&mut factor));
    let right = [1.0, -2.0, 0.5];
    let mut x = right;
    solve_lower(&factor, &mut x);
    solve_upper(&factor, &mut x);
    for (row, want) in full.iter().zip(right) {
        assert!((dot(row, &x) - want).abs() < 1e-14);
    }
    assert!(!cholesky(&mut [[1.0, 2.0], [2.0, 1.0]]));
}
