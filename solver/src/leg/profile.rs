//! The discretised motion of the optimiser: states at nodes and the time between them.

use crate::model::attitude::Attitude;
use crate::model::motion::Motion;
use nalgebra::DVector;
use std::ops::Range;

/// A motion with constant torque between nodes. As a starting guess it need neither satisfy the
/// dynamics nor keep the limits.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Profile {
    /// Attitude at every node, continuous in sign.
    pub(crate) attitudes: Vec<Attitude>,
    /// Wheel momenta at every node, N m s.
    pub(crate) wheels: Vec<DVector<f64>>,
    /// Time between nodes, s.
    pub(crate) lengths: Vec<f64>,
}

impl Profile {
    /// Duration, s.
    pub(crate) fn duration(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Number of intervals.
    pub(crate) fn intervals(&self) -> usize {
        self.lengths.len()
    }

    /// Appends a motion that begins where this one ends, with its quaternion signs made to match.
    pub(crate) fn append(&mut self, next: &Profile) {
        let flip = match (self.attitudes.last(), next.attitudes.first()) {
            (Some(here), Some(there)) => there.nearest_sign(here) != *there,
            _ => false,
        };
        let skip = usize::from(!self.attitudes.is_empty());
        let signed = |a: &Attitude| if flip { a.negated() } else { *a };
        self.attitudes
            .extend(next.attitudes.iter().skip(skip).map(signed));
        self.wheels.extend(next.wheels.iter().skip(skip).cloned());
        self.lengths.extend_from_slice(&next.lengths);
    }

    /// The motion over some of its intervals.
    pub(crate) fn part(&self, intervals: Range<usize>) -> Self {
        let nodes = intervals.start..=intervals.end;
        Self {
            attitudes: self.attitudes[nodes.clone()].to_vec(),
            wheels: self.wheels[nodes].to_vec(),
            lengths: self.lengths[intervals].to_vec(),
        }
    }

    /// An empty motion to append to.
    pub(crate) fn empty() -> Self {
        Self {
            attitudes: Vec::new(),
            wheels: Vec::new(),
            lengths: Vec::new(),
        }
    }

    /// No motion: the same state at every node, and intervals of no length.
    pub(crate) fn zero_length(attitude: Attitude, wheels: DVector<f64>, intervals: usize) -> Self {
        Self {
            attitudes: vec![attitude; intervals + 1],
            wheels: vec![wheels; intervals + 1],
            lengths: vec![0.0; intervals],
        }
    }

    /// Inserts intervals of no length at a node.
    pub(crate) fn pause_at(&mut self, node: usize, intervals: usize) {
        let (attitude, wheels) = (self.attitudes[node], self.wheels[node].clone());
        self.attitudes
            .splice(node..node, std::iter::repeat_n(attitude, intervals));
        self.wheels
            .splice(node..node, std::iter::repeat_n(wheels, intervals));
        self.lengths
            .splice(node..node, std::iter::repeat_n(0.0, intervals));
    }

    /// The motion reversed in time: wheel momenta change sign, torques do not.
    pub(crate) fn reversed(&self) -> Self {
        Self {
            attitudes: self.attitudes.iter().rev().copied().collect(),
            wheels: self.wheels.iter().rev().map(|h| -h).collect(),
            lengths: self.lengths.iter().rev().copied().collect(),
        }
    }
}

impl From<&Profile> for Motion {
    fn from(profile: &Profile) -> Self {
        let momenta = profile.wheels.iter();
        Self {
            attitudes_xyzw: profile.attitudes.iter().map(Attitude::xyzw).collect(),
            wheel_momenta_nms: momenta.map(|h| h.as_slice().to_vec()).collect(),
            lengths_s: profile.lengths.clone(),
        }
    }
}

impl Profile {
    /// The motion of these numbers, bit for bit; `None` unless there is one unit quaternion and one
    /// vector of momenta a node.
    pub(crate) fn from_motion(motion: Motion) -> Option<Self> {
        let attitudes = motion.attitudes_xyzw.into_iter();
        let attitudes: Option<Vec<_>> = attitudes.map(Attitude::from_unit_xyzw).collect();
        let wheels = motion.wheel_momenta_nms.into_iter();
        let profile = Self {
            attitudes: attitudes?,
            wheels: wheels.map(DVector::from_vec).collect(),
            lengths: motion.lengths_s,
        };
        let nodes = profile.intervals() + 1;
        (profile.attitudes.len() == nodes && profile.wheels.len() == nodes).then_some(profile)
    }
}
