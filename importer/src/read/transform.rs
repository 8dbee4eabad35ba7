//! Node transforms in double precision: a 3 x 4 matrix, since the last row of a node's is 0 0 0 1.

use serde::Deserialize;

/// Columns: the images of the three axes, then the translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transform(pub [[f64; 3]; 4]);

/// The transform of a node as written: the `gltf` crate rounds it to single precision, in which a place on Earth
/// is known to half a metre.
#[derive(Deserialize)]
struct Node {
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

/// Of every node of a document that is known to parse, relative to its parent.
pub(super) fn of_nodes(json: &[u8]) -> Vec<Transform> {
    #[derive(Deserialize)]
    struct Document {
        #[serde(default)]
        nodes: Vec<Node>,
    }
    let document = serde_json::from_slice(json);
    document
        .map_or_else(|_| Vec::new(), |document: Document| document.nodes.iter().map(Transform::of).collect())
}

impl Transform {
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]);

    fn of(node: &Node) -> Self {
        if let Some(matrix) = node.matrix {
            return Self::of_columns(matrix);
        }
        Self::of_parts(
            node.translation.unwrap_or([0.0; 3]),
            node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
            node.scale.unwrap_or([1.0; 3]),
        )
    }

    /// Scale, then rotation, then translation.
    pub fn of_parts(translation: [f64; 3], [x, y, z, w]: [f64; 4], scale: [f64; 3]) -> Self {
        let length = x * x + y * y + z * z + w * w;
        // Exporters write quaternions to six digits: what is nearly of unit length is meant to be.
        let double = if length > 0.0 { 2.0 / length } else { 0.0 };
        let rotation = [
            [1.0 - double * (y * y + z * z), double * (x * y + z * w), double * (x * z - y * w)],
            [double * (x * y - z * w), 1.0 - double * (x * x + z * z), double * (y * z + x * w)],
            [double * (x * z + y * w), double * (y * z - x * w), 1.0 - double * (x * x + y * y)],
        ];
        let column = |axis: usize| rotation[axis].map(|value| value * scale[axis]);
        Self([column(0), column(1), column(2), translation])
    }

    /// Of a column-major 4 x 4 matrix.
    pub fn of_columns(matrix: [f64; 16]) -> Self {
        Self(std::array::from_fn(|column| std::array::from_fn(|row| matrix[4 * column + row])))
    }

    /// The weighted sum of transforms, as skinning blends them.
    pub fn blend(parts: impl Iterator<Item = (f64, Self)>) -> Self {
        let mut sum = Self([[0.0; 3]; 4]);
        for (weight, part) in parts {
            for (total, value) in sum.0.as_flattened_mut().iter_mut().zip(part.0.as_flattened()) {
                *total += weight * value;
            }
        }
        sum
    }

    /// `self` after `inner`.
    pub fn after(&self, inner: &Self) -> Self {
        let mut product = inner.0.map(|column| self.turn(column));
        for (value, offset) in product[3].iter_mut().zip(self.0[3]) {
            *value += offset;
        }
        Self(product)
    }

    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(point);
        std::array::from_fn(|axis| turned[axis] + self.0[3][axis])
    }

    fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        let [a, b, c, _] = self.0;
        std::array::from_fn(|axis| a[axis] * vector[0] + b[axis] * vector[1] + c[axis] * vector[2])
    }

    /// Negative where the transform turns the surface inside out.
    pub fn determinant(&self) -> f64 {
        let [a, b, c, _] = self.0;
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(json: &str) -> Node {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn scale_then_rotation_then_translation() {
        let quarter = std::f64::consts::FRAC_1_SQRT_2;
        let text =
            format!(r#"{{"translation":[1,2,3],"rotation":[0,0,{quarter},{quarter}],"scale":[2,1,-1]}}"#);
        let transform = Transform::of(&node(&text));
        let image = transform.apply([1.0, 1.0, 1.0]);
        for (found, expected) in image.into_iter().zip([0.0, 4.0, 2.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert!((transform.determinant() + 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_chain_is_the_product() {
        let outer = Transform::of(&node(r#"{"matrix":[0,0,-1,0,0,1,0,0,1,0,0,0,5,6,7,1]}"#));
        let inner = Transform::of(&node(r#"{"scale":[1,2,3],"translation":[4,5,6]}"#));
        let point = [0.5, -1.0, 2.0];
        assert_eq!(outer.after(&inner).apply(point), outer.apply(inner.apply(point)));
        assert_eq!(outer.after(&Transform::IDENTITY), outer);
    }
}
