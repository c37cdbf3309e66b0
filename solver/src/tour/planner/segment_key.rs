//! What a segment of a tour is part of, which decides how it is solved.

use crate::tour::order::Place;

/// Legs up to which the beginning of a tour is solved as any piece of one is.
pub(super) const MAX_SHORT_LEGS: usize = 3;

/// What a segment is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum SegmentKind {
    /// The beginning of longer ones, free where it ends: its duration is a bound.
    Beginning,
    /// A piece of a tour: its duration is a bound.
    Piece,
    /// A tour: any flight is better than none.
    Tour,
}

/// A segment: its places, and what it is part of as far as that makes a difference.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct SegmentKey {
    pub(super) segment_key: SegmentKind,
    pub(super) route: Vec<Place>,
}

impl SegmentKey {
    /// The segment of a route.
    pub(super) fn new(route: &[Place], segment_key: SegmentKind) -> Self {
        let short = route.len() <= MAX_SHORT_LEGS + 1;
        Self {
            segment_key: if segment_key == SegmentKind::Beginning && short {
                SegmentKind::Piece
            } else {
                segment_key
            },
            route: route.to_vec(),
        }
    }

    /// Its name in a store.
    pub(super) fn name(&self) -> String {
        let kind = match self.segment_key {
            SegmentKind::Beginning => "beginning",
            SegmentKind::Piece => "piece",
            SegmentKind::Tour => "tour",
        };
        let places = self.route.iter().map(|place| match place {
            Place::Start => "start".to_owned(),
            Place::Target(index) => index.to_string(),
            Place::End => "end".to_owned(),
        });
        let words: Vec<_> = std::iter::once(kind.to_owned()).chain(places).collect();
        words.join(" ")
    }
}
