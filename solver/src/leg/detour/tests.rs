use super::*;

fn cone(half_angle: f64) -> ForbiddenCone {
    ForbiddenCone {
        axis: Vector3::x(),
        direction: Vector3::new(1.0, 1.0, 0.05).normalize(),
        half_angle,
    }
}

fn about_z(angle: f64) -> AttitudePath {
    let end = Attitude::from_rotation_vector(Vector3::z() * angle);
    AttitudePath::through([Attitude::identity(), end])
}

#[test]
fn a_path_is_pushed_out_to_either_side() {
    let cone = cone(0.4);
    let path = about_z(1.6);
    assert!(path.depth_in(&cone) > 0.3);
    let heights = [Side::Shorter, Side::Longer].map(|side| {
        let pushed = path.pushed_out(&[(cone, side)]).expect("there is room");
        assert!(pushed.depth_in(&cone) <= 0.0);
        let ends = [pushed.attitudes.first(), pushed.attitudes.last()].map(Option::unwrap);
        assert_eq!(*ends[0], Attitude::identity());
        assert!(ends[1].angle_to(path.attitudes.last().unwrap()) < 1e-12);
        let steps = pushed.attitudes.windows(2);
        assert!(
            steps
                .map(|q| q[0].angle_to(&q[1]))
                .all(|step| step <= STEP + 1e-9)
        );
        let boresights = pushed.attitudes.iter().map(|q| q.to_reference(cone.axis).z);
        boresights.fold(0.0_f64, |far, z| if z.abs() > far.abs() { z } else { far })
    });
    // Around the axis, which is slightly above the plane of the turn: below is shorter.
    assert!(heights[0] < -0.2 && heights[1] > 0.2, "{heights:?}");
}

#[test]
fn an_end_on_the_surface_stays_there() {
    let to_surface = Vector3::x().angle(&cone(0.1).direction);
    let cone = cone(to_surface);
    let path = about_z(1.6);
    let pushed = path.pushed_out(&[(cone, Side::Shorter)]).expect("room");
    assert_eq!(pushed.attitudes[0], Attitude::identity());
    assert!(pushed.depth_in(&cone) < 1e-9);
}

#[test]
fn a_direction_against_another_is_half_a_turn_away() {
    for direction in [Vector3::x(), Vector3::y(), Vector3::new(0.6, 0.0, -0.8)] {
        assert!((smallest_rotation(&direction, &-direction).norm() - PI).abs() < 1e-12);
        assert!(smallest_rotation(&direction, &direction).norm() < 1e-12);
    }
}

#[test]
fn a_cone_between_two_attitudes_of_a_path_is_entered() {
    let narrow = cone(1e-3);
    let path = about_z(1.6);
    let deepest = path.attitudes.iter().map(|q| narrow.depth(q));
    assert!(deepest.fold(f64::MIN, f64::max) < 0.0);
    let across = ForbiddenCone {
        direction: Vector3::new(1.0, 1.0, 0.0).normalize(),
        ..narrow
    };
    assert!((path.depth_in(&across) - 1e-3).abs() < 1e-6);
}
