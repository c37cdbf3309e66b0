//! What identifies a segment of a tour: its route, and what it is a part of, which decides how it
//! is solved.

use crate::tour::order::Place;

/// Number of legs up to which the beginning of a tour is solved in the same way as any other piece.
pub(super) const MAX_SHORT_LEGS: usize = 3;

/// What a segment is a part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum SegmentKind {
    /// The beginning of a tour, with a free end: its minimum duration is a lower bound, and longer
    /// beginnings start from its solution.
    Beginning,
    /// Any piece of a tour: its minimum duration is a lower bound.
    Piece,
    /// A piece of a whole tour: a feasible flight is useful even if it is no minimum.
    Tour,
}

/// A segment: its places, and its kind as far as that makes a difference.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct SegmentKey {
    pub(super) kind: SegmentKind,
    pub(super) route: Vec<Place>,
}

impl SegmentKey {
    /// The key of a route. Short beginnings have the key of a piece.
    pub(super) fn new(route: &[Place], kind: SegmentKind) -> Self {
        let short = route.len() <= MAX_SHORT_LEGS + 1;
        Self {
            kind: if kind == SegmentKind::Beginning && short {
                SegmentKind::Piece
            } else {
                kind
            },
            route: route.to_vec(),
        }
    }

    /// The name under which it is stored.
    pub(super) fn name(&self) -> String {
        let kind = match self.kind {
            SegmentKind::Beginning => "beginning",
            SegmentKind::Piece => "piece",
            SegmentKind::Tour => "tour",
        };
        let places = self.route.iter().map(|place| match place {
            Place::Start => "start".to_owned(),
            Place::Target(index) => index.to_string(),
            Place::End => "end".to_owned(),
        });
        let parts: Vec<_> = std::iter::once(kind.to_owned()).chain(places).collect();
        parts.join(" ")
    }
}
