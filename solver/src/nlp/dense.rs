//! Small dense kernels on row-major slices.

/// `y += a^T x` for a row-major `rows x cols` matrix.
pub(super) fn add_transpose_mul(a: &[f64], cols: usize, x: &[f64], y: &mut [f64]) {
    for (row, &scale) in a.chunks_exact(cols).zip(x) {
        axpy(scale, row, y);
    }
}

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `y += scale x`.
pub(super) fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    if scale != 0.0 {
        for (out, value) in y.iter_mut().zip(x) {
            *out += scale * value;
        }
    }
}
