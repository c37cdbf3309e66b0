//! The couplings at the joints with which a move puts segments of an order together.

/// Stands for the missing place before the first one and after the last one.
pub(super) const NOWHERE: usize = usize::MAX;

/// The couplings at the joints with which segments are put together.
pub(super) struct Joints {
    before: usize,
    at: usize,
    /// Each as the places before, at and after it: at most six.
    couplings: [[usize; 3]; 6],
    count: usize,
}

impl Joints {
    /// None yet, at a place after another.
    pub(super) fn from(before: usize, at: usize) -> Self {
        Self {
            before,
            at,
            couplings: [[NOWHERE; 3]; 6],
            count: 0,
        }
    }

    /// Goes to a place, and adds the coupling before the leg to it.
    pub(super) fn go_to(&mut self, to: usize) {
        self.add_coupling(to);
        self.go_on(self.at, to);
    }

    /// Adds the coupling where the path has come to, before it goes on to a place.
    pub(super) fn add_coupling(&mut self, after: usize) {
        self.couplings[self.count] = [self.before, self.at, after];
        self.count += 1;
    }

    /// Goes on at a place after another, beyond the inside of a segment.
    pub(super) fn go_on(&mut self, before: usize, at: usize) {
        self.before = before;
        self.at = at;
    }

    /// All of them.
    pub(super) fn couplings(&self) -> impl Iterator<Item = [usize; 3]> {
        self.couplings[..self.count].iter().copied()
    }
}
