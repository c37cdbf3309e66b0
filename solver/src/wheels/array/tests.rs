use super::*;
use std::f64::consts::{PI, TAU};

fn of_axes<const N: usize>(axes: [[f64; 3]; N]) -> WheelArray {
    WheelArray::try_new(
        &axes.map(|axis| WheelRange::symmetric(axis.into(), 1.0)),
        "",
    )
    .unwrap()
}

/// The square pyramid of the thesis, with limits of one.
fn pyramid() -> WheelArray {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    of_axes([[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]])
}

/// Wheels of different strength, with two parallel axes, three in a plane, and uneven limits.
fn mixed() -> WheelArray {
    let range = |axis: [f64; 3], least, most| WheelRange {
        axis: axis.into(),
        least,
        most,
    };
    let ranges = [
        range([1.0, 0.0, 0.0], -1.0, 2.0),
        range([-2.0, 0.0, 0.0], -0.3, 0.4),
        range([0.0, 1.0, 0.0], -1.0, 1.0),
        range([0.6, 0.8, 0.0], -0.5, 0.25),
        range([0.0, 0.0, 1.0], -2.0, 1.0),
        range([0.3, -0.4, 0.7], -1.5, 0.6),
        range([-0.2, 0.5, 0.4], -0.1, 0.9),
    ];
    WheelArray::try_new(&ranges, "").unwrap()
}

/// Asserts that a polytope is convex, closed and has the origin inside.
fn assert_convex(polytope: &Polytope) {
    let vertices = polytope.vertices();
    let size = vertices.iter().map(Vector3::norm).fold(0.0, f64::max);
    let mut met = vec![0; vertices.len()];
    for facet in polytope.facets() {
        assert!(facet.distance > 0.0);
        assert!((facet.normal.norm() - 1.0).abs() < 1e-14);
        let heights = vertices
            .iter()
            .map(|v| facet.normal.dot(v) - facet.distance);
        for (i, height) in heights.enumerate() {
            let on = facet.vertices.contains(&i);
            assert!(
                height < if on { 1e-13 } else { -1e-9 } * size,
                "{height} at {i}, on: {on}"
            );
            assert!(!on || height > -1e-13 * size);
            met[i] += i32::from(on);
        }
        // Counter-clockwise about the normal, with a proper corner everywhere.
        let corners: Vec<_> = facet.vertices.iter().map(|&i| vertices[i]).collect();
        for k in 0..corners.len() {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % corners.len()]);
            assert!((b - a).cross(&(c - b)).dot(&facet.normal) > 0.0);
        }
    }
    assert!(met.iter().all(|&facets| facets > 2), "{met:?}");
    let edges = polytope.edges().len();
    let sides: usize = polytope
        .facets()
        .iter()
        .map(|facet| facet.vertices.len())
        .sum();
    assert_eq!(sides, 2 * edges);
    assert_eq!(vertices.len() + polytope.facets().len(), edges + 2);
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}"
    );
}

#[test]
fn the_pyramid_has_the_published_envelope() {
    let envelope = pyramid().full_envelope();
    assert_convex(&envelope);
    assert_eq!(
        (envelope.vertices().len(), envelope.facets().len()),
        (14, 12)
    );
    let radii: Vec<f64> = envelope.vertices().iter().map(Vector3::norm).collect();
    let near = |radius: f64| radii.iter().filter(|r| (*r - radius).abs() < 5e-4).count();
    assert_eq!((near(2.0), near(2.309)), (8, 6));
    for facet in envelope.facets() {
        assert_near(facet.distance, 1.633, 5e-4);
        assert_eq!(facet.vertices.len(), 4);
    }
    let figures = envelope.size();
    assert_near(figures.inscribed_radius, 1.633, 5e-4);
    assert_near(figures.greatest_radius, 2.309, 5e-4);
    // Four triples of wheels with a determinant of 4 / (3 sqrt 3): 128 / (3 sqrt 3). The thesis
    // prints 24.632.
    assert_near(figures.volume, 24.634, 5e-4);
    assert_near(figures.volume, 128.0 / (3.0 * 3.0_f64.sqrt()), 1e-13);
    assert_near(figures.equal_volume_radius, 1.805, 5e-4);
    assert_near(figures.mean_radius, 1.7973, 5e-5);
}

#[test]
fn the_pyramid_has_the_published_pseudo_inverse_envelope() {
    let envelope = pyramid().pseudo_inverse_envelope();
    assert_convex(&envelope);
    assert_eq!(envelope.facets().len(), 8);
    let figures = envelope.size();
    assert_near(figures.inscribed_radius, 1.333, 5e-4);
    assert_near(figures.greatest_radius, 2.309, 5e-4);
    assert_near(figures.equal_volume_radius, 1.577, 5e-4);
    assert_near(figures.mean_radius, 1.557, 5e-4);
    // It touches the full envelope at the major vertices and in the middles of the facets.
    let full = pyramid().full_envelope();
    for vertex in envelope.vertices() {
        assert_near(full.share(vertex), 1.0, 1e-13);
    }
    for facet in full.facets() {
        assert_near(envelope.reach(&facet.normal), facet.distance, 1e-13);
    }
}

/// The volume of a zonotope is the sum over triples of segments of their determinants.
fn volume_by_triples(array: &WheelArray) -> f64 {
    let widths: Vec<_> = array
        .ranges()
        .iter()
        .map(|r| r.axis * (r.most - r.least))
        .collect();
    let mut volume = 0.0;
    for i in 0..widths.len() {
        for j in i + 1..widths.len() {
            for k in j + 1..widths.len() {
                volume += widths[i].cross(&widths[j]).dot(&widths[k]).abs();
            }
        }
    }
    volume
}

/// Wheels on a cone of a half-angle from its axis.
fn cone<const N: usize>(half_angle: f64) -> WheelArray {
    let (s, c) = half_angle.sin_cos();
    let place = |i: usize| TAU * i as f64 / N as f64;
    of_axes::<N>(std::array::from_fn(|i| {
        [s * place(i).cos(), s * place(i).sin(), c]
    }))
}

#[test]
fn envelopes_are_convex_and_have_the_volume_of_the_sum_over_triples() {
    let arrays = [
        (
            "cube",
            of_axes([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            6,
        ),
        ("pyramid", pyramid(), 12),
        ("five on a cone", cone::<5>(0.9), 20),
        ("six on a cone", cone::<6>(0.5), 30),
        ("seven on a cone", cone::<7>(1.2), 42),
        // Two axes are parallel, and x, y and their mixture lie in one plane: of the 15 pairs of
        // six directions, three share a normal.
        ("mixed", mixed(), 26),
    ];
    for (name, array, facets) in arrays {
        let envelopes = array.envelopes();
        assert_convex(&envelopes.full);
        assert_convex(&envelopes.pseudo_inverse);
        assert_eq!(envelopes.full.facets().len(), facets, "{name}");
        let volume = envelopes.full.volume();
        assert_near(volume / volume_by_triples(&array), 1.0, 1e-12);
        for vertex in envelopes.pseudo_inverse.vertices() {
            assert!(envelopes.full.share(vertex) < 1.0 + 1e-12, "{name}");
            let x = array.pseudo_inverse() * vertex;
            assert_near(
                array.load(&DVector::from_column_slice(x.as_slice())),
                1.0,
                1e-12,
            );
        }
        assert!(envelopes.pseudo_inverse.volume() < volume * (1.0 + 1e-12));
    }
}

#[test]
fn three_wheels_have_one_envelope() {
    let array = of_axes([[1.0, 0.2, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 1.0]]);
    let Envelopes {
        full,
        pseudo_inverse,
    } = array.envelopes();
    assert_eq!(pseudo_inverse.facets().len(), 6);
    assert_near(pseudo_inverse.volume(), full.volume(), 1e-13);
}

#[test]
fn the_mean_radius_is_the_mean_over_a_dense_set_of_directions() {
    let (rows, columns) = (300, 300);
    for polytope in [
        mixed().full_envelope(),
        cone::<5>(0.4).pseudo_inverse_envelope(),
    ] {
        let (mut sum, mut weights) = (0.0, 0.0);
        for i in 0..rows {
            let (radius, height) = (PI * (f64::from(i) + 0.5) / f64::from(rows)).sin_cos();
            for j in 0..columns {
                let (y, x) = (TAU * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
                let direction = Vector3::new(radius * x, radius * y, height);
                sum += radius * polytope.reach(&direction);
                weights += radius;
            }
        }
        assert_near(polytope.size().mean_radius / (sum / weights), 1.0, 1e-4);
    }
}

/// The mean radius of an infinite square prism is `2 ln(1 + sqrt 2)`. The number of pieces of an edge
/// must grow with the logarithm of its length only.
#[test]
fn the_mean_radius_of_a_long_prism_tends_to_that_of_an_infinite_one() {
    for length in [1e9, 1e15, 1e60] {
        let axis = |i: usize| Vector3::from_fn(|k, _| f64::from(u8::from(i == k)));
        let strength = [1.0, 1.0, length];
        let ranges = [0, 1, 2].map(|i| WheelRange::symmetric(axis(i), strength[i]));
        let prism = WheelArray::try_new(&ranges, "").unwrap();
        let mean = prism.full_envelope().size().mean_radius;
        assert_near(mean, 2.0 * 1.0_f64.asinh(), 1e-7);
    }
}

#[test]
fn radii_and_volume_of_a_cube_are_those_of_the_closed_form() {
    let cube = of_axes([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).full_envelope();
    let figures = cube.size();
    assert_near(figures.inscribed_radius, 1.0, 1e-15);
    assert_near(figures.greatest_radius, 3.0_f64.sqrt(), 1e-15);
    assert_near(figures.volume, 8.0, 1e-14);
    assert_near(figures.equal_volume_radius, (6.0 / PI).cbrt(), 1e-15);
}

#[test]
fn all_problems_of_all_wheels_are_found() {
    let range = |axis: [f64; 3], least, most| WheelRange {
        axis: axis.into(),
        least,
        most,
    };
    let faulty = [
        range([0.0; 3], -1.0, 1.0),
        range([1.0, 0.0, f64::NAN], 0.0, f64::INFINITY),
        range([1.0, 0.0, 0.0], -1.0, -0.5),
    ];
    let problems = WheelArray::try_new(&faulty, "/wheels").unwrap_err();
    let found: Vec<_> = problems
        .iter()
        .map(|p| (p.pointer.as_str(), p.code))
        .collect();
    assert_eq!(
        found,
        [
            ("/wheels/0/axis", Code::ZeroDirection),
            ("/wheels/1/axis/2", Code::NotFinite),
            ("/wheels/1/least", Code::EmptyRange),
            ("/wheels/1/most", Code::NotFinite),
            ("/wheels/2/most", Code::EmptyRange),
        ]
    );
    let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 0.0]];
    let flat = flat.map(|axis| WheelRange::symmetric(axis.into(), 1.0));
    for few in [&flat[..], &flat[..2], &[]] {
        let problems = WheelArray::try_new(few, "/wheels").unwrap_err();
        assert_eq!(problems[0].code, Code::WheelAxesCoplanar);
        assert_eq!(problems[0].pointer, "/wheels");
    }
}
