//! Rules for the order: targets with a fixed place, and targets that come after others.
//!
//! # Deciding whether a beginning can be completed
//!
//! Every place of an order is a unit of time and every target a job of that length: a target with
//! the fixed place `p` has the release date `p` and the due date `p + 1`, and `j` after `i` is a
//! precedence. On one machine such jobs are scheduled by earliest due date, and if that schedule is
//! late every schedule is (Jackson 1955 for the rule; Lageweg, Lenstra and Rinnooy Kan 1976 for
//! releases and precedences of unit jobs), provided that due dates satisfy `due(i) <= due(j) - 1`
//! along the precedences. Release dates need no such correction: a job is scheduled only after its
//! predecessors. There are as many places as targets, so a place that stays empty also makes a job
//! late. The answer is exact and comes with an order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Fixed places and precedences of the targets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OrderRules {
    /// Zero-based place of every target, where it is fixed.
    positions: Vec<Option<usize>>,
    /// Which targets come before each.
    predecessors: Vec<Vec<usize>>,
    /// Which targets come after each.
    successors: Vec<Vec<usize>>,
    /// The target of every place, where it is fixed.
    holders: Vec<Option<usize>>,
    /// Due date of every target: it is among the first so many in every order that keeps the rules.
    due: Vec<usize>,
}

/// Why a beginning has no completion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DeadEnd {
    /// This target has to be among the first `due`, and all of these places are taken.
    Overdue {
        /// Index of the target.
        target: usize,
        /// The number of places that it may take, from the first one.
        due: usize,
    },
    /// No target may take this zero-based place, whatever comes before.
    Empty(usize),
}

impl OrderRules {
    /// Any order of so many targets.
    #[must_use]
    pub fn none(targets: usize) -> Self {
        Self::new(vec![None; targets], vec![Vec::new(); targets])
    }

    /// Rules for every target: its zero-based place where that is fixed, and the targets that come
    /// before it. Both lists have one entry per target, and the indices in them are below their
    /// number. Rules that contradict each other admit no order.
    #[must_use]
    pub fn new(positions: Vec<Option<usize>>, after: Vec<Vec<usize>>) -> Self {
        let targets = positions.len();
        let mut holders = vec![None; targets];
        for (target, position) in positions.iter().enumerate() {
            if let Some(holder) = position.and_then(|place| holders.get_mut(place)) {
                *holder = Some(target);
            }
        }
        let mut successors = vec![Vec::new(); targets];
        for (target, predecessors) in after.iter().enumerate() {
            for &predecessor in predecessors {
                successors[predecessor].push(target);
            }
        }
        let mut rules = Self {
            due: positions
                .iter()
                .map(|position| position.map_or(targets, |place| place + 1))
                .collect(),
            positions,
            predecessors: after,
            successors,
            holders,
        };
        rules.draw_due_dates_forward();
        rules
    }

    /// The same rules for the orders that visit a target in the first half, its middle included.
    #[must_use]
    pub fn in_first_half(mut self, target: usize) -> Self {
        self.due[target] = self.due[target].min(self.due.len().div_ceil(2));
        self.draw_due_dates_forward();
        self
    }

    /// Targets with successors first; those on a cycle, which no order admits, are left out.
    fn draw_due_dates_forward(&mut self) {
        let mut open: Vec<usize> = self.successors.iter().map(Vec::len).collect();
        let mut ready: Vec<usize> = (0..open.len())
            .filter(|&target| open[target] == 0)
            .collect();
        while let Some(target) = ready.pop() {
            let before = self.due[target].saturating_sub(1);
            for &predecessor in &self.predecessors[target] {
                self.due[predecessor] = self.due[predecessor].min(before);
                open[predecessor] -= 1;
                if open[predecessor] == 0 {
                    ready.push(predecessor);
                }
            }
        }
    }

    /// Whether every order is admitted.
    #[must_use]
    pub fn is_free(&self) -> bool {
        let targets = self.due.len();
        // The last place has the latest due date, but it is a fixed place all the same.
        self.positions.iter().all(Option::is_none)
            && self.due.iter().all(|due| *due == targets)
            && self.predecessors.iter().all(Vec::is_empty)
    }

    /// Whether the fixed places and the due dates let a target take this place.
    pub(crate) fn admits_at(&self, place: usize, target: usize) -> bool {
        let free = self.positions[target].is_none() && self.holders[place].is_none();
        let fixed_here = self.positions[target] == Some(place);
        fixed_here || free && place < self.due[target]
    }

    /// Whether an order, or the beginning of one, keeps the rules. It names no target twice.
    #[must_use]
    pub fn admits(&self, order: &[usize]) -> bool {
        let mut visited = vec![false; self.positions.len()];
        order.iter().enumerate().all(|(place, &target)| {
            let mut before = self.predecessors[target].iter();
            let admitted = self.admits_at(place, target) && before.all(|&before| visited[before]);
            visited[target] = true;
            admitted
        })
    }

    /// A whole order that begins with this prefix and keeps the rules; `None` when there is none.
    #[must_use]
    pub fn some_order(&self, prefix: &[usize]) -> Option<Vec<usize>> {
        let complete = || self.complete(prefix).ok();
        self.admits(prefix).then(complete).flatten()
    }

    /// Whether there is such an order.
    pub(crate) fn completable(&self, prefix: &[usize]) -> bool {
        self.is_free() || self.some_order(prefix).is_some()
    }

    /// A completion of a prefix that is admitted, by earliest due date.
    pub(crate) fn complete(&self, prefix: &[usize]) -> Result<Vec<usize>, DeadEnd> {
        let targets = self.positions.len();
        let mut awaited: Vec<usize> = self.predecessors.iter().map(Vec::len).collect();
        let mut visited = vec![false; targets];
        let mut order = Vec::with_capacity(targets);
        let mut ready: BinaryHeap<Reverse<(usize, usize)>> = (0..targets)
            .filter(|&target| awaited[target] == 0 && self.positions[target].is_none())
            .map(|target| Reverse((self.due[target], target)))
            .collect();
        for place in 0..targets {
            let next = prefix
                .get(place)
                .copied()
                .or_else(|| match self.holders[place] {
                    Some(holder) => (awaited[holder] == 0).then_some(holder),
                    None => loop {
                        // Targets of the prefix are still in the heap.
                        let Reverse((_, target)) = ready.pop()?;
                        if !visited[target] {
                            break Some(target);
                        }
                    },
                });
            let Some(next) = next.filter(|&next| self.due[next] > place) else {
                return Err(self.dead_end(place, &visited));
            };
            visited[next] = true;
            order.push(next);
            for &after in &self.successors[next] {
                awaited[after] -= 1;
                if awaited[after] == 0 && self.positions[after].is_none() {
                    ready.push(Reverse((self.due[after], after)));
                }
            }
        }
        Ok(order)
    }

    /// Why no target can take a place.
    fn dead_end(&self, place: usize, visited: &[bool]) -> DeadEnd {
        let earliest = |target: usize| self.positions[target].unwrap_or(0).max(place);
        let overdue = (0..visited.len())
            .filter(|&target| !visited[target] && self.due[target] <= earliest(target))
            .map(|target| (self.due[target], target))
            .min();
        overdue.map_or(DeadEnd::Empty(place), |(due, target)| DeadEnd::Overdue {
            target,
            due,
        })
    }

    /// Zero-based place of a target, where it is fixed.
    #[must_use]
    pub fn position(&self, target: usize) -> Option<usize> {
        self.positions[target]
    }

    /// The targets that come before one.
    #[must_use]
    pub fn predecessors(&self, target: usize) -> &[usize] {
        &self.predecessors[target]
    }
}
