//! Ground whose height is given on a grid.

/// Heights over a rectangle of the plane y = 0, centred on the origin: rows along X, one after the other along Z.
/// Each cell is parted along the diagonal from its corner of least X and Z. Static only.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    /// m, row by row.
    pub heights: Vec<f64>,
    /// Heights in a row; two or more.
    pub columns: u32,
    /// m between columns (along X) and between rows (along Z).
    pub spacing: [f64; 2],
}

impl HeightField {
    /// Rows of the grid.
    #[must_use]
    pub fn rows(&self) -> u32 {
        u32::try_from(self.heights.len()).unwrap_or(0).checked_div(self.columns).unwrap_or(0)
    }

    /// Its surface: positions in m and triangles, counter-clockwise seen from above.
    #[must_use]
    pub fn mesh(&self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let (columns, rows) = (self.columns, self.rows());
        let middle = |count: u32| 0.5 * f64::from(count.saturating_sub(1));
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let positions = places
            .zip(&self.heights)
            .map(|((row, column), &height)| {
                let x = (f64::from(column) - middle(columns)) * self.spacing[0];
                let z = (f64::from(row) - middle(rows)) * self.spacing[1];
                [x, height, z]
            })
            .collect();
        let mut triangles = Vec::new();
        for row in 1..rows {
            for column in 1..columns {
                let at = |row: u32, column: u32| row * columns + column;
                let [near, right] = [at(row - 1, column - 1), at(row - 1, column)];
                let [far, across] = [at(row, column - 1), at(row, column)];
                triangles.extend([[near, across, right], [near, far, across]]);
            }
        }
        (positions, triangles)
    }

    /// What is wrong with it, in words.
    pub(crate) fn fault(&self) -> Option<String> {
        let whole = self.columns >= 2 && self.heights.len().is_multiple_of(self.columns as usize);
        if !whole || self.rows() < 2 {
            let count = self.heights.len();
            return Some(format!(
                "{count} heights in rows of {}; expected two or more whole rows of two or more",
                self.columns
            ));
        }
        if !self.spacing.iter().all(|spacing| *spacing > 0.0 && spacing.is_finite()) {
            return Some(format!("spacing is {:?} m; expected finite numbers above 0", self.spacing));
        }
        self.heights
            .iter()
            .position(|height| !height.is_finite())
            .map(|i| format!("height {i} is not finite"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_is_a_plane_seen_from_above() {
        let field =
            HeightField { heights: vec![0.0, 1.0, 2.0, 0.0, 1.0, 2.0], columns: 3, spacing: [0.5, 2.0] };
        assert_eq!(field.fault(), None);
        let (positions, triangles) = field.mesh();
        assert_eq!((positions.len(), triangles.len()), (6, 4));
        for [a, b, c] in triangles {
            let [a, b, c] = [a, b, c].map(|i| crate::math::Vec3::from(positions[i as usize]));
            let normal = (b - a).cross(&(c - a)).normalize();
            // Rise 1 over 0.5 along x.
            let truth = crate::math::Vec3::new(-2.0, 1.0, 0.0).normalize();
            assert!((normal - truth).norm() < 1e-14, "{normal:?}");
        }
        assert!(HeightField { columns: 4, ..field }.fault().is_some());
    }
}
