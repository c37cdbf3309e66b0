//! Cost models in place of solved legs.

pub(super) use crate::math::random::SplitMix;
use crate::model::order_rules::OrderRules;
use crate::tour::order::{Evaluation, Place, TourEvaluation, TourModel};

/// A number in `[0, 1)`.
pub(in crate::tour::order) fn unit(random: &mut SplitMix) -> f64 {
    (random.draw() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Legs with random costs, and a random penalty on every two consecutive legs.
///
/// Duration of a flight that is no minimum, relative to the least one.
pub(in crate::tour::order) const SLOW: f64 = 3.0;

/// The pair bounds are the costs without penalties. The bound of a prefix contains a share of the
/// penalties inside it: it is admissible, and not tight.
pub(in crate::tour::order) struct RandomModel {
    targets: usize,
    has_end: bool,
    legs: Vec<f64>,
    penalties: Vec<f64>,
    /// Which orders are admitted.
    pub(in crate::tour::order) rules: OrderRules,
    /// Share of the penalties in the bounds of prefixes and paths.
    pub(in crate::tour::order) known_share: f64,
    /// Orders and prefixes for which this holds do not resolve.
    pub(in crate::tour::order) fails: fn(&[usize]) -> bool,
    /// Whether there is a slow flight in such an order.
    pub(in crate::tour::order) flyable: bool,
    /// Targets with penalties.
    pub(in crate::tour::order) couples: fn(usize) -> bool,
    symmetric: bool,
}

impl RandomModel {
    /// Legs of 10 to 50 s that depend on the direction, and penalties up to 15 s.
    pub(in crate::tour::order) fn new(targets: usize, has_end: bool, seed: u64) -> Self {
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
            flyable: false,
            couples: |_| true,
            symmetric: false,
        }
    }

    /// Every order costs the same in reverse: start and end are the same place.
    pub(in crate::tour::order) fn symmetric(targets: usize, seed: u64) -> Self {
        let mut model = Self::new(targets, true, seed);
        let places = targets + 2;
        let (start, end) = (targets, targets + 1);
        // Costs depend neither on the direction nor on which of start and end a place is.
        let one = |place: usize| if place == end { start } else { place };
        let (legs, penalties) = (model.legs.clone(), model.penalties.clone());
        for from in 0..places {
            for to in 0..places {
                let (low, high) = (one(from).min(one(to)), one(from).max(one(to)));
                model.legs[from * places + to] = legs[low * places + high];
                for via in 0..targets {
                    let known = penalties[(low * places + via) * places + high];
                    model.penalties[(from * places + via) * places + to] = known;
                }
            }
        }
        model.symmetric = true;
        model
    }

    /// Costs of 0, 1 or 2 and no penalties: many ties.
    pub(in crate::tour::order) fn with_ties(targets: usize, has_end: bool, seed: u64) -> Self {
        let mut model = Self::new(targets, has_end, seed);
        for leg in &mut model.legs {
            *leg = ((*leg - 10.0) / 15.0).floor();
        }
        model.penalties.fill(0.0);
        model
    }

    /// Orders whose costs differ by millionths to thousandths, with bounds that contain all
    /// penalties.
    pub(in crate::tour::order) fn with_near_ties(targets: usize, has_end: bool, seed: u64) -> Self {
        let mut model = Self::new(targets, has_end, seed);
        let spread = [1e-6, 1e-5, 1e-4, 1e-3][(seed % 4) as usize];
        for leg in &mut model.legs {
            *leg = 30.0 + spread * *leg;
        }
        for penalty in &mut model.penalties {
            *penalty = 0.02 + spread * *penalty;
        }
        model.known_share = 1.0;
        model
    }

    /// Costs that are symmetric except at the start and for a service time at every target.
    pub(in crate::tour::order) fn reversible(targets: usize, has_end: bool, seed: u64) -> Self {
        let mut model = Self::new(targets, has_end, seed);
        let places = targets + 2;
        for a in 0..targets {
            for b in 0..a {
                model.legs[a * places + b] = model.legs[b * places + a];
            }
            for (from, to) in (0..targets).flat_map(|i| (0..i).map(move |k| (i, k))) {
                let back = model.penalties[(to * places + a) * places + from];
                model.penalties[(from * places + a) * places + to] = back;
            }
        }
        for (leg, to) in model.legs.iter_mut().zip((0..places).cycle()) {
            *leg += (to % 3) as f64;
        }
        model
    }

    /// The same model without the information that it is symmetric.
    pub(in crate::tour::order) fn searched_whole(mut self) -> Self {
        self.symmetric = false;
        self
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.legs[from * (self.targets + 2) + to]
    }

    fn number(&self, place: Place) -> usize {
        match place {
            Place::Start => self.targets,
            Place::Target(target) => target,
            Place::End => self.targets + 1,
        }
    }

    fn penalty(&self, from: usize, via: usize, to: usize) -> f64 {
        if !(self.couples)(via) {
            return 0.0;
        }
        let places = self.targets + 2;
        self.penalties[(from * places + via) * places + to]
    }

    fn cost(&self, order: &[usize], to_end: bool, share: f64) -> f64 {
        let mut path = vec![self.targets];
        path.extend(order);
        if to_end {
            path.push(self.targets + 1);
        }
        self.along(&path, share)
    }

    fn along(&self, path: &[usize], share: f64) -> f64 {
        let legs: f64 = path.windows(2).map(|leg| self.leg(leg[0], leg[1])).sum();
        let penalties: f64 = path
            .windows(3)
            .map(|p| self.penalty(p[0], p[1], p[2]))
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

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        self.leg(self.number(from), self.number(to))
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        assert!(prefix.len() >= 2 && prefix.len() + 2 <= self.targets);
        assert!(self.rules.some_order(prefix).is_some());
        if (self.fails)(prefix) {
            return Evaluation::Unresolved;
        }
        Evaluation::Value(self.cost(prefix, false, self.known_share))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        let path: Vec<usize> = path.iter().map(|&place| self.number(place)).collect();
        let middle = path[path.len() / 2];
        assert!((self.couples)(middle) && [3, 5].contains(&path.len()));
        if (self.fails)(&path) {
            return Evaluation::Unresolved;
        }
        Evaluation::Value(self.along(&path, self.known_share))
    }

    fn couples(&self, via: usize) -> bool {
        (self.couples)(via)
    }

    /// Half of a penalty is due to either leg, more or less.
    fn leg_times(&self, order: &[usize]) -> Option<Vec<f64>> {
        let mut path = vec![self.targets];
        path.extend(order);
        path.extend(self.has_end.then_some(self.targets + 1));
        let mut times: Vec<f64> = path
            .windows(2)
            .map(|leg| self.leg(leg[0], leg[1]))
            .collect();
        for (before, triple) in path.windows(3).enumerate() {
            let penalty = self.penalty(triple[0], triple[1], triple[2]);
            let share = 0.3 + 0.1 * (before % 5) as f64;
            times[before] += share * penalty;
            times[before + 1] += (1.0 - share) * penalty;
        }
        Some(times)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        assert_eq!(order.len(), self.targets);
        assert!(self.rules.admits(order));
        let least_s = self.cost(order, self.has_end, 1.0);
        match (self.fails)(order) {
            false => TourEvaluation::Solved(least_s),
            true if self.flyable => TourEvaluation::Flyable(SLOW * least_s),
            true => TourEvaluation::Unresolved,
        }
    }
}
