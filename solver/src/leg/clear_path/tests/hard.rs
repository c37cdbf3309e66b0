//! The hard cases by name.

use super::*;

/// A keep-in for a second boresight that is as good as none.
fn second_boresight() -> ForbiddenCone {
    cone(Vector3::z(), -Vector3::z(), 1.0)
}

/// The same problem as one of two boresights, so that it is searched over attitudes.
fn also_over_attitudes(problem: &PathProblem<'_>) -> f64 {
    let cones = [problem.cones, &[second_boresight()]].concat();
    let turn = path(&PathProblem {
        cones: &cones,
        ..*problem
    });
    turn.1
}

/// A wall around the sphere between the west and the east: in front a gap between a cone around the
/// pole and two that overlap, all else shut.
fn gap(width_deg: f64) -> Vec<ForbiddenCone> {
    let at = |longitude, latitude, half_angle| {
        cone(Vector3::x(), direction(longitude, latitude), half_angle)
    };
    vec![
        at(0.0, 90.0, 60.0),
        at(-20.0, -10.0 - width_deg, 40.0),
        at(20.0, -10.0 - width_deg, 40.0),
        at(0.0, -90.0, 50.0),
        at(180.0, -5.0, 45.0),
    ]
}

#[test]
fn a_gap_of_three_degrees_between_two_overlapping_cones_and_a_third_is_passed() {
    let cones = gap(3.0);
    let problem = problem(&cones, toward(-90.0, 0.0), toward(90.0, 0.0));
    let (_, turn) = path(&problem);
    assert!(turn < 4.0, "{turn}");
    let other = also_over_attitudes(&problem);
    assert!(other < 4.5, "{other}");
}

/// Three cones like the letter C, open to the east, around the west of a start.
fn letter_c() -> Vec<ForbiddenCone> {
    vec![
        cone(Vector3::x(), direction(-25.0, 0.0), 20.0),
        cone(Vector3::x(), direction(-5.0, 28.0), 20.0),
        cone(Vector3::x(), direction(-5.0, -28.0), 20.0),
    ]
}

#[test]
fn a_way_leads_out_of_a_cul_de_sac_whose_end_is_the_direct_way() {
    let cones = letter_c();
    let problem = problem(&cones, toward(0.0, 0.0), toward(-80.0, 0.0));
    let (attitudes, turn) = path(&problem);
    // It begins away from the goal.
    let eastmost = attitudes
        .iter()
        .map(|q| q.to_reference(Vector3::x()))
        .map(|d| d.y.atan2(d.x))
        .fold(f64::NEG_INFINITY, f64::max);
    assert!(eastmost > 0.05, "{eastmost}");
    assert!(turn < 3.2, "{turn}");
    assert!(also_over_attitudes(&problem) < 3.6);
}

#[test]
fn a_goal_just_behind_a_cone_of_sixty_degrees_is_reached_by_the_shortest_way() {
    let cones = [cone(Vector3::x(), direction(0.0, 0.0), 60.0)];
    let problem = problem(&cones, toward(-61.0, 0.0), toward(61.0, 0.0));
    let (_, turn) = path(&problem);
    // The boresight goes around, by two tangents and an arc; it is turned without roll, and of the
    // roll that the way leaves half the area within is to be made up for.
    let (far, half) = (61_f64.to_radians(), 60_f64.to_radians());
    let tangent = (far.cos() / half.cos()).acos();
    let arc = PI - 2.0 * (half.tan() / far.tan()).acos();
    let least = 2.0 * tangent + arc * half.sin();
    assert!(turn >= least && turn < 1.25 * least, "{turn} {least}");
    let other = also_over_attitudes(&problem);
    assert!(other < 1.1 * turn, "{turn} {other}");
}

#[test]
fn a_corridor_of_five_degrees_is_followed() {
    // The camera stays within 50 degrees of a direction and out of 45 degrees around it.
    let cones = [
        keep_in(Vector3::x(), direction(0.0, 90.0), 50.0),
        cone(Vector3::x(), direction(0.0, 90.0), 45.0),
    ];
    // Rolled at the end, so that one turn about the pole is not the way.
    let rolled = toward(170.0, 41.0).then_in_body(&about(Vector3::x(), 80.0));
    let problem = problem(&cones, toward(0.0, 42.5), rolled);
    let (_, turn) = path(&problem);
    let direct = 170_f64.to_radians() * 42_f64.to_radians().cos();
    assert!(turn >= direct && turn < 1.4 * PI, "{turn} {direct}");
    let other = also_over_attitudes(&problem);
    assert!(other < 1.02 * turn, "{turn} {other}");
}

#[test]
fn a_boresight_held_within_two_and_a_half_degrees_still_rolls() {
    // Rolled by the long way round where a second boresight bars the short one.
    let cones = [
        keep_in(Vector3::x(), Vector3::x(), 2.5),
        cone(Vector3::y(), direction(0.0, 90.0), 30.0),
    ];
    let end = about(Vector3::x(), 170.0).then_in_body(&about(Vector3::z(), 2.0));
    let (_, turn) = path(&problem(&cones, Attitude::identity(), end));
    assert!(
        turn > 189_f64.to_radians() && turn < 200_f64.to_radians(),
        "{turn}"
    );
}

#[test]
fn a_start_on_the_surface_of_a_cone_is_left() {
    for half_angle in [5.0, 30.0, 85.0] {
        let cones = [cone(Vector3::x(), direction(0.0, 0.0), half_angle)];
        // A little inside, as far as that is allowed.
        let from = toward(-half_angle + 4e-5, 0.0);
        let problem = problem(&cones, from, toward(half_angle + 1.0, 3.0));
        path(&problem);
        also_over_attitudes(&problem);
    }
}

#[test]
fn a_start_in_the_corner_between_two_cones_is_left() {
    let cones = [
        cone(Vector3::x(), direction(0.0, 40.0), 50.0),
        cone(Vector3::x(), direction(0.0, -40.0), 50.0),
    ];
    // Both surfaces meet on the equator.
    let corner = (50_f64.to_radians().cos() / 40_f64.to_radians().cos()).acos();
    let from = toward(-corner.to_degrees(), 0.0);
    assert!(clearance(&cones, &from).abs() < 1e-9);
    let problem = problem(&cones, from, toward(60.0, 0.0));
    path(&problem);
    also_over_attitudes(&problem);
}

#[test]
fn a_cone_around_the_antipode_is_no_obstacle() {
    let cones = [cone(Vector3::x(), direction(180.0, 0.0), 30.0)];
    let half_turn = about(Vector3::x(), 180.0);
    let (_, turn) = path(&problem(&cones, Attitude::identity(), half_turn));
    assert!((turn - PI).abs() < 1e-9);
    // And as one that the shortest way would cross.
    let (from, to) = (toward(120.0, 1.0), toward(-120.0, 1.0));
    let problem = problem(&cones, from, to);
    let (_, turn) = path(&problem);
    assert!(turn > 2.0 && turn < 2.5, "{turn}");
    also_over_attitudes(&problem);
}

/// A closed ring of cones at some latitude.
fn ring(latitude: f64, half_angle: f64) -> Vec<ForbiddenCone> {
    (0..12)
        .map(|i| {
            let axis = direction(30.0 * f64::from(i), latitude);
            cone(Vector3::x(), axis, half_angle)
        })
        .collect()
}

fn is_proved(problem: &PathProblem<'_>) {
    let search = find(problem);
    let outcome = &search.outcome;
    assert!(matches!(outcome, PathOutcome::Disconnected), "{outcome:?}");
}

#[test]
fn no_way_leads_through_a_ring_of_cones_and_that_is_proved() {
    let mut cones = ring(10.0, 16.0);
    let (from, to) = (toward(0.0, -60.0), toward(40.0, 80.0));
    is_proved(&problem(&cones, from, to));
    is_proved(&problem(&cones, to, from));
    cones.push(second_boresight());
    is_proved(&problem(&cones, from, to));
    // Without one cone of the ring there is a way.
    cones.remove(7);
    path(&problem(&cones, from, to));
}

#[test]
fn a_keep_in_that_a_keep_out_divides_is_proved_to_have_no_way() {
    let cones = [
        keep_in(Vector3::x(), direction(0.0, 90.0), 70.0),
        // Through the pole, beyond both rims.
        cone(Vector3::x(), direction(-90.0, 10.0), 82.0),
        cone(Vector3::x(), direction(90.0, 10.0), 82.0),
    ];
    is_proved(&problem(&cones, toward(0.0, 50.0), toward(180.0, 50.0)));
    // A keep-in alone divides nothing.
    let alone = [keep_in(Vector3::x(), direction(0.0, 90.0), 70.0)];
    path(&problem(&alone, toward(0.0, 21.0), toward(180.0, 21.0)));
    path(&problem(&alone, toward(0.0, 21.0), toward(130.0, 21.0)));
}

#[test]
fn two_boresights_that_lock_only_together_are_proved_to_be_locked() {
    // The first stays in 10 degrees, so that the second can only go round; two cones bar both ways.
    let cones = [
        keep_in(Vector3::x(), Vector3::x(), 10.0),
        cone(Vector3::y(), Vector3::z(), 30.0),
        cone(Vector3::y(), -Vector3::z(), 30.0),
    ];
    let end = about(Vector3::x(), 180.0);
    is_proved(&problem(&cones, Attitude::identity(), end));
    // With the first one free there is a way.
    path(&problem(&cones[1..], Attitude::identity(), end));
}

#[test]
fn an_end_inside_a_cone_has_no_path() {
    let cones = [cone(Vector3::x(), direction(0.0, 0.0), 20.0)];
    let outside = toward(90.0, 0.0);
    is_proved(&problem(&cones, toward(-20.0 + 1e-4, 0.0), outside));
    is_proved(&problem(&cones, outside, toward(3.0, 0.0)));
}

#[test]
fn what_is_not_found_says_how_finely_it_was_searched_and_how_near_it_came() {
    // A gap of a ten-thousandth of a degree is there, and nobody sees it.
    let mut cones = gap(1e-4);
    let ends = (toward(-70.0, 0.0), toward(70.0, 0.0));
    let tested = |cones: &[ForbiddenCone], finest_deg: f64, limit: usize| {
        let search = find(&problem(cones, ends.0, ends.1));
        let PathOutcome::Unknown {
            resolution,
            closest,
        } = search.outcome
        else {
            panic!("{:?}", search.outcome);
        };
        assert!(resolution <= finest_deg.to_radians(), "{resolution}");
        // Nothing beyond the gap is reached, and much up to it.
        assert!(closest > 1.55 && closest < 2.0, "{closest}");
        assert!(
            search.cells <= limit && search.cells > 20_000,
            "{}",
            search.cells
        );
    };
    tested(&cones, 0.1, 100_000);
    cones.push(second_boresight());
    tested(&cones, 5.0, 130_000);
}

#[test]
fn the_given_sign_is_arrived_at_where_it_counts() {
    let cones = [
        cone(Vector3::x(), direction(0.0, 0.0), 30.0),
        cone(Vector3::z(), direction(20.0, 0.0), 20.0),
    ];
    let (from, to) = (toward(-40.0, 0.0), toward(40.0, 0.0));
    for (cones, to) in [(&cones[..1], to), (&cones[..], to), (&[], from)] {
        for to in [to, to.negated()] {
            let either = path(&problem(cones, from, to)).1;
            let signed = PathProblem {
                signed: true,
                ..problem(cones, from, to)
            };
            let turn = path(&signed).1;
            assert!(turn >= either - 0.02, "{turn} {either}");
        }
    }
}

#[test]
fn many_cones_are_searched_with_fewer_cells() {
    // A ring of 600 cones with a gap that is too small to be seen, for two boresights.
    let mut cones: Vec<_> = (0..600)
        .map(|i| {
            let axis = direction(0.6 * f64::from(i), 0.0);
            cone(Vector3::x(), axis, 0.299_9)
        })
        .collect();
    cones.push(second_boresight());
    let problem = problem(&cones, toward(0.1, -40.0), toward(50.0, 40.0));
    let search = find(&problem);
    let PathOutcome::Unknown { resolution, .. } = search.outcome else {
        panic!("{:?}", search.outcome);
    };
    assert!(search.cells <= 15_000, "{}", search.cells);
    assert!(resolution < 0.4, "{resolution}");
}
