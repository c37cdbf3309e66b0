//! The motion of a slew in physical units, and the same motion on other nodes.

use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use nalgebra::DVector;

/// States at nodes and the torques between them, of the commanded wheels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SlewMotion {
    /// Attitude at every node, continuous in sign.
    pub(super) attitudes: Vec<Attitude>,
    /// Wheel momenta at every node, N m s.
    pub(super) momenta: Vec<DVector<f64>>,
    /// Length of every interval, s.
    pub(super) lengths: Vec<f64>,
    /// Torque at the beginning of every interval, N m.
    pub(super) begin: Vec<DVector<f64>>,
    /// Torque at the end of every interval, N m.
    pub(super) end: Vec<DVector<f64>>,
}

impl SlewMotion {
    /// The motion of a profile, whose torques are constant on intervals.
    pub(super) fn of_profile(profile: &Profile) -> Self {
        let torques: Vec<_> = profile
            .wheels
            .windows(2)
            .zip(&profile.lengths)
            .map(|(pair, length)| {
                if *length > 0.0 {
                    (&pair[1] - &pair[0]) / *length
                } else {
                    DVector::zeros(pair[0].len())
                }
            })
            .collect();
        Self {
            attitudes: profile.attitudes.clone(),
            momenta: profile.wheels.clone(),
            lengths: profile.lengths.clone(),
            begin: torques.clone(),
            end: torques,
        }
    }

    /// The states at the nodes.
    pub(super) fn as_profile(&self) -> Profile {
        Profile {
            attitudes: self.attitudes.clone(),
            wheels: self.momenta.clone(),
            lengths: self.lengths.clone(),
        }
    }

    /// Duration, s.
    pub(super) fn duration(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Times of the nodes, s.
    pub(super) fn times(&self) -> Vec<f64> {
        let ends = self.lengths.iter().scan(0.0, |time, length| {
            *time += length;
            Some(*time)
        });
        std::iter::once(0.0).chain(ends).collect()
    }

    /// The same attitudes in another duration, s, with rates scaled accordingly. Torques of the result
    /// are constant between nodes.
    pub(super) fn stretched_to(&self, duration: f64, dynamics: &Dynamics) -> Self {
        if self.duration() == 0.0 {
            // One state all the time, at rest: another one would not last.
            let lengths = vec![duration / self.lengths.len() as f64; self.lengths.len()];
            return Self {
                lengths,
                ..self.clone()
            };
        }
        let factor = duration / self.duration();
        let slower = self.attitudes.iter().zip(&self.momenta).map(|(q, h)| {
            let rate = dynamics.rate(q, h) / factor;
            dynamics.wheels_at(q, &rate, &dynamics.null_component(h))
        });
        Self::of_profile(&Profile {
            attitudes: self.attitudes.clone(),
            wheels: slower.collect(),
            lengths: self.lengths.iter().map(|length| length * factor).collect(),
        })
    }

    /// The same attitudes and rates with these null-space momenta, N m s.
    pub(super) fn with_null_space(&self, null: &DVector<f64>, dynamics: &Dynamics) -> Self {
        let states = self.attitudes.iter().zip(&self.momenta);
        let wheels = states.map(|(q, h)| dynamics.wheels_at(q, &dynamics.rate(q, h), null));
        Self::of_profile(&Profile {
            attitudes: self.attitudes.clone(),
            wheels: wheels.collect(),
            lengths: self.lengths.clone(),
        })
    }

    /// The motion interpolated at other nodes, given by the lengths between them, s.
    pub(super) fn on_mesh(&self, lengths: &[f64]) -> Self {
        let times = self.times();
        let mut time = 0.0;
        let mut profile = Profile::empty();
        for length in std::iter::once(&0.0).chain(lengths) {
            time += length;
            let after = times.partition_point(|t| *t <= time);
            let k = after.saturating_sub(1).min(self.lengths.len() - 1);
            let share = if self.lengths[k] > 0.0 {
                ((time - times[k]) / self.lengths[k]).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let turn = self.attitudes[k].signed_turn_to(&self.attitudes[k + 1]);
            profile
                .attitudes
                .push(self.attitudes[k].retract(turn * share));
            profile
                .wheels
                .push(&self.momenta[k] * (1.0 - share) + &self.momenta[k + 1] * share);
        }
        profile.lengths = lengths.to_vec();
        Self::of_profile(&profile)
    }

    /// The motion interpolated on a number of equal intervals.
    pub(super) fn on_equal_mesh(&self, intervals: usize) -> Self {
        self.on_mesh(&vec![self.duration() / intervals as f64; intervals])
    }

    /// The motion on at least as many intervals, made by cutting its own, the longest first.
    pub(super) fn on_finer_mesh(&self, intervals: usize) -> Self {
        let mut parts = vec![1_usize; self.lengths.len()];
        for _ in self.lengths.len()..intervals {
            let length = |k: usize| self.lengths[k] / parts[k] as f64;
            let longest = (0..parts.len()).max_by(|a, b| length(*a).total_cmp(&length(*b)));
            if let Some(longest) = longest {
                parts[longest] += 1;
            }
        }
        let lengths: Vec<_> = parts
            .iter()
            .zip(&self.lengths)
            .flat_map(|(parts, length)| std::iter::repeat_n(length / *parts as f64, *parts))
            .collect();
        self.on_mesh(&lengths)
    }

    /// The torque at a node: the mean of those before and after it, N m.
    pub(super) fn node_torque(&self, node: usize) -> DVector<f64> {
        match (node.checked_sub(1), self.begin.get(node)) {
            (Some(before), Some(after)) => (&self.end[before] + after) * 0.5,
            (Some(before), None) => self.end[before].clone(),
            (None, _) => self.begin[0].clone(),
        }
    }
}
