use super::*;

fn published() -> Comparison {
    Comparison::of(ComparisonStudySpec::default()).unwrap()
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}"
    );
}

#[test]
fn the_published_rates_and_accelerations_are_found() {
    let mut spec = ComparisonStudySpec::default();
    // The thesis writes 1.807 here.
    spec.radii.optimal.momentum = 1.807;
    let sizes = Comparison::of(spec).unwrap().sizes;
    assert_near(sizes[0].inertia_kg_m2, 25.458, 1e-3);
    let expected = [
        // Accelerations by the momentum of a device: 1, 0.1 and 0.01 N m s.
        (3.000, [0.081, 0.236, 0.689]),
        (3.549, [0.081, 0.236, 0.689]),
        (4.067, [0.081, 0.236, 0.689]),
        (2.266, [2.485, 2.474, 2.464]),
    ];
    for (size, comparison) in sizes.iter().enumerate() {
        for (agility, (rate, accelerations)) in comparison.agilities.iter().zip(expected) {
            assert_near(agility.rate_rad_s.to_degrees(), rate, 1e-3);
            assert_near(
                agility.acceleration_rad_s2.to_degrees(),
                accelerations[size],
                1e-3,
            );
        }
    }
}

#[test]
fn the_advantage_angles_follow_from_the_published_fits() {
    let found = published();
    let angles = |size: usize| {
        let advantages = found.sizes[size].advantages.iter();
        advantages
            .map(|a| a.angle_rad.unwrap().to_degrees())
            .collect::<Vec<_>>()
    };
    let expected = [(1, [109.2, 88.4, 83.4]), (2, [31.8, 26.5, 25.5])];
    for (size, expected) in expected {
        for (angle, expected) in angles(size).into_iter().zip(expected) {
            assert_near(angle, expected, 0.1);
        }
    }
    // With devices of 1 N m s gyroscopes win every slew.
    assert!(angles(0).into_iter().all(|angle| angle > 180.0));
}

#[test]
fn a_cut_off_end_explains_part_of_the_published_angles() {
    let found = published();
    let cut_off = [80.5, 24.9, 30.5];
    for (published, cut_off) in PUBLISHED_ANGLES.iter().zip(cut_off) {
        let mut sizes = found.sizes.iter();
        let size = sizes
            .find(|size| size.momentum_nms.total_cmp(&published.momentum_nms).is_eq())
            .unwrap();
        let mut advantages = size.advantages.iter();
        let advantage = advantages.find(|a| a.control == published.control).unwrap();
        let [exact, cut] = [advantage.angle_rad, advantage.with_cut_off_rad];
        let (exact, cut) = (exact.unwrap().to_degrees(), cut.unwrap().to_degrees());
        assert_near(cut, cut_off, 0.1);
        // The published angle is smaller than both; the angle with a cut-off is nearer to it.
        assert!(published.angle_deg < cut && cut < exact);
    }
}

#[test]
fn slews_take_equal_times_at_the_advantage_angle() {
    let found = published();
    for size in &found.sizes {
        let gyroscopes = size.agilities.last().unwrap();
        for (wheels, advantage) in size.agilities.iter().zip(&size.advantages) {
            let angle = advantage.angle_rad.unwrap();
            let times = |angle| [wheels, gyroscopes].map(|by| by.slew(angle).duration());
            let [wheel, gyroscope] = times(angle);
            assert_near(wheel / gyroscope, 1.0, 1e-12);
            let ([before, slower], [after, faster]) = (times(0.9 * angle), times(1.1 * angle));
            assert!(before > slower && after < faster);
        }
    }
}

#[test]
fn durations_fall_with_better_control_and_rise_with_the_angle() {
    for size in published().sizes {
        let [eigenaxis, pseudo, optimal, gyroscopes] = size.slews.try_into().unwrap();
        for i in 0..180 {
            assert!(optimal.durations_s[i] <= pseudo.durations_s[i]);
            assert!(pseudo.durations_s[i] <= eigenaxis.durations_s[i]);
        }
        for curve in [eigenaxis, pseudo, optimal, gyroscopes] {
            assert!(curve.durations_s.is_sorted());
        }
    }
}

#[test]
fn an_advantage_may_hold_always_or_never() {
    let of = |rate_rad_s, acceleration_rad_s2| Agility {
        control: PyramidControl::Optimal,
        momentum_nms: 1.0,
        torque_nm: 1.0,
        rate_rad_s,
        acceleration_rad_s2,
    };
    assert_eq!(of(1.0, 1.0).advantage_over(&of(1.0, 2.0), 0.0), None);
    assert_eq!(of(2.0, 1.0).advantage_over(&of(1.0, 1.0), 0.0), Some(0.0));
    // Wheels that never coast against gyroscopes that do: 2 sqrt(angle) = angle + 1/4.
    let angle = of(100.0, 1.0).advantage_over(&of(1.0, 4.0), 0.0).unwrap();
    assert_near(angle, (1.0 + 0.75_f64.sqrt()).powi(2), 1e-10);
}

#[test]
fn computed_radii_are_the_published_ones_except_for_the_gyroscopes() {
    let radii = Radii::of_the_pyramid().unwrap();
    for control in [
        PyramidControl::Eigenaxis,
        PyramidControl::PseudoOptimal,
        PyramidControl::Optimal,
    ] {
        let (found, published) = (radii.of(control), Radii::PUBLISHED.of(control));
        assert_near(found.momentum, published.momentum, 5e-4);
        assert_near(found.torque, published.torque, 5e-4);
    }
    // The published 1.007 is that of a grid, see the documentation of the clusters.
    assert_near(radii.gyroscopes.momentum, 1.0, 1e-9);
}

#[test]
fn light_wheels_give_more_torque_than_light_gyroscopes() {
    let study = MassStudy::of(Radii::PUBLISHED, Laws::PUBLISHED).unwrap();
    let crossover = study.crossover_kg().unwrap();
    assert_near(crossover, 0.908, 5e-4);
    assert_near(crossover / MassStudy::PUBLISHED_CROSSOVER_KG, 1.0, 0.012);
    for (mass, more) in [(0.5, true), (0.9, true), (0.92, false), (50.0, false)] {
        let point = study.at(mass);
        assert_eq!(
            point.wheel_torque_nm > point.gyroscope_torque_nm,
            more,
            "{mass} kg"
        );
        assert!(point.wheel_momentum_nms > 5.0 * point.gyroscope_momentum_nms);
        assert_near(point.array_mass_kg, 4.0 * mass, 1e-12);
    }
    let tables = Laws::of_the_tables().unwrap();
    let by_tables = MassStudy::of(Radii::PUBLISHED, tables).unwrap();
    assert_near(by_tables.crossover_kg().unwrap(), 1.036, 5e-4);
    // As the thesis says, one gyroscope of its table is lighter than the crossover.
    let lighter = GYROSCOPES
        .iter()
        .filter(|device| device.mass_kg < crossover);
    assert_eq!(lighter.count(), 1);
}

#[test]
fn all_problems_of_a_request_are_found() {
    let mut spec = ComparisonStudySpec {
        momenta_nms: vec![1.0, -1.0],
        angles_rad: vec![],
        required_rate_rad_s: f64::NAN,
        ..ComparisonStudySpec::default()
    };
    spec.radii.gyroscopes.torque = 0.0;
    spec.laws.wheel.exponent = f64::INFINITY;
    let problems = Comparison::of(spec).unwrap_err();
    let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    let expected = [
        "/momenta_nms/1",
        "/angles_rad",
        "/required_rate_rad_s",
        "/radii/cmg/torque",
        "/laws/wheel/exponent",
    ];
    assert_eq!(pointers, expected);
}
