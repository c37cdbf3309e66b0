//! The body axis that is drawn on the sphere.

use nalgebra::Vector3;
use slewplan_solver::model::scenario::Scenario;

/// A named body axis.
#[derive(Debug, Clone)]
pub(crate) struct DrawnBoresight {
    pub(super) name: String,
    pub(super) axis: Vector3<f64>,
}

impl DrawnBoresight {
    /// The boresight of the scenario with this name, or a body axis like `x` or `-z`; without a
    /// name the first one of the scenario, or `x`.
    ///
    /// # Errors
    ///
    /// A message, when there is none of this name.
    pub(crate) fn find(name: Option<&str>, scenario: Option<&Scenario>) -> Result<Self, String> {
        let known = scenario.map_or(&[][..], |scenario| scenario.spacecraft().boresights());
        let found = match name {
            None => known.first(),
            Some(name) => known.iter().find(|boresight| boresight.name == name),
        };
        if let Some(found) = found {
            return Ok(Self {
                name: found.name.clone(),
                axis: found.axis,
            });
        }
        let name = name.unwrap_or("x");
        let (sign, letter) = name
            .strip_prefix('-')
            .map_or((1.0, name), |rest| (-1.0, rest));
        let axis = match letter {
            "x" => Vector3::x(),
            "y" => Vector3::y(),
            "z" => Vector3::z(),
            _ => {
                let names: Vec<&str> = known.iter().map(|b| b.name.as_str()).collect();
                let named = if names.is_empty() {
                    String::new()
                } else {
                    format!(" or one of {}", names.join(", "))
                };
                return Err(format!("{name:?} is none of x, y, z, -x, -y, -z{named}"));
            }
        };
        Ok(Self {
            name: format!("body axis {name}"),
            axis: axis * sign,
        })
    }
}
