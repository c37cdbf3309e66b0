//! Which targets labels keep in mind: at each target, those on the list of that target.

use super::instance::Instance;
use super::target_set::TargetSet;

/// Nearest targets that are kept in mind at each target from the beginning.
const NEAREST: usize = 6;

/// The targets that a label at each target still knows to be barred.
#[derive(Debug, Clone)]
pub(super) struct RouteMemory {
    known: Vec<TargetSet>,
}

impl RouteMemory {
    /// Nothing is kept in mind.
    pub(super) fn none(count: usize) -> Self {
        Self {
            known: vec![TargetSet::default(); count],
        }
    }

    /// The nearest targets of each.
    pub(super) fn nearest(instance: &Instance) -> Self {
        let near = |at: usize| {
            let mut others: Vec<usize> = (0..instance.count).filter(|other| *other != at).collect();
            let way = |other: &usize| {
                let (a, b) = (at + 1, other + 1);
                instance.leg(a, b).min(instance.leg(b, a))
            };
            others.sort_by(|a, b| way(a).total_cmp(&way(b)));
            others.into_iter().take(NEAREST).collect()
        };
        Self {
            known: (0..instance.count).map(near).collect(),
        }
    }

    /// Every target at every target: labels are exact.
    pub(super) fn whole(count: usize) -> Self {
        Self {
            known: vec![TargetSet::below(count); count],
        }
    }

    /// What is kept in mind at a target.
    pub(super) fn at(&self, target: usize) -> &TargetSet {
        &self.known[target]
    }

    /// Keeps in mind what a path has forgotten: from every visit that bars a later one, until there.
    /// Whether it has forgotten anything.
    pub(super) fn learn(&mut self, path: &[usize], barred: &[TargetSet]) -> bool {
        let mut forgotten = false;
        for (at, first) in path.iter().enumerate() {
            let later = path.iter().enumerate().skip(at + 1);
            let wrong = later.filter(|(_, target)| barred[*first].contains(**target));
            for (end, target) in wrong {
                forgotten = true;
                for between in &path[at + 1..end] {
                    self.known[*between].insert(*target);
                }
            }
        }
        forgotten
    }
}
