//! Random problems against a search of another kind.

use super::*;
use crate::math::random::SplitMix;

struct Random {
    cones: Vec<ForbiddenCone>,
    from: Attitude,
    to: Attitude,
}

fn unit_vector(random: &mut SplitMix) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.normal()).normalize()
}

fn uniform(random: &mut SplitMix) -> f64 {
    random.below(1 << 30) as f64 / f64::from(1 << 30)
}

fn attitude(random: &mut SplitMix) -> Attitude {
    Attitude::from_xyzw(std::array::from_fn(|_| random.normal())).expect("a direction")
}

/// One to three cones of one or two boresights between two allowed ends, where the direct way is
/// not clear.
fn problem_of(seed: u64, boresights: usize) -> Random {
    let mut random = SplitMix::member(61, seed);
    let axes: Vec<_> = (0..boresights).map(|_| unit_vector(&mut random)).collect();
    loop {
        let count = boresights + random.below(4 - boresights);
        let cones: Vec<_> = (0..count)
            .map(|i| {
                let (boresight, axis) = (axes[i % boresights], unit_vector(&mut random));
                if random.below(6) == 0 {
                    keep_in(boresight, axis, 75.0)
                } else {
                    cone(boresight, axis, 15.0 + 50.0 * uniform(&mut random))
                }
            })
            .collect();
        let (from, to) = (attitude(&mut random), attitude(&mut random));
        let allowed = [from, to].iter().all(|q| clearance(&cones, q) >= 0.0);
        if allowed && sampled(&cones, &from, &to.nearest_sign(&from), 200) < 0.0 {
            return Random { cones, from, to };
        }
    }
}

/// Whether random attitudes, each joined to those near it where samples are clear, connect both ends
/// (probabilistic roadmap: Kavraki and others 1996).
fn roadmap_connects(given: &Random, seed: u64) -> bool {
    let mut random = SplitMix::member(62, seed);
    let mut nodes = vec![given.from, given.to];
    while nodes.len() < 700 {
        let q = attitude(&mut random);
        if clearance(&given.cones, &q) > 0.0 {
            nodes.push(q);
        }
    }
    let (mut reached, mut open) = (vec![false; nodes.len()], vec![0]);
    reached[0] = true;
    while let Some(at) = open.pop() {
        for other in 0..nodes.len() {
            let near = !reached[other] && nodes[at].angle_to(&nodes[other]) < 0.7;
            let to = nodes[other].nearest_sign(&nodes[at]);
            if near && sampled(&given.cones, &nodes[at], &to, 40) > 1e-3 {
                reached[other] = true;
                open.push(other);
            }
        }
    }
    reached[1]
}

/// Solves a problem and compares with a roadmap: what that connects is solved, and what is proved to
/// be disconnected it does not connect.
fn compared(given: &Random, seed: u64) -> PathOutcome {
    let problem = problem(&given.cones, given.from, given.to);
    let search = find(&problem);
    match &search.outcome {
        PathOutcome::Found(attitudes) => {
            keeps_clear(&problem, attitudes);
        }
        PathOutcome::Disconnected | PathOutcome::Unknown { .. } => {
            assert!(!roadmap_connects(given, seed), "{seed}");
        }
    }
    // One refusal over attitudes may use all cells, with those of the proofs.
    assert!(search.cells <= 160_000, "{seed}: {}", search.cells);
    search.outcome
}

#[test]
fn what_a_random_roadmap_connects_is_solved() {
    let mut solved = 0;
    for seed in 0..90 {
        let boresights = 1 + usize::try_from(seed % 3).expect("below 3");
        let outcome = compared(&problem_of(seed, boresights), seed);
        solved += usize::from(matches!(outcome, PathOutcome::Found(_)));
    }
    assert!(solved > 80, "{solved}");
}

#[test]
fn crowded_problems_are_solved_or_proved_to_have_no_path() {
    let (mut solved, mut proved) = (0, 0);
    for seed in 0..40 {
        let mut random = SplitMix::member(64, seed);
        let axes = [unit_vector(&mut random), unit_vector(&mut random)];
        let boresights = 1 + random.below(2);
        let given = loop {
            let cones: Vec<_> = (0..18 * boresights)
                .map(|i| {
                    let half_angle = 25.0 + 25.0 * uniform(&mut random);
                    cone(axes[i % boresights], unit_vector(&mut random), half_angle)
                })
                .collect();
            let (from, to) = (attitude(&mut random), attitude(&mut random));
            if [from, to].iter().all(|q| clearance(&cones, q) >= 0.0) {
                break Random { cones, from, to };
            }
        };
        match compared(&given, seed) {
            PathOutcome::Found(_) => solved += 1,
            PathOutcome::Disconnected => proved += 1,
            PathOutcome::Unknown { .. } => {}
        }
    }
    assert!(solved > 8 && proved > 8, "{solved} {proved}");
}

#[test]
fn problems_turned_as_a_whole_have_paths_of_the_same_length() {
    let mut random = SplitMix::new(63);
    let mut ratios = Vec::new();
    for seed in 0..30 {
        let given = problem_of(seed, 1 + usize::try_from(seed % 2).expect("0 or 1"));
        let problem = problem(&given.cones, given.from, given.to);
        let turn = attitude(&mut random);
        let body = attitude(&mut random);
        let turned: Vec<_> = given
            .cones
            .iter()
            .map(|cone| ForbiddenCone {
                axis: body.to_body(cone.axis),
                direction: turn.to_reference(cone.direction),
                ..*cone
            })
            .collect();
        let along = |q: &Attitude| turn.then_in_body(q).then_in_body(&body);
        let turned = PathProblem {
            cones: &turned,
            from: along(&given.from),
            to: along(&given.to),
            signed: false,
        };
        let is_found = |p| matches!(find(p).outcome, PathOutcome::Found(_));
        assert_eq!(is_found(&problem), is_found(&turned), "{seed}");
        if is_found(&problem) {
            ratios.push(path(&turned).1 / path(&problem).1);
        }
    }
    // Cells are in other places then, so that now and then the path goes the other way round.
    ratios.sort_by(f64::total_cmp);
    let middle = &ratios[ratios.len() / 6..ratios.len() * 5 / 6];
    assert!(middle.iter().all(|r| (r - 1.0).abs() < 0.03), "{ratios:?}");
    assert!(ratios.iter().all(|r| *r > 0.5 && *r < 2.0), "{ratios:?}");
}
