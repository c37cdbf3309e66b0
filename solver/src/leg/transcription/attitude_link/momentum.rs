//! What stored momentum adds to the derivatives of a link: the input `zeta = tau ts R(q)^T H`.

use super::LinkTerms;
use crate::leg::transcription::Transcription;
use crate::leg::transcription::rows::{add_attitude_block, double_cross_curvature};
use crate::nlp::{Chain, LinkModel};

impl Transcription {
    /// Adds the slopes and curvatures that go through `zeta`, whose derivative is
    /// `tau [eta]x d + eta dtau` with `eta = ts R(q)^T H`.
    pub(super) fn add_momentum_terms(&self, terms: &LinkTerms<'_>, out: &mut LinkModel) {
        let (vars, angle) = (out.vars, self.scales.angle);
        let (tau, eta) = (terms.tau, terms.momentum);
        let turned = eta.cross_matrix() * (tau * angle);
        let (slope, mixed, gradient) = (terms.slopes[2], terms.mixed[2], terms.gradient[2]);
        let [az, cz, zz] = [0, 1, 2].map(|input| terms.block(input, 2));
        let (h_row, m_row) = (3, self.state_dim());
        let length_row = m_row + self.wheels();

        let (by_attitude, by_length) = (slope * turned, slope * eta);
        for row in 0..3 {
            let line = &mut out.link_jacobian[row * vars..(row + 1) * vars];
            for column in 0..3 {
                line[column] += by_attitude[(row, column)];
            }
            line[length_row] += by_length[row];
        }

        // Pairs with the wheels, whose inputs move by -tau gain.
        let both = az + cz;
        for (i, gain) in self.rate_gain.iter().enumerate() {
            let (h, m) = (both.tr_mul(gain) * -tau, cz.tr_mul(gain) * -tau);
            let (h_attitude, m_attitude) = (turned.tr_mul(&h), turned.tr_mul(&m));
            for axis in 0..3 {
                out.hessian[(h_row + i) * vars + axis] += h_attitude[axis];
                out.hessian[(m_row + i) * vars + axis] += m_attitude[axis];
            }
            out.hessian[length_row * vars + h_row + i] += h.dot(&eta);
            out.hessian[length_row * vars + m_row + i] += m.dot(&eta);
        }

        // Pairs with the length, which moves the inputs by (-b, -e, eta).
        let along = zz * eta - az.tr_mul(&terms.begin) - cz.tr_mul(&terms.end);
        let length_attitude = turned.tr_mul(&along) + mixed * eta + gradient.cross(&eta) * angle;
        for axis in 0..3 {
            out.hessian[length_row * vars + axis] += length_attitude[axis];
        }
        let twice = along * 2.0 - zz * eta;
        out.hessian[length_row * vars + length_row] += twice.dot(&eta);

        // Pairs of attitude steps.
        let crossed = mixed * turned;
        let bend = double_cross_curvature(&gradient, &eta) * (tau * angle * angle);
        let block = turned.tr_mul(&(zz * turned)) + crossed + crossed.transpose() + bend;
        add_attitude_block(out, &block);
    }
}
