//! The part of a study of envelopes that is drawn, read from its JSON.

use nalgebra::Vector3;
use serde::Deserialize;

/// The part of the answer that is read.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenEnvelopes {
    pub(super) torque: Array,
    pub(super) momentum: Option<Array>,
    pub(super) turns: Vec<WrittenTurn>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Array {
    pub(super) unit: String,
    pub(super) full: WrittenPolytope,
    pub(super) pseudo_inverse: WrittenPolytope,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenPolytope {
    pub(super) inscribed_radius: f64,
    pub(super) equal_volume_radius: f64,
    pub(super) greatest_radius: f64,
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) facets: Vec<WrittenFacet>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenFacet {
    pub(super) normal: [f64; 3],
    distance: f64,
    vertices: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenTurn {
    pub(super) angle_rad: f64,
    pub(super) axis: [f64; 3],
    eigenaxis: Vec<Eigenaxis>,
    time_optimal: Vec<TimeOptimal>,
}

#[derive(Debug, Deserialize)]
struct Eigenaxis {
    limit: String,
    duration_s: f64,
    path: WrittenPath,
}

#[derive(Debug, Deserialize)]
struct TimeOptimal {
    allocation: String,
    duration_s: Option<f64>,
    path: Option<WrittenPath>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenPath {
    momentum: Vec<Momentum>,
    torque: Vec<Torque>,
}

#[derive(Debug, Deserialize)]
struct Momentum {
    time_s: f64,
    #[serde(rename = "momentum_nms")]
    vector: [f64; 3],
}

#[derive(Debug, Deserialize)]
struct Torque {
    start_s: f64,
    duration_s: f64,
    #[serde(rename = "torque_nm")]
    vector: [f64; 3],
}

/// The drawn part of a slew.
#[derive(Debug)]
pub(super) struct WrittenEnvelopeSlew<'a> {
    pub(super) name: &'static str,
    pub(super) duration_s: f64,
    path: &'a WrittenPath,
}

impl WrittenEnvelopes {
    /// Reads the answer to a study of envelopes.
    ///
    /// # Errors
    ///
    /// A message, when it cannot be drawn.
    pub(crate) fn read(document: &[u8]) -> Result<Self, String> {
        let study: Self = serde_json::from_slice(document)
            .map_err(|error| format!("not a study that can be drawn: {error}"))?;
        let arrays = std::iter::once(&study.torque).chain(&study.momentum);
        let polytopes = arrays.flat_map(|array| [&array.full, &array.pseudo_inverse]);
        let unsound = polytopes.filter(|it| !it.is_sound()).count();
        if unsound > 0 {
            return Err("an envelope has no facets, or facets without corners".to_owned());
        }
        Ok(study)
    }
}

impl WrittenPolytope {
    fn is_sound(&self) -> bool {
        let known = |facet: &WrittenFacet| {
            let corners = &facet.vertices;
            corners.len() > 2 && corners.iter().all(|&i| i < self.vertices.len())
        };
        let around = |facet: &WrittenFacet| facet.distance > 0.0;
        self.facets.len() > 3 && self.facets.iter().all(|it| known(it) && around(it))
    }

    /// The corners of a facet.
    pub(super) fn corners(&self, facet: &WrittenFacet) -> impl Iterator<Item = Vector3<f64>> {
        facet.vertices.iter().map(|&i| self.vertices[i].into())
    }

    /// The share of the polytope that a vector uses: 1 on its surface.
    pub(super) fn share(&self, vector: &Vector3<f64>) -> f64 {
        let shares = self
            .facets
            .iter()
            .map(|facet| Vector3::from(facet.normal).dot(vector) / facet.distance);
        shares.fold(0.0, f64::max)
    }
}

impl WrittenTurn {
    /// The slews that are compared, as far as they were solved.
    pub(super) fn slews(&self) -> Vec<WrittenEnvelopeSlew<'_>> {
        let about = |limit: &str, name| {
            let found = self.eigenaxis.iter().find(|slew| slew.limit == limit)?;
            Some(WrittenEnvelopeSlew {
                name,
                duration_s: found.duration_s,
                path: &found.path,
            })
        };
        let fastest = |allocation: &str, name| {
            let mut slews = self.time_optimal.iter();
            let found = slews.find(|slew| slew.allocation == allocation)?;
            Some(WrittenEnvelopeSlew {
                name,
                duration_s: found.duration_s?,
                path: found.path.as_ref()?,
            })
        };
        let slews = [
            about("pseudo_inverse", "eigenaxis, pseudo-inverse"),
            about("full", "eigenaxis, full envelope"),
            fastest("pseudo_inverse", "fastest, pseudo-inverse"),
            fastest("free", "fastest"),
        ];
        slews.into_iter().flatten().collect()
    }
}

impl WrittenEnvelopeSlew<'_> {
    /// Momenta at their times, joined by straight lines.
    pub(super) fn momenta(&self) -> Vec<(f64, Vector3<f64>)> {
        let samples = self.path.momentum.iter();
        samples.map(|it| (it.time_s, it.vector.into())).collect()
    }

    /// Torques at both ends of the intervals in which they are constant.
    pub(super) fn torques(&self) -> Vec<(f64, Vector3<f64>)> {
        let steps = self.path.torque.iter().filter(|it| it.duration_s > 0.0);
        let ends = steps.flat_map(|it| {
            let torque = Vector3::from(it.vector);
            [(it.start_s, torque), (it.start_s + it.duration_s, torque)]
        });
        ends.collect()
    }
}
