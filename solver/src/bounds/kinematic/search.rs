//! Branch and bound over the arc sequences that reach one target.

use super::RateBox;
use super::interior::{InteriorTurn, MARGIN, where_zero};
use super::levels::others;
use super::sequences::{ClosedFormSequence, FIRST, SequenceFamily, corner};
use super::terminal_arcs::{IMAGES, Probes, TerminalArcs};
use super::turns::{
    best_axis_sequence, cross, dot, eigenaxis_time, least_time, rotate, twist_and_swing,
};
use crate::math::quaternion::Quat;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Width below which cells are not split, rad.
const NARROW: f64 = 1e-9;
/// Turn of the interior over half a cell below which the terminal arcs are computed, rad.
const MAX_TURN_FOR_TERMINAL: f64 = 0.25;
/// Largest number of flips near an axis; the bound of longer sequences becomes part of the result.
const MAX_FLIPS: usize = 4096;
/// Rounding allowance for angles modulo a full turn, rad.
const WRAP: f64 = 1e-9;
/// Rounding of a cosine near one: a candidate that misses by less counts as reaching the target. If
/// it does not, its time is too low, which keeps the lower value valid: it is the minimum of all
/// bounds and of this time.
const ROUNDED_AWAY: f64 = 1e-15;
/// Number of cells after which a query ends with a weaker bound. Ordinary queries take hundreds.
/// Where one axis is a thousand times faster than another, sequences have thousands of flips, and
/// an unlimited query would take minutes.
const MAX_CELLS: usize = 100_000;
/// Capacity of the stack of cells: halving from a turn to `NARROW` takes 36 levels.
const STACK: usize = 160;

/// A motion: which sequence, with its normalised durations.
#[derive(Debug, Clone, Copy)]
pub(super) enum Candidate {
    /// The turn about its own axis.
    Eigenaxis,
    /// Three turns about body axes.
    Axes,
    /// A sequence with one free arc.
    ClosedForm {
        sequence: usize,
        image: usize,
        terminal: [f64; 2],
        parameter: f64,
    },
    /// A sequence of a family.
    Family {
        family: usize,
        first: usize,
        flips: usize,
        image: usize,
        terminal: [f64; 2],
        parameter: f64,
    },
}

/// The state of a query; all parts have a fixed size.
pub(super) struct SequenceSearch<'a> {
    table: &'a RateBox,
    q: Quat,
    /// Twist about each axis, in `[0, 2 pi)`, and swing away from it, rad.
    twists: [(f64, f64); 3],
    probes: Probes,
    stack: [(f64, f64); STACK],
    tolerance: f64,
    /// Smallest bound of the cells that are not split further, normalised.
    pub(super) lower: f64,
    /// Time of the best motion, normalised.
    pub(super) upper: f64,
    pub(super) best: Candidate,
    /// Number of cells so far.
    pub(super) cells: usize,
}

impl<'a> SequenceSearch<'a> {
    pub(super) fn new(table: &'a RateBox, q: &Quat, tolerance: f64) -> Self {
        let c = &table.levels.c;
        let (eigenaxis, axes) = (eigenaxis_time(q, c), best_axis_sequence(q, c).0);
        let (upper, best) = if axes < eigenaxis {
            (axes, Candidate::Axes)
        } else {
            (eigenaxis, Candidate::Eigenaxis)
        };
        Self {
            table,
            q: *q,
            twists: [0, 1, 2].map(|axis| twist_and_swing(q, axis)),
            stack: [(0.0, 0.0); STACK],
            probes: Probes::new(q, c),
            tolerance,
            lower: f64::INFINITY,
            upper,
            best,
            cells: 0,
        }
    }

    /// Searches all sequences that can be faster than the best motion.
    pub(super) fn run(&mut self) {
        let table = self.table;
        self.two_arcs();
        let (short, long) = table.closed_forms.split_at(table.promising);
        for (index, sequence) in short.iter().enumerate() {
            self.search_closed_form(sequence, index);
        }
        let floor = self.floor();
        for index in 0..table.families.len() {
            self.family(index, floor);
        }
        for (index, sequence) in long.iter().enumerate() {
            if sequence.fixed >= self.upper {
                break;
            }
            self.search_closed_form(sequence, table.promising + index);
        }
        if self.is_spent() {
            // The bound of everything that was not searched.
            self.keep_bound(self.swing_time().max(floor));
        }
    }

    /// Lower bound on the time to the target: a body axis is moved by the other two rates only.
    fn swing_time(&self) -> f64 {
        let c = &self.table.levels.c;
        let time = |axis: usize| {
            let (j, k) = others(axis);
            let swing = 2.0 * self.q[j].hypot(self.q[k]).min(1.0).asin();
            swing / c[j].hypot(c[k])
        };
        [0, 1, 2].map(time).into_iter().fold(0.0, f64::max)
    }

    fn is_spent(&self) -> bool {
        self.cells >= MAX_CELLS
    }

    /// Lower bound on the time to the target that needs no search.
    pub(super) fn floor(&self) -> f64 {
        least_time(&self.q, &self.table.levels.c)
    }

    /// Sequences of one and two arcs; the first flips of the three vertex families cover all of
    /// them.
    fn two_arcs(&mut self) {
        let c = self.table.levels.c;
        for (family, image) in (0..3).flat_map(|family| (0..4).map(move |image| (family, image))) {
            for first in 0..FIRST.len() {
                let last = self.table.families[family].octant(first, 1);
                let probe = self.probes.of(image, first, last);
                let value = dot(&corner(&c, FIRST[first]), &corner(&c, last));
                self.cells += 1;
                if (value - probe.target).abs() > MARGIN {
                    continue;
                }
                if let Some(terminal) = probe.terminal_arcs(&InteriorTurn::NONE.turn, MARGIN) {
                    let sequence = move |terminal| Candidate::Family {
                        family,
                        first,
                        flips: 1,
                        image,
                        terminal,
                        parameter: 0.0,
                    };
                    self.bound_cell(&terminal, 0.0, 0.0, f64::INFINITY, sequence);
                }
            }
        }
    }

    /// Tries the centre of a cell as a candidate and bounds the cell; returns whether it must be
    /// split.
    fn bound_cell(
        &mut self,
        terminal: &TerminalArcs,
        least_interior: f64,
        interior: f64,
        cap: f64,
        sequence: impl Fn([f64; 2]) -> Candidate,
    ) -> bool {
        let Some(least) = terminal.least(cap) else {
            return false;
        };
        let bound = least_interior + 2.0 * least;
        if bound >= self.upper {
            return false;
        }
        for (first, last, cosine) in terminal.candidates() {
            let mut time = interior + 2.0 * (first + last);
            let missing = 1.0 - cosine;
            if missing > ROUNDED_AWAY {
                // The missing turn takes no longer than about its own axis.
                time += 2.0 * (1.0 - missing).acos() / self.table.slowest;
            }
            if time < self.upper {
                self.upper = time;
                self.best = sequence([2.0 * first, 2.0 * last]);
            }
        }
        if bound < self.upper * (1.0 - self.tolerance) {
            return true;
        }
        self.lower = self.lower.min(bound);
        false
    }

    /// Searches a sequence whose equation is a sinusoid, with its roots in closed form.
    fn search_closed_form(&mut self, sequence: &ClosedFormSequence, index: usize) {
        for image in 0..4 {
            if sequence.fixed + sequence.range.0 >= self.upper {
                return;
            }
            let target = self.probes.of(image, sequence.first, sequence.last).target;
            let cosine = (target - sequence.offset) / sequence.amplitude;
            let margin = MARGIN / sequence.amplitude;
            if cosine.abs() > 1.0 + margin {
                continue;
            }
            let (middle, half) = if 1.0 - cosine.abs() > 100.0 * margin {
                // The slope of acos varies by less than 2 % over the margin.
                (
                    cosine.acos(),
                    1.02 * margin / (1.0 - cosine * cosine).sqrt(),
                )
            } else {
                let (wide, narrow) = (
                    (cosine - margin).max(-1.0).acos(),
                    (cosine + margin).min(1.0).acos(),
                );
                (0.5 * (wide + narrow), 0.5 * (wide - narrow) + WRAP)
            };
            for angle in [sequence.phase - middle, sequence.phase + middle] {
                let angle = angle.rem_euclid(TAU);
                // An angle near a full turn may be near zero within its error.
                let angle = if angle + half >= TAU {
                    angle - TAU
                } else {
                    angle
                };
                self.closed_form_cells(sequence, index, image, angle, half);
            }
        }
    }

    fn closed_form_cells(
        &mut self,
        sequence: &ClosedFormSequence,
        index: usize,
        image: usize,
        angle: f64,
        half: f64,
    ) {
        let mut open = 1;
        self.stack[0] = (angle, half);
        while open > 0 && !self.is_spent() {
            open -= 1;
            let (angle, half) = self.stack[open];
            let least = ((angle - half) / sequence.speed).max(sequence.range.0);
            let most = ((angle + half) / sequence.speed).min(sequence.range.1);
            if least > most || sequence.fixed + least >= self.upper {
                continue;
            }
            self.cells += 1;
            let (sin, cos) = (0.5 * angle).sin_cos();
            let interior = [0, 1, 2, 3].map(|i| cos * sequence.even[i] + sin * sequence.odd[i]);
            let probe = self.probes.of(image, sequence.first, sequence.last);
            let Some(terminal) = probe.terminal_arcs(&interior, 0.5 * (half + MARGIN)) else {
                continue;
            };
            let parameter = (angle / sequence.speed).clamp(least, most);
            let cap = if sequence.capped {
                0.5 * most + WRAP
            } else {
                f64::INFINITY
            };
            let candidate = move |terminal| Candidate::ClosedForm {
                sequence: index,
                image,
                terminal,
                parameter,
            };
            let split = self.bound_cell(
                &terminal,
                sequence.fixed + least,
                sequence.fixed + parameter,
                cap,
                candidate,
            );
            if split {
                if half < NARROW || open + 2 > STACK {
                    self.keep_bound(sequence.fixed + least + least_terminal_time(&terminal, cap));
                    continue;
                }
                self.stack[open] = (angle - 0.5 * half, 0.5 * half);
                self.stack[open + 1] = (angle + 0.5 * half, 0.5 * half);
                open += 2;
            }
        }
    }

    fn keep_bound(&mut self, bound: f64) {
        self.lower = self.lower.min(bound);
    }

    /// Searches the sequences of a family by their number of flips, until none can be faster.
    fn family(&mut self, index: usize, floor: f64) {
        let family = &self.table.families[index];
        // Sequences with two flips have a closed form.
        for flips in 3.. {
            let arcs = (flips - 1) as f64;
            let longest = family.range.1.min(self.upper / arcs);
            if longest < family.range.0 {
                return;
            }
            let bounds = match family.vertex {
                Some(axis) => self.by_twist(axis, longest),
                None => [floor; 2],
            };
            let mut any = false;
            for (first, image) in (0..2).flat_map(|first| (0..4).map(move |image| (first, image))) {
                let backwards = match family.vertex {
                    Some(axis) => (first == 1) != (IMAGES[image][axis] < 0.0),
                    None => false,
                };
                let least = bounds[usize::from(backwards)];
                if least >= self.upper * (1.0 - self.tolerance) || flips == MAX_FLIPS {
                    self.keep_bound(least);
                    continue;
                }
                any = true;
                let shortest = least.max(floor) / (flips + 1) as f64 - WRAP;
                let range = (shortest.max(family.range.0), longest);
                self.family_cells(family, [index, first, flips, image], range);
            }
            // More flips mean shorter arcs and a narrower cone: the bounds only rise.
            if !any || self.is_spent() {
                return;
            }
        }
    }

    /// Lower bounds on the times of sequences near an axis whose arcs are no longer than `longest`,
    /// for a positive and for a negative rate about the axis; infinite if the target's swing is too
    /// large.
    fn by_twist(&self, axis: usize, longest: f64) -> [f64; 2] {
        let levels = &self.table.levels;
        let cone = levels.cone(axis, longest);
        let (twist, swing) = self.twists[axis];
        if swing > 2.0 * cone + WRAP {
            return [f64::INFINITY; 2];
        }
        if cone >= FRAC_PI_2 {
            return [0.0; 2];
        }
        let (j, k) = others(axis);
        let drift = cone.tan() * levels.c[j].hypot(levels.c[k]);
        [twist, TAU - twist].map(|along| {
            let along = if along > TAU - WRAP { 0.0 } else { along };
            let forward = along / (levels.c[axis] + drift);
            if drift > levels.c[axis] {
                forward.min((TAU - along) / (drift - levels.c[axis]))
            } else {
                forward
            }
        })
    }

    fn family_cells(&mut self, family: &SequenceFamily, sequence: [usize; 4], range: (f64, f64)) {
        let [index, first, flips, image] = sequence;
        let c = self.table.levels.c;
        let arcs = (flips - 1) as f64;
        let last = family.octant(first, flips);
        let (begin, end) = (corner(&c, FIRST[first]), corner(&c, last));
        let target = self.probes.of(image, first, last).target;
        self.stack[0] = range;
        let mut open = 1;
        while open > 0 && !self.is_spent() {
            open -= 1;
            let (low, high) = self.stack[open];
            let high = high.min(self.upper / arcs);
            if low > high {
                continue;
            }
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            self.cells += 1;
            let interior = InteriorTurn::of(&c, family, first, flips, middle);
            let tip = rotate(&interior.turn, &end);
            let value = dot(&begin, &tip) - target;
            let slope = dot(&begin, &cross(&interior.velocity, &tip));
            // |f''| <= (sum of the speeds)^2, with corners of length one.
            let curvature = arcs * arcs;
            if value.abs() > slope.abs() * half + 0.5 * curvature * half * half + MARGIN {
                continue;
            }
            if open + 6 > STACK {
                self.keep_bound(arcs * low);
                continue;
            }
            if arcs * half < MAX_TURN_FOR_TERMINAL {
                let speed = dot(&interior.velocity, &interior.velocity).sqrt();
                let eta = speed * half + 0.5 * curvature * half * half;
                let probe = self.probes.of(image, first, last);
                let Some(terminal) = probe.terminal_arcs(&interior.turn, 0.5 * (eta + MARGIN))
                else {
                    continue;
                };
                let cap = 0.5 * high + WRAP;
                let candidate = move |terminal| Candidate::Family {
                    family: index,
                    first,
                    flips,
                    image,
                    terminal,
                    parameter: middle,
                };
                if !self.bound_cell(&terminal, arcs * low, arcs * middle, cap, candidate) {
                    continue;
                }
                if half < NARROW {
                    self.keep_bound(arcs * low + least_terminal_time(&terminal, cap));
                    continue;
                }
            }
            let parts = where_zero(value, slope, curvature, half);
            open = self.push_parts(open, middle, half, parts);
        }
    }

    /// Pushes parts of a cell, given relative to its middle, onto the stack; a part that is hardly
    /// narrower than the cell is halved. Returns the new height of the stack.
    fn push_parts(
        &mut self,
        mut open: usize,
        middle: f64,
        half: f64,
        parts: [Option<(f64, f64)>; 3],
    ) -> usize {
        for (from, to) in parts.into_iter().flatten() {
            if to - from > 1.2 * half {
                let cut = 0.5 * (from + to);
                self.stack[open] = (middle + from, middle + cut);
                self.stack[open + 1] = (middle + cut, middle + to);
                open += 2;
            } else {
                self.stack[open] = (middle + from, middle + to);
                open += 1;
            }
        }
        open
    }
}

/// Lower bound on the time of the terminal arcs of a cell.
fn least_terminal_time(terminal: &TerminalArcs, cap: f64) -> f64 {
    2.0 * terminal.least(cap).unwrap_or(0.0)
}
