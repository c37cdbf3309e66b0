//! Small dense kernels on row-major slices.
//!
//! Rows have a handful of entries, where loops of unknown length cost several times their
//! arithmetic. The lengths of rows of three to six wheels are compiled.

/// `y += a^T x` for a row-major matrix with rows as long as `y`.
pub(super) fn add_transpose_mul(a: &[f64], x: &[f64], y: &mut [f64]) {
    match y.len() {
        6 => add_rows::<6>(a, x, y),
        7 => add_rows::<7>(a, x, y),
        8 => add_rows::<8>(a, x, y),
        9 => add_rows::<9>(a, x, y),
        10 => add_rows::<10>(a, x, y),
        12 => add_rows::<12>(a, x, y),
        14 => add_rows::<14>(a, x, y),
        16 => add_rows::<16>(a, x, y),
        columns => {
            for (row, &scale) in a.chunks_exact(columns).zip(x) {
                for (out, value) in y.iter_mut().zip(row) {
                    *out += scale * value;
                }
            }
        }
    }
}

/// `y = a x` for a row-major matrix with rows as long as `x`.
pub(super) fn mul(a: &[f64], x: &[f64], y: &mut [f64]) {
    match x.len() {
        6 => mul_rows::<6>(a, x, y),
        7 => mul_rows::<7>(a, x, y),
        8 => mul_rows::<8>(a, x, y),
        9 => mul_rows::<9>(a, x, y),
        10 => mul_rows::<10>(a, x, y),
        12 => mul_rows::<12>(a, x, y),
        14 => mul_rows::<14>(a, x, y),
        16 => mul_rows::<16>(a, x, y),
        columns => {
            for (out, row) in y.iter_mut().zip(a.chunks_exact(columns)) {
                *out = dot(row, x);
            }
        }
    }
}

fn add_rows<const COLUMNS: usize>(a: &[f64], x: &[f64], y: &mut [f64]) {
    let Some(y) = y.first_chunk_mut::<COLUMNS>() else {
        return;
    };
    // Not in place: the sum stays in registers.
    let mut sum = *y;
    for (row, scale) in a.as_chunks::<COLUMNS>().0.iter().zip(x) {
        for i in 0..COLUMNS {
            sum[i] += scale * row[i];
        }
    }
    *y = sum;
}

fn mul_rows<const COLUMNS: usize>(a: &[f64], x: &[f64], y: &mut [f64]) {
    let Some(x) = x.first_chunk::<COLUMNS>() else {
        return;
    };
    for (out, row) in y.iter_mut().zip(a.as_chunks::<COLUMNS>().0) {
        *out = paired_dot(row, x);
    }
}

/// Scalar product as two sums, of even and of odd places, which the processor forms at once.
fn paired_dot<const LENGTH: usize>(a: &[f64; LENGTH], b: &[f64; LENGTH]) -> f64 {
    let mut sums = [0.0; 2];
    for i in 0..LENGTH / 2 {
        sums[0] += a[2 * i] * b[2 * i];
        sums[1] += a[2 * i + 1] * b[2 * i + 1];
    }
    if LENGTH % 2 == 1 {
        sums[0] += a[LENGTH - 1] * b[LENGTH - 1];
    }
    sums[0] + sums[1]
}

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `y += scale x`.
pub(super) fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    for (out, value) in y.iter_mut().zip(x) {
        *out += scale * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compiled_lengths_and_others_multiply_alike() {
        for columns in 1..20 {
            let a: Vec<f64> = (0..3 * columns).map(|i| i as f64 - 7.0).collect();
            let x: Vec<f64> = (0..columns).map(|i| 0.5 * i as f64 - 2.0).collect();
            let mut y = [1.0; 3];
            mul(&a, &x, &mut y);
            let mut back = x.clone();
            add_transpose_mul(&a, &[1.0, -2.0, 0.5], &mut back);
            for (row, y) in a.chunks_exact(columns).zip(y) {
                assert!((y - dot(row, &x)).abs() < 1e-10);
            }
            for (i, (back, x)) in back.iter().zip(&x).enumerate() {
                let sum = a[i] - 2.0 * a[columns + i] + 0.5 * a[2 * columns + i];
                assert!((back - (x + sum)).abs() < 1e-10);
            }
        }
    }
}
