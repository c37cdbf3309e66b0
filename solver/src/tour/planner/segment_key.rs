//! What a segment of a tour is part of, which decides how it is solved.

use crate::tour::order::Place;

/// Legs up to which the beginning of a tour is solved as any piece of one is.
pub(super) const SHORT: usize = 3;

/// What a segment is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Extent {
    /// The beginning of longer ones, free where it ends: its duration is a bound.
    Beginning,
    /// A piece of a tour: its duration is a bound.
    Piece,
    /// A tour: any flight is better than none.
    Tour,
}

/// A segment: its places, and what it is part of as far as that makes a difference.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Segment {
    pub(super) extent: Extent,
    pub(super) route: Vec<Place>,
}

impl Segment {
    /// The segment of a route.
    pub(super) fn new(route: &[Place], extent: Extent) -> Self {
        let short = route.len() <= SHORT + 1;
        Self {
            extent: if extent == Extent::Beginning && short {
                Extent::Piece
            } else {
                extent
            },
            route: route.to_vec(),
        }
    }

    /// Its name in a store.
    pub(super) fn name(&self) -> String {
        let kind = match self.extent {
            Extent::Beginning => "beginning",
            Extent::Piece => "piece",
            Extent::Tour => "tour",
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
