//! Points and great circles of the unit sphere in three or four dimensions.

/// A point of the unit sphere.
pub(super) type Point<const D: usize> = [f64; D];

/// Scalar product.
pub(super) fn dot<const D: usize>(a: &Point<D>, b: &Point<D>) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `a x + b y`.
pub(super) fn combined<const D: usize>(a: f64, x: &Point<D>, b: f64, y: &Point<D>) -> Point<D> {
    std::array::from_fn(|i| a * x[i] + b * y[i])
}

/// The opposite point.
pub(super) fn opposite<const D: usize>(x: &Point<D>) -> Point<D> {
    x.map(|component| -component)
}

/// A vector scaled to the sphere; `None` for a vector without a direction.
pub(super) fn unit<const D: usize>(x: &Point<D>) -> Option<Point<D>> {
    let length = dot(x, x).sqrt();
    (length > 1e-12).then(|| x.map(|component| component / length))
}

/// Angle between two points, rad.
pub(super) fn angle<const D: usize>(a: &Point<D>, b: &Point<D>) -> f64 {
    let apart = combined(1.0, a, -1.0, b);
    let middle = combined(1.0, a, 1.0, b);
    2.0 * dot(&apart, &apart)
        .sqrt()
        .atan2(dot(&middle, &middle).sqrt())
}

/// The shorter arc of the great circle through two points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc<const D: usize> {
    /// Where it begins.
    pub(super) from: Point<D>,
    /// Unit tangent there.
    pub(super) tangent: Point<D>,
    /// Its length, rad.
    pub(super) length: f64,
}

impl<const D: usize> Arc<D> {
    /// From one point to another; between opposite points, one of the many.
    pub(super) fn between(from: &Point<D>, to: &Point<D>) -> Self {
        let across = combined(1.0, to, -dot(from, to), from);
        let tangent = unit(&across).unwrap_or_else(|| perpendicular(from));
        Self {
            from: *from,
            tangent,
            length: angle(from, to),
        }
    }

    /// The point so far along it, rad.
    pub(super) fn at(&self, along: f64) -> Point<D> {
        let (sine, cosine) = along.sin_cos();
        combined(cosine, &self.from, sine, &self.tangent)
    }

    /// So many points in equal distances, the end included and the beginning not.
    pub(super) fn points(&self, count: usize) -> impl Iterator<Item = Point<D>> + '_ {
        (1..=count).map(move |i| self.at(self.length * i as f64 / count as f64))
    }
}

/// Some unit vector perpendicular to a point.
fn perpendicular<const D: usize>(x: &Point<D>) -> Point<D> {
    let least = (0..D).min_by(|i, j| x[*i].abs().total_cmp(&x[*j].abs()));
    let mut axis = [0.0; D];
    if let Some(least) = least {
        axis[least] = 1.0;
    }
    unit(&combined(1.0, &axis, -dot(&axis, x), x)).unwrap_or(axis)
}
