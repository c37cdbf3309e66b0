use super::*;

#[test]
fn the_jacobian_is_the_derivative_of_the_momentum() {
    let cluster = CmgCluster::pyramid(0.8);
    let angles = [0.3, -1.2, 2.0, 0.7];
    let jacobian = cluster.jacobian(&angles);
    for i in 0..4 {
        let (mut more, mut less) = (angles, angles);
        more[i] += 1e-6;
        less[i] -= 1e-6;
        let slope = (cluster.momentum(&more) - cluster.momentum(&less)) / 2e-6;
        assert!((slope - jacobian.column(i)).norm() < 1e-9);
    }
    assert!(cluster.momentum(&[0.0; 4]).norm() < 1e-15);
}

#[test]
fn a_singular_state_has_no_torque_along_its_direction() {
    let cluster = CmgCluster::thesis();
    for signs in cluster.sign_patterns() {
        for state in cluster.singular_surface(&signs, 9).states.iter().flatten() {
            let torques = cluster.jacobian(&state.angles);
            assert!(torques.tr_mul(&state.direction).amax() < 1e-14);
            let spread = (cluster.momentum(&state.angles) - state.momentum).norm();
            assert!(spread < 1e-14);
        }
    }
}

#[test]
fn the_pyramid_has_the_published_greatest_momentum() {
    // All four across the axis of the pyramid: 4 sqrt(2/3).
    let greatest = CmgCluster::thesis().greatest_momentum();
    assert!((greatest - 3.266).abs() < 5e-4, "{greatest}");
    assert!((greatest - 4.0 * (2.0_f64 / 3.0).sqrt()).abs() < 1e-12);
}

#[test]
fn the_published_sphere_is_that_of_a_grid_and_larger_than_the_exact_one() {
    let cluster = CmgCluster::thesis();
    let signs = [false, true, true, true];
    // The nodes of a sphere in 20 by 20 facets.
    let mut on_grid = f64::INFINITY;
    for i in 0..=20 {
        let (s, c) = (std::f64::consts::PI * f64::from(i) / 20.0).sin_cos();
        for j in 0..20 {
            let (y, x) = (TAU * f64::from(j) / 20.0).sin_cos();
            let state = cluster.singular_state(&Vector3::new(s * x, s * y, c), &signs);
            on_grid = on_grid.min(state.map_or(f64::INFINITY, |s| s.momentum.norm()));
        }
    }
    assert!((on_grid - 1.0069).abs() < 5e-5, "{on_grid}");
    let least = cluster.least_with_one_reversed();
    assert!((least - 1.0).abs() < 1e-9, "{least}");
}

#[test]
fn elliptic_states_lie_outside_of_the_published_sphere() {
    let cluster = CmgCluster::thesis();
    let least = cluster.least_elliptic();
    assert!((least - 2.0 / 3.0_f64.sqrt()).abs() < 1e-9, "{least}");
    // A grid finds none nearer.
    for signs in &cluster.sign_patterns()[1..] {
        for state in cluster.singular_surface(signs, 30).states.iter().flatten() {
            let norm = state.momentum.norm();
            assert!(state.passability != Passability::Elliptic || norm > least - 1e-9);
        }
    }
}

/// Whether finite null motion leaves the singular state: a step in the null space, after which Newton's
/// method restores the momentum.
fn escapes(cluster: &CmgCluster, state: &SingularState) -> bool {
    let jacobian = cluster.jacobian(&state.angles);
    let gram = jacobian.tr_mul(&jacobian).symmetric_eigen();
    let null: Vec<_> = (0..4)
        .filter(|&i| gram.eigenvalues[i] < 1e-9)
        .map(|i| gram.eigenvectors.column(i).into_owned())
        .collect();
    (0..24).any(|k| {
        let (y, x) = (TAU * f64::from(k) / 24.0).sin_cos();
        let push = (&null[0] * x + &null[1] * y) * 0.01;
        let mut angles: Vec<f64> = state
            .angles
            .iter()
            .zip(push.iter())
            .map(|(a, b)| a + b)
            .collect();
        for _ in 0..50 {
            let miss = state.momentum - cluster.momentum(&angles);
            let Ok(inverse) = cluster.jacobian(&angles).pseudo_inverse(1e-10) else {
                return false;
            };
            for (angle, step) in angles.iter_mut().zip((inverse * miss).iter()) {
                *angle += step.clamp(-0.002, 0.002);
            }
        }
        let moved = angles
            .iter()
            .zip(&state.angles)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>();
        let met = (state.momentum - cluster.momentum(&angles)).norm() < 1e-12;
        let near = (2e-3..0.03).contains(&moved.sqrt());
        let torques = cluster.jacobian(&angles);
        met && near && torques.tr_mul(&state.direction).amax() > 1e-4
    })
}

#[test]
fn null_motion_leaves_hyperbolic_states_and_no_elliptic_ones() {
    let cluster = CmgCluster::thesis();
    let mut counted = [0, 0];
    for signs in &cluster.sign_patterns()[1..] {
        for state in cluster.singular_surface(signs, 7).states.iter().flatten() {
            // Not near the border of the two kinds, where the second-order form almost vanishes.
            let kinds = [0.05, -0.05].map(|shift| {
                let near = (state.direction + Vector3::new(shift, -shift, shift)).normalize();
                cluster.singular_state(&near, signs).map(|s| s.passability)
            });
            if kinds.iter().any(|kind| *kind != Some(state.passability)) {
                continue;
            }
            let elliptic = state.passability == Passability::Elliptic;
            assert_eq!(escapes(&cluster, state), !elliptic, "{state:?}");
            counted[usize::from(elliptic)] += 1;
        }
    }
    assert!(counted.iter().all(|&count| count > 20), "{counted:?}");
}

#[test]
fn rims_are_the_limits_of_their_surfaces() {
    let cluster = CmgCluster::thesis();
    for signs in cluster.sign_patterns() {
        for rim in cluster.rims(&signs) {
            let aside = rim
                .direction
                .cross(&Vector3::new(0.3, -0.2, 0.9))
                .normalize();
            let near = (rim.direction + aside * 1e-7).normalize();
            let state = cluster.singular_state(&near, &signs).unwrap();
            let arm = state.momentum - rim.centre;
            assert!((arm.norm() - 1.0).abs() < 1e-6);
            assert!(arm.dot(&rim.direction).abs() < 1e-6);
            assert!(state.momentum.norm() > rim.least_momentum() - 1e-6);
        }
    }
}

#[test]
fn the_number_of_rows_of_a_surface_is_limited() {
    let single = CmgCluster {
        gimbals: CmgCluster::thesis().gimbals[..1].to_vec(),
    };
    let surface = single.singular_surface(&[true], usize::MAX);
    assert_eq!(surface.rows, MAX_SURFACE_ROWS);
    assert_eq!(
        surface.states.len(),
        2 * MAX_SURFACE_ROWS * MAX_SURFACE_ROWS
    );
}
