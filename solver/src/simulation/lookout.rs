//! Looking up from the integration at regular steps, whether anybody still waits for the flight.

/// Steps between two looks: a fraction of a millisecond of work.
const STEPS_PER_LOOK: usize = 256;

/// Who is asked, and how many steps are left until then.
pub(super) struct Lookout<'a> {
    give_up: &'a dyn Fn() -> bool,
    left: usize,
}

impl<'a> Lookout<'a> {
    /// Looks for the first time; `None` when the flight is given up already.
    pub(super) fn new(give_up: &'a dyn Fn() -> bool) -> Option<Self> {
        let left = STEPS_PER_LOOK;
        (!give_up()).then_some(Self { give_up, left })
    }

    /// Goes over steps, in as many parts as there are looks in between; `None` when the flight is
    /// given up.
    pub(super) fn over(&mut self, mut steps: usize, mut go: impl FnMut(usize)) -> Option<()> {
        while steps > 0 {
            let part = steps.min(self.left);
            go(part);
            steps -= part;
            self.left -= part;
            if self.left == 0 {
                *self = Self::new(self.give_up)?;
            }
        }
        Some(())
    }
}
