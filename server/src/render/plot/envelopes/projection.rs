//! A projection of envelopes, with the paths of slews inside.

use super::written::{Array, WrittenPolytope};
use crate::render::plot::canvas::{Canvas, Ink, LINE, Pen, PlotArea, SERIES, WARM};
use nalgebra::Vector3;

/// Direction of the viewer in body axes.
const TOWARDS_VIEWER: [f64; 3] = [0.45, -0.8, 0.4];
/// Share of the frame that the envelope takes.
const FILLED: f64 = 0.42;
/// Distance of the name of an axis from the centre, as a multiple of that of the surface.
const BEYOND: f64 = 1.1;

/// A path in an envelope.
pub(super) struct ProjectedPath {
    pub(super) points: Vec<Vector3<f64>>,
    /// Whether it is continuous; else it jumps from point to point.
    pub(super) joined: bool,
}

/// The projection from body axes to points of the picture.
struct EnvelopeView {
    right: Vector3<f64>,
    up: Vector3<f64>,
    near: Vector3<f64>,
    middle: (f64, f64),
    scale: f64,
}

impl EnvelopeView {
    fn of(frame: PlotArea, radius: f64) -> Self {
        let near = Vector3::from(TOWARDS_VIEWER).normalize();
        let right = Vector3::z().cross(&near).normalize();
        Self {
            up: near.cross(&right),
            right,
            near,
            middle: (
                frame.left + 0.5 * frame.width,
                frame.top + 0.5 * frame.height,
            ),
            scale: FILLED * frame.width.min(frame.height) / radius,
        }
    }

    fn at(&self, point: &Vector3<f64>) -> (f64, f64) {
        let (x, y) = self.middle;
        (
            x + self.scale * self.right.dot(point),
            y - self.scale * self.up.dot(point),
        )
    }

    fn faces(&self, normal: [f64; 3]) -> bool {
        self.near.dot(&Vector3::from(normal)) > 0.0
    }

    /// The facets of one side.
    fn outline(&self, canvas: &mut Canvas, of: &WrittenPolytope, front: bool, pen: Pen) {
        let facets = of.facets.iter();
        for facet in facets.filter(|facet| self.faces(facet.normal) == front) {
            let corners: Vec<_> = of.corners(facet).map(|corner| self.at(&corner)).collect();
            canvas.area(&corners, "none", pen);
        }
    }
}

/// Draws both envelopes of an array, and one path per slew in its colour.
pub(super) fn draw(canvas: &mut Canvas, frame: PlotArea, array: &Array, ways: &[ProjectedPath]) {
    let view = EnvelopeView::of(frame, array.full.greatest_radius);
    let far = Pen::new(LINE, 1.0).dashed().faded(0.7);
    view.outline(canvas, &array.full, false, far);
    axes(canvas, &view, &array.full);
    let inner = Pen::new(WARM, 1.0);
    view.outline(
        canvas,
        &array.pseudo_inverse,
        false,
        inner.dashed().faded(0.5),
    );
    view.outline(canvas, &array.pseudo_inverse, true, inner.faded(0.8));
    for (way, colour) in ways.iter().zip(SERIES.iter().cycle()) {
        let points: Vec<_> = way.points.iter().map(|point| view.at(point)).collect();
        let pen = Pen::new(colour, 2.0);
        if way.joined {
            canvas.path(&points, pen);
        } else {
            canvas.path(&points, Pen::new(colour, 1.0).dashed().faded(0.6));
            for point in points {
                canvas.circle(point, 3.0, colour, Pen::new(colour, 0.0));
            }
        }
    }
    view.outline(canvas, &array.full, true, Pen::new("#5A6772", 1.2));
}

/// The body axes up to the surface.
fn axes(canvas: &mut Canvas, view: &EnvelopeView, within: &WrittenPolytope) {
    for (name, axis) in [
        ("x", Vector3::x()),
        ("y", Vector3::y()),
        ("z", Vector3::z()),
    ] {
        let end = axis / within.share(&axis);
        canvas.line(
            view.at(&Vector3::zeros()),
            view.at(&end),
            Pen::new(LINE, 1.0),
        );
        let (x, y) = view.at(&(end * BEYOND));
        canvas.text(x, y + 4.0, Ink::SMALL.middle(), name);
    }
}
