//! The analytic centre: wheel momenta that meet a demand far from all speed limits.
//!
//! More than three wheels can share a demand in many ways. The one that minimises
//! `-sum log(1 - (h_i / c_i)^2)`, with the capacity `c_i` of wheel `i`, changes smoothly with the
//! demand, and exists wherever any way is strictly within the limits (Boyd and Vandenberghe, Convex
//! Optimization, 2004, section 8.5.3).

use crate::model::dynamics::Dynamics;
use nalgebra::{DMatrix, DVector, Vector3};

/// Limit of the Newton steps for one centre, and the squared Newton decrement that ends them.
const STEPS: usize = 30;
const DECREMENT: f64 = 1e-20;
/// Reductions of enlarged capacities on the way to the true ones.
const REDUCTIONS: usize = 40;
/// Enlarged capacities as a multiple of what is needed.
const ENLARGED: f64 = 1.01;
/// Capacity, relative to the demand, of a wheel without a speed limit.
const UNLIMITED: f64 = 1e3;

/// The centre of all wheel momenta, N m s, that sum up to a demand in body axes; `None` where the
/// wheels cannot hold it.
pub(super) fn centred(dynamics: &Dynamics, demand: &Vector3<f64>) -> Option<DVector<f64>> {
    let mut momenta = &dynamics.axes_inverse * demand;
    let size = demand.norm();
    let capacities = DVector::from_iterator(
        dynamics.wheel_count(),
        dynamics.actuators.iter().map(|wheel| {
            let capacity = wheel.inertia * wheel.max_speed;
            if capacity.is_finite() {
                capacity
            } else {
                UNLIMITED * size
            }
        }),
    );
    if size == 0.0 {
        return Some(momenta);
    }
    // Enlarged until the pseudo-inverse is inside, and less so from centre to centre.
    for _ in 0..REDUCTIONS {
        let load = momenta.component_div(&capacities).amax();
        if load < 1.0 {
            return Some(centre(dynamics, &capacities, momenta));
        }
        momenta = centre(dynamics, &(&capacities * (ENLARGED * load)), momenta);
    }
    None
}

/// The centre within some capacities from momenta inside them.
fn centre(
    dynamics: &Dynamics,
    capacities: &DVector<f64>,
    mut momenta: DVector<f64>,
) -> DVector<f64> {
    let null = &dynamics.null_space;
    if null.ncols() == 0 {
        return momenta;
    }
    let barrier = |momenta: &DVector<f64>| -> f64 {
        let loads = momenta.component_div(capacities);
        let logs = loads.iter().map(|load| {
            if load.abs() < 1.0 {
                -(1.0 - load * load).ln()
            } else {
                f64::INFINITY
            }
        });
        logs.sum()
    };
    for _ in 0..STEPS {
        let loads = momenta.component_div(capacities);
        let room = loads.map(|load| 1.0 - load * load);
        let slope = loads.zip_map(&room, |load, room| 2.0 * load / room);
        let bend = loads.zip_map(&room, |load, room| 2.0 * (1.0 + load * load) / room.powi(2));
        let gradient = null.tr_mul(&slope.component_div(capacities));
        let scaled = DMatrix::from_fn(null.nrows(), null.ncols(), |i, j| {
            null[(i, j)] * bend[i] / capacities[i].powi(2)
        });
        let Some(factor) = null.tr_mul(&scaled).cholesky() else {
            break;
        };
        let step = factor.solve(&gradient);
        let decrement = gradient.dot(&step);
        if decrement <= DECREMENT {
            break;
        }
        let (before, direction) = (barrier(&momenta), null * step);
        let mut share = 1.0;
        while barrier(&(&momenta - &direction * share)) > before && share > 1e-9 {
            share *= 0.5;
        }
        momenta -= direction * share;
    }
    momenta
}
