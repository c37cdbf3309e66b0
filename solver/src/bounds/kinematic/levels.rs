//! The level curves of `H(M) = c . |M|` on the sphere of costates, for rates `c` of length one.
//!
//! In folded coordinates `m = |M|` a level is the circle `m . c = h`. It leaves the positive octant
//! through the *walls*: arcs about the azimuth `b_i + pi` (`b_i` that of `e_i` about `c`), of
//! half-width `acos(h c_i / (g_i sqrt(1 - h^2)))`, `g_i = sqrt(1 - c_i^2)`, which vanish at the
//! saddle `h_i = g_i`. What is left between two walls is a *gap*; all interior arcs of an extremal
//! last as long as its gap.

use std::f64::consts::{PI, TAU};

/// Widening of the lengths of gaps, rad: `acos` loses half the digits at a saddle, and a range that
/// is too wide only adds feasible motions.
pub(super) const RANGE_SLACK: f64 = 1e-7;
/// Relative difference below which two rates are made equal.
pub(super) const EQUAL: f64 = 1e-7;
/// Entries of the table of cones per halving of the gap.
const CONES_PER_OCTAVE: u32 = 3;
/// Halvings of the gap that the table spans.
const OCTAVES: u32 = 14;
/// Bisections for a level; each halves its error relative to its height above the minimum.
const BISECTIONS: usize = 6;

/// Quantities that depend on the rates only.
#[derive(Debug, Clone)]
pub(super) struct Levels {
    /// The rates, of length one.
    pub(super) c: [f64; 3],
    /// Levels of the saddles `M_j = 0`.
    pub(super) saddle: [f64; 3],
    /// Azimuths of the body axes about `c`.
    pub(super) azimuth: [f64; 3],
    /// Azimuth between the two axes other than `i`.
    opening: [f64; 3],
    /// Largest angle of the costate from axis `i`, by the length of its gap.
    cones: [Vec<f64>; 3],
}

/// The two axes after an axis, in cyclic order.
pub(super) fn others(i: usize) -> (usize, usize) {
    ((i + 1) % 3, (i + 2) % 3)
}

impl Levels {
    /// The levels for positive rates of length one.
    pub(super) fn new(c: [f64; 3]) -> Self {
        // The projections of two body axes on the plane normal to c are at an angle whose cosine is
        // -c_i c_j / (g_i g_j): always obtuse, in the order of a right-handed frame.
        let g = c.map(|c| (1.0 - c * c).sqrt());
        let between = |i: usize, j: usize| (-c[i] * c[j] / (g[i] * g[j])).clamp(-1.0, 1.0).acos();
        let mut levels = Self {
            c,
            saddle: g,
            azimuth: [0.0, between(0, 1), TAU - between(0, 2)],
            opening: [between(1, 2), between(2, 0), between(0, 1)],
            cones: [const { Vec::new() }; 3],
        };
        for i in 0..3 {
            let longest = levels.longest_gap(i);
            let mut level = levels.last_level(i);
            levels.cones[i] = (0..=CONES_PER_OCTAVE * OCTAVES)
                .map(|k| {
                    let shrunk = (-f64::from(k) / f64::from(CONES_PER_OCTAVE)).exp2();
                    level = levels.level_of(i, longest * shrunk, level);
                    levels.cone_on(i, level)
                })
                .collect();
        }
        levels
    }

    /// Whether two rates are equal, so that their saddles are on one circle. Different rates differ
    /// by a share of at least [`EQUAL`].
    pub(super) fn same_rate(&self, i: usize, j: usize) -> bool {
        (self.c[i] - self.c[j]).abs() < 0.5 * EQUAL * self.c[j]
    }

    /// Half-width of wall `i` on a level, rad.
    pub(super) fn half_width(&self, i: usize, h: f64) -> f64 {
        if h >= self.saddle[i] {
            return 0.0;
        }
        let cosine = h * self.c[i] / ((1.0 - h * h).sqrt() * self.saddle[i]);
        cosine.min(1.0).acos()
    }

    /// Length of the gap about axis `i` on a level, rad.
    fn gap(&self, i: usize, h: f64) -> f64 {
        let (j, k) = others(i);
        self.opening[i] - self.half_width(j, h) - self.half_width(k, h)
    }

    /// The level on which the gap about axis `i` ends by meeting a saddle.
    fn last_level(&self, i: usize) -> f64 {
        let (j, k) = others(i);
        self.saddle[j].min(self.saddle[k])
    }

    /// Length of the longest gap about axis `i`, rad.
    pub(super) fn longest_gap(&self, i: usize) -> f64 {
        self.gap(i, self.last_level(i)) + RANGE_SLACK
    }

    /// Length of the gap on the far side of axis `i`, where its wall has vanished, rad.
    pub(super) fn far_gap(&self, i: usize, h: f64) -> f64 {
        let (j, k) = others(i);
        TAU - self.opening[i] - self.half_width(j, h) - self.half_width(k, h)
    }

    /// Length of the gap where the wall `i` alone is left, rad.
    pub(super) fn single_wall_gap(&self, i: usize, h: f64) -> f64 {
        TAU - 2.0 * self.half_width(i, h)
    }

    /// Largest angle of the costate from axis `i` on all levels whose gap is at most `gap`, rad.
    pub(super) fn cone(&self, i: usize, gap: f64) -> f64 {
        let octaves = (self.longest_gap(i) / gap).log2().max(0.0);
        // Rounded to the longer gap; the cone widens with the gap.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and large values saturate"
        )]
        let entry = (octaves * f64::from(CONES_PER_OCTAVE) - 1e-9).max(0.0) as usize;
        self.cones[i][entry.min(self.cones[i].len() - 1)]
    }

    /// The level on which the gap about axis `i` has the length `gap`, rounded up; at most `highest`.
    fn level_of(&self, i: usize, gap: f64, highest: f64) -> f64 {
        if self.gap(i, highest) <= gap {
            return highest;
        }
        // Bisection from the minimum, where the gap vanishes. Its error only widens the cone.
        let longer = |above: f64| self.gap(i, self.c[i] + above) >= gap;
        let mut high = highest - self.c[i];
        while longer(0.5 * high) && high > f64::EPSILON {
            high *= 0.5;
        }
        let mut low = 0.5 * high;
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if longer(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        self.c[i] + high
    }

    /// The largest angle of the costate from axis `i` on a level.
    fn cone_on(&self, i: usize, level: f64) -> f64 {
        // On the circle m_i is least at the walls, where one other component is zero:
        // c_i cos x + c_o sin x = h, first root.
        let (j, k) = others(i);
        let root = |o: usize| {
            let length = self.c[i].hypot(self.c[o]);
            self.c[o].atan2(self.c[i]) - (level / length).min(1.0).acos()
        };
        root(j).max(root(k)).clamp(0.0, PI) + RANGE_SLACK
    }
}
