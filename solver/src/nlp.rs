//! Nonlinear programs whose variables form a chain of stages, and an interior point for them.
//!
//! This module knows no physics. The problem, with `x_k` on a manifold and `v_k` in `R^m`:
//!
//! ```text
//!   minimise   sum_k f_k(x_k, v_k)
//!   subject to x_{k+1} = F_k(x_k, v_k)      k = 0 .. N-1   (links)
//!              e_k(x_k) = 0                 k = 0 .. N     (node equalities)
//!              g_k(x_k, v_k) >= 0           k = 0 .. N     (inequalities, no v_N)
//! ```
//!
//! A state is stored as a *point* (a quaternion has four numbers) and moved by a *step* in its
//! tangent space (a rotation vector has three). With `phi_k` the chart around the current `x_k`,
//! that is the inverse of the retraction, a link reads `phi_{k+1}(F_k(x_k, v_k)) = 0` and its
//! linearisation is explicit in the next step:
//!
//! ```text
//!   dx_{k+1} = A_k dx_k + B_k dv_k + gap_k
//! ```
//!
//! so a Newton step costs one Riccati sweep ([`riccati`]): linear in the number of stages.
//! Lagrangian and multipliers:
//!
//! ```text
//!   L = sum f + lambda_{k+1} . (phi_{k+1}(F_k) - dx_{k+1}) + nu_k . e_k - z_k . (g_k - s_k),  s, z >= 0
//! ```
//!
//! The method is the primal-dual barrier method with a filter line search of Waechter and Biegler
//! (Math. Program. 106, 2006), with exact second derivatives and second-order corrections.
//! Differences: where a convex system is so flat that its step had to be shortened a lot, the next
//! one is regularised, which shortens steps in flat directions; node equalities enter the sweep as
//! a proximal penalty whose centre is iterated to the exact multiplier, which keeps the
//! factorisation a plain Cholesky; restoration takes least-squares steps on the same structure.
//!
//! | role | type |
//! |---|---|
//! | the problem, as its author writes it | [`Chain`] |
//! | the point, and where its blocks lie | [`Iterate`], [`Layout`] |
//! | models of the links at the point, barrier parameter | [`barrier`] |
//! | how far the point is from the optimality conditions | [`convergence`] |
//! | the step | [`newton`], [`riccati`], [`regularisation`] |
//! | how far along the step | [`trial`], [`merit`], [`filter`], [`line_search`] |
//! | when no part of a step is accepted | [`restoration`] |
//! | the loop | [`InteriorPoint`] |

mod barrier;
mod breakdown;
mod chain;
mod convergence;
mod dense;
mod filter;
mod interior_point;
mod interruption;
mod iterate;
mod line_search;
mod merit;
mod newton;
mod regularisation;
mod restoration;
mod riccati;
/// A second engine of another kind, which tests compare the first with.
#[cfg(test)]
pub(crate) mod second_engine;
mod settings;
mod status;
#[cfg(test)]
pub(crate) mod tests;
mod trial;

#[cfg(test)]
pub(crate) use chain::models_of;
pub(crate) use chain::{Chain, Link, LinkModel, LinkMultipliers, LinkValues, values_of};
pub(crate) use interior_point::InteriorPoint;
pub(crate) use iterate::{Iterate, Layout};
pub(crate) use riccati::{MAX_CONTROLS, MAX_STATES};
pub(crate) use settings::Settings;
pub(crate) use status::{Breakdown, NlpReport, NlpStatus, Quantity};
