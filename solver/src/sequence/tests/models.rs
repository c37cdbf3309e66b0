//! Cost models in place of slews.

pub(super) use crate::sequence::heuristics::SplitMix;
use crate::sequence::{Evaluation, OrderRules, Place, TourEvaluation, TourModel};

/// A number in `[0, 1)`.
pub(in crate::sequence) fn unit(random: &mut SplitMix) -> f64 {
    (random.draw() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Legs with random costs, and a random penalty on every two consecutive legs.
///
/// The pair bounds are the costs without penalties; the bound of a prefix knows a share of the
/// penalties inside it: admissible, and not tight.
pub(in crate::sequence) struct RandomModel {
    targets: usize,
    has_end: bool,
    legs: Vec<f64>,
    penalties: Vec<f64>,
    /// Which orders may be flown.
    pub(in crate::sequence) rules: OrderRules,
    /// Share of the penalties that the bound of a prefix knows.
    pub(in crate::sequence) known_share: f64,
    /// Orders and prefixes for which this holds do not resolve.
    pub(in crate::sequence) fails: fn(&[usize]) -> bool,
}

impl RandomModel {
    pub(in crate::sequence) fn new(targets: usize, has_end: bool, seed: u64) -> Self {
        let places = targets + 2;
        let mut random = SplitMix::new(seed);
        Self {
            targets,
            has_end,
            legs: (0..places * places)
                .map(|_| 10.0 + 40.0 * unit(&mut random))
                .collect(),
            penalties: (0..places.pow(3))
                .map(|_| 15.0 * unit(&mut random))
                .collect(),
            rules: OrderRules::none(targets),
            known_share: 0.7,
            fails: |_| false,
        }
    }

    /// Costs of 0, 1 or 2 only and no penalties: ties everywhere.
    pub(in crate::sequence) fn with_ties(targets: usize, has_end: bool, seed: u64) -> Self {
        let mut model = Self::new(targets, has_end, seed);
        for leg in &mut model.legs {
            *leg = ((*leg - 10.0) / 15.0).floor();
        }
        model.penalties.fill(0.0);
        model
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.legs[from * (self.targets + 2) + to]
    }

    fn cost(&self, order: &[usize], to_end: bool, share: f64) -> f64 {
        let places = self.targets + 2;
        let mut path = vec![self.targets];
        path.extend(order);
        if to_end {
            path.push(self.targets + 1);
        }
        let legs: f64 = path.windows(2).map(|leg| self.leg(leg[0], leg[1])).sum();
        let penalties: f64 = path
            .windows(3)
            .map(|p| self.penalties[(p[0] * places + p[1]) * places + p[2]])
            .sum();
        legs + share * penalties
    }
}

impl TourModel for RandomModel {
    fn target_count(&self) -> usize {
        self.targets
    }

    fn has_end(&self) -> bool {
        self.has_end
    }

    fn rules(&self) -> &OrderRules {
        &self.rules
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let number = |place| match place {
            Place::Start => self.targets,
            Place::Target(target) => target,
            Place::End => self.targets + 1,
        };
        self.leg(number(from), number(to))
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        assert!(prefix.len() >= 2 && prefix.len() + 2 <= self.targets);
        assert!(self.rules.some_order(prefix).is_some());
        if (self.fails)(prefix) {
            return Evaluation::Unresolved;
        }
        Evaluation::Value(self.cost(prefix, false, self.known_share))
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        assert_eq!(order.len(), self.targets);
        assert!(self.rules.admits(order));
        if (self.fails)(order) {
            return TourEvaluation::Unresolved;
        }
        TourEvaluation::Flown(self.cost(order, self.has_end, 1.0))
    }
}
