//! Small dense kernels on row-major slices, written for blocks of four to twenty rows.

/// `y += a x` for a row-major `rows x cols` matrix.
pub(super) fn add_mul(a: &[f64], cols: usize, x: &[f64], y: &mut [f64]) {
    for (row, out) in a.chunks_exact(cols).zip(y) {
        *out += dot(row, x);
    }
}

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

/// `m += scale r r^T`, lower triangle only, skipping the zeros of a sparse row.
pub(super) fn add_outer_lower(m: &mut [f64], n: usize, scale: f64, r: &[f64]) {
    for (i, &ri) in r.iter().enumerate() {
        if ri != 0.0 {
            axpy(scale * ri, &r[..=i], &mut m[i * n..=i * n + i]);
        }
    }
}

/// Cholesky factor of the symmetric `n x n` matrix in the lower triangle, in place.
///
/// Returns false when a pivot is not safely positive.
pub(super) fn cholesky(a: &mut [f64], n: usize) -> bool {
    for i in 0..n {
        let (above, rest) = a.split_at_mut(i * n);
        let row = &mut rest[..=i];
        let diagonal = row[i];
        for j in 0..i {
            let other = &above[j * n..=j * n + j];
            let value = (row[j] - dot(&row[..j], &other[..j])) / other[j];
            row[j] = value;
        }
        let pivot = diagonal - dot(&row[..i], &row[..i]);
        // Positive by more than the cancellation error of the pivot itself.
        if !(pivot > 1e-14 * diagonal.abs() && pivot > 1e-300) {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// Solves `L L^T x = b` in place.
pub(super) fn cholesky_solve(l: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        b[i] = (b[i] - dot(&l[i * n..i * n + i], &b[..i])) / l[i * n + i];
    }
    for i in (0..n).rev() {
        b[i] /= l[i * n + i];
        let x = b[i];
        for j in 0..i {
            b[j] -= l[i * n + j] * x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cholesky_solves_and_refuses_indefinite() {
        let a = [4.0, 0.0, 0.0, 2.0, 5.0, 0.0, -1.0, 1.0, 3.0];
        let mut l = a;
        assert!(cholesky(&mut l, 3));
        let mut x = [1.0, -2.0, 0.5];
        cholesky_solve(&l, 3, &mut x);
        let full = [4.0, 2.0, -1.0, 2.0, 5.0, 1.0, -1.0, 1.0, 3.0];
        let mut product = [0.0; 3];
        add_mul(&full, 3, &x, &mut product);
        for (got, want) in product.iter().zip([1.0, -2.0, 0.5]) {
            assert!((got - want).abs() < 1e-14);
        }
        let mut indefinite = [1.0, 0.0, 2.0, 1.0];
        assert!(!cholesky(&mut indefinite, 2));
    }
}
