//! The document that describes a comparison of wheels and gyroscopes.

use serde::Serialize;
use utoipa::ToSchema;

/// Wheels against control moment gyroscopes. What is left out is as in the published study.
#[derive(Serialize, ToSchema)]
#[schema(as = ComparisonStudy)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct ComparisonBody {
    /// Momenta of a device; 1, 0.1 and 0.01 without it.
    #[schema(required = false, min_items = 1, max_items = 1000)]
    momenta_nms: Option<Vec<f64>>,
    /// Angles of the slews that are compared; every degree to a half turn without it.
    #[schema(required = false, min_items = 1, max_items = 1000)]
    angles_rad: Option<Vec<f64>>,
    /// Rate that sizes the spacecraft: wheels with eigenaxis control just reach it. 3 deg/s without it.
    #[schema(required = false, minimum = 1e-9, maximum = 1e9)]
    required_rate_rad_s: Option<f64>,
    /// Body momentum and torque of the pyramids; as published without it.
    #[schema(required = false)]
    radii: Option<ComparisonRadii>,
    /// Torque of a device over its momentum; as published without it.
    #[schema(required = false)]
    laws: Option<ComparisonLaws>,
    /// Momenta of a device at which advantage angles are told; 0.001 to 10 without it.
    #[schema(required = false, min_items = 1, max_items = 1000)]
    curve_momenta_nms: Option<Vec<f64>>,
    /// Masses of a device at which arrays are compared; 0.1 to 100 without it.
    #[schema(required = false, min_items = 1, max_items = 1000)]
    device_masses_kg: Option<Vec<f64>>,
    /// Circles of latitude of the singular surfaces.
    #[schema(required = false, minimum = 1, maximum = 40, default = 12)]
    surface_rows: Option<u32>,
}

/// Body momentum and torque of a pyramid of four, as multiples of a device's.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum ComparisonRadii {
    Published,
    /// From envelopes and singular surfaces.
    Computed,
    /// Those that are left out are as published.
    Given {
        #[schema(required = false)]
        rw_eigenaxis: Option<GivenRadius>,
        #[schema(required = false)]
        rw_pseudo_optimal: Option<GivenRadius>,
        #[schema(required = false)]
        rw_optimal: Option<GivenRadius>,
        #[schema(required = false)]
        cmg: Option<GivenRadius>,
    },
}

#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct GivenRadius {
    #[schema(minimum = 1e-9, maximum = 1e9)]
    momentum: f64,
    #[schema(minimum = 1e-9, maximum = 1e9)]
    torque: f64,
}

/// Torque (N m) over momentum (N m s) of a device.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum ComparisonLaws {
    Published,
    /// Fitted to the tables of devices.
    Tables,
    /// Those that are left out are as published.
    Given {
        #[schema(required = false)]
        wheel: Option<GivenLaw>,
        #[schema(required = false)]
        gyroscope: Option<GivenLaw>,
    },
}

/// `y = factor x^exponent`.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct GivenLaw {
    #[schema(minimum = 1e-9, maximum = 1e9)]
    factor: f64,
    #[schema(minimum = -8, maximum = 8)]
    exponent: f64,
}
