//! How many times slower one engine is than another, from rounds that ran side by side.

use serde::Serialize;

/// A ratio of times over paired rounds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// Geometric mean over the rounds.
    pub mean: f64,
    /// One-sided 95 % bounds by Student's t on the logarithms.
    pub lower_95: f64,
    pub upper_95: f64,
    pub rounds: usize,
}

/// One-sided 95 % quantiles of Student's t for 1, 2, … degrees of freedom (Abramowitz and Stegun, table 26.10);
/// the last stands for all beyond.
const T_95: [f64; 30] = [
    6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812, 1.796, 1.782, 1.771, 1.761, 1.753,
    1.746, 1.740, 1.734, 1.729, 1.725, 1.721, 1.717, 1.714, 1.711, 1.708, 1.706, 1.703, 1.701, 1.699, 1.697,
];

/// Ratio of `ours` to `theirs`, round by round. `None` without two rounds or with a time that is not above 0.
#[must_use]
pub fn ratio(ours: &[f64], theirs: &[f64]) -> Option<Ratio> {
    let logs: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| (a / b).ln()).collect();
    if logs.len() < 2 || !logs.iter().all(|log| log.is_finite()) {
        return None;
    }
    let n = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / n;
    let variance = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let bound = T_95[(logs.len() - 2).min(T_95.len() - 1)] * (variance / n).sqrt();
    Some(Ratio {
        mean: mean.exp(),
        lower_95: (mean - bound).exp(),
        upper_95: (mean + bound).exp(),
        rounds: logs.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_ratio_is_known_without_doubt() {
        let ratio = ratio(&[2.0, 4.0, 6.0], &[1.0, 2.0, 3.0]).expect("three rounds");
        for value in [ratio.mean, ratio.lower_95, ratio.upper_95] {
            assert!((value - 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn bounds_are_student_s() {
        // Logs 0 and 2 d: mean d, standard error d, t = 6.314.
        let d = 0.1_f64;
        let ratio = ratio(&[1.0, (2.0 * d).exp()], &[1.0, 1.0]).expect("two rounds");
        assert!((ratio.upper_95.ln() - (d + 6.314 * d)).abs() < 1e-12);
        assert!((ratio.lower_95.ln() - (d - 6.314 * d)).abs() < 1e-12);
        assert!(super::ratio(&[1.0], &[1.0]).is_none() && super::ratio(&[0.0, 1.0], &[1.0, 1.0]).is_none());
    }
}
