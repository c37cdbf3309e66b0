//! Checking for a stop at regular numbers of integration steps.

/// Steps between two checks: a fraction of a millisecond of work.
const STEPS_PER_CHECK: usize = 256;

/// A function that says whether to stop, and the number of steps until it is called next.
pub(super) struct StopPoll<'a> {
    should_stop: &'a dyn Fn() -> bool,
    left: usize,
}

impl<'a> StopPoll<'a> {
    /// Checks for the first time; `None` when the simulation is to stop.
    pub(super) fn new(should_stop: &'a dyn Fn() -> bool) -> Option<Self> {
        let left = STEPS_PER_CHECK;
        (!should_stop()).then_some(Self { should_stop, left })
    }

    /// Calls `go` with numbers of steps that sum up to `steps`, and checks in between; `None` when the
    /// simulation is to stop.
    pub(super) fn over(&mut self, mut steps: usize, mut go: impl FnMut(usize)) -> Option<()> {
        while steps > 0 {
            let part = steps.min(self.left);
            go(part);
            steps -= part;
            self.left -= part;
            if self.left == 0 {
                *self = Self::new(self.should_stop)?;
            }
        }
        Some(())
    }
}
