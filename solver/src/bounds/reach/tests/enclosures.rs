//! Rounded boxes and tubes, beside points and members of their own.

use super::super::form::{Form, VectorForm, each};
use super::super::profile::Piece;
use super::super::rounded_box::{level_of, support, support_form};
use super::super::tube::Tube;
use super::number;
use crate::math::random::SplitMix;
use nalgebra::{Matrix3, Rotation3, Vector3};

fn vector(random: &mut SplitMix) -> Vector3<f64> {
    Vector3::from_fn(|_, _| number(random, -1.0, 1.0))
}

/// A direction, often near an axis.
fn direction(random: &mut SplitMix) -> Vector3<f64> {
    let mut v = vector(random);
    for i in 0..3 {
        if random.below(3) == 0 {
            v[i] *= 0.05;
        }
    }
    v.normalize()
}

/// The value of a form at a place, and by how much it may be off.
fn at(form: &Form, place: &Vector3<f64>) -> (f64, f64) {
    let known: f64 = (0..3).map(|k| form.slopes[k] * place[k]).sum();
    let unknown: f64 = form.slopes[3..].iter().map(|x| x.abs()).sum();
    (form.middle + known, unknown + form.rest)
}

fn exactly(v: &Vector3<f64>) -> VectorForm {
    each(|i| Form::exactly(v[i]))
}

#[test]
fn the_support_point_is_the_farthest_one_of_a_set_around_the_box() {
    let mut random = SplitMix::new(1);
    let m = [0.018, 0.013, 0.005];
    for _ in 0..20_000 {
        let u = direction(&mut random);
        let point = Vector3::from(support(u.into(), m));
        let level = level_of(&exactly(&u), m);
        let other = direction(&mut random);
        let elsewhere = Vector3::from(support(other.into(), m));
        let corner: f64 = (0..3).map(|i| m[i] * u[i].abs()).sum();
        assert!((point.dot(&u) - level.middle).abs() < 1e-12, "{u}");
        assert!(elsewhere.dot(&u) <= level.middle + 1e-12, "{u} {other}");
        assert!(corner <= level.middle + 1e-12, "{u}");
    }
}

#[test]
fn forms_enclose_the_support_of_every_place() {
    let mut random = SplitMix::new(2);
    let m = [0.018, 0.013, 0.005];
    for _ in 0..20_000 {
        let (u, width) = (direction(&mut random), number(&mut random, 0.0, 0.2));
        let slopes = Matrix3::from_fn(|_, _| number(&mut random, -width, width));
        let place = vector(&mut random);
        // Forms of a tube are of costates of length one: so is the one at this place.
        let there = u + slopes * place;
        let length = there.norm();
        let forms: VectorForm = each(|i| {
            let mut form = Form::exactly(u[i] / length);
            for k in 0..3 {
                form.slopes[k] = slopes[(i, k)] / length;
            }
            form
        });
        let there = there / length;
        let point = support(there.into(), m);
        let enclosed = support_form(&forms, m);
        for i in 0..3 {
            let (value, off) = at(&enclosed[i], &place);
            assert!((value - point[i]).abs() <= off + 1e-16, "{forms:?} {i}");
        }
        let (level, off) = at(&level_of(&forms, m), &place);
        let exact = Vector3::from(point).dot(&there);
        assert!((level - exact).abs() <= off + 1e-15, "{forms:?}");
    }
}

/// A member of a tube, followed in short steps.
fn member(pieces: &[Piece], costate: &Vector3<f64>, scale: f64) -> Matrix3<f64> {
    let steps = 8000;
    let mut turn = Matrix3::identity();
    for piece in pieces {
        let h = piece.length / f64::from(steps);
        for step in 0..steps {
            let rate = |turn: &Matrix3<f64>, share: f64| {
                let u = turn.transpose() * costate;
                let m = piece.at((f64::from(step) + share) / f64::from(steps));
                Vector3::from(support(u.into(), m)) * scale
            };
            let half = turn * Rotation3::new(rate(&turn, 0.0) * (0.5 * h)).matrix();
            turn *= Rotation3::new(rate(&half, 0.5) * h).matrix();
        }
    }
    turn
}

#[test]
fn tubes_enclose_their_members() {
    let mut random = SplitMix::new(3);
    let (mut followed, mut thin) = (0, 0);
    for _ in 0..150 {
        let m = each(|_| number(&mut random, 0.01, 0.02));
        let begin = each(|i| if random.below(2) == 0 { m[i] } else { 1e-7 });
        let pieces = [
            Piece {
                length: number(&mut random, 5.0, 12.0),
                limits: [begin, m],
            },
            Piece {
                length: number(&mut random, 5.0, 40.0),
                limits: [m, m],
            },
        ];
        let costate = direction(&mut random);
        // Some are members alone: their rest is that of the steps in time.
        let width = [0.0, 0.003, 0.01, 0.03][random.below(4)];
        let slopes = Matrix3::from_fn(|_, k| {
            if k < 2 {
                width * number(&mut random, -1.0, 1.0)
            } else {
                0.0
            }
        });
        let place = vector(&mut random);
        let (middle, spread) = (
            number(&mut random, 0.9, 0.95),
            number(&mut random, 0.0, (2.0 * width).min(0.05)),
        );
        let there = (costate + slopes * place).normalize();
        let forms = each(|i| {
            // Of length one at every place, up to the curvature.
            let mut form = Form::within(costate[i], 10.0 * width * width);
            let along = costate.dot(&slopes.column(0)) * costate[i];
            let across = costate.dot(&slopes.column(1)) * costate[i];
            form.slopes[0] = slopes[(i, 0)] - along;
            form.slopes[1] = slopes[(i, 1)] - across;
            form
        });
        let mut scale = Form::exactly(middle);
        scale.slopes[2] = spread;
        let mut tube = Tube::new(forms, scale, begin);
        let mut budget = 100_000;
        if pieces
            .iter()
            .any(|piece| tube.follow(piece, 0.5, &mut budget).is_err())
        {
            continue;
        }
        followed += 1;
        let turn = member(&pieces, &there, middle + spread * place.z);
        let off = turn * tube.middle.transpose();
        let off = Rotation3::from_matrix(&off).scaled_axis();
        for i in 0..3 {
            let (value, rest) = at(&tube.deviation[i], &place);
            assert!(
                (value - off[i]).abs() <= rest + 2e-8,
                "{:?} {off}",
                tube.deviation
            );
            thin += usize::from(rest < 0.01);
        }
        let u = turn.transpose() * there;
        let (level, rest) = at(&tube.level, &place);
        let exact = Vector3::from(support(u.into(), m)).dot(&u);
        assert!(
            (level - exact).abs() <= rest + 1e-7 * m[0],
            "{level} {exact} {rest}"
        );
    }
    // Wide enclosures would prove nothing.
    assert!(followed > 60 && thin > followed, "{followed} {thin}");
}
