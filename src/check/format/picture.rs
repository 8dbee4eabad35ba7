//! A small picture of a model, for who reads a report and does not know it by name.

use std::path::Path;

use super::png;

/// Pixels: twice what the page gives it, so that edges are smooth there and sharp on a dense screen.
const WIDTH: usize = 480;
const HEIGHT: usize = 360;

/// Seen from the front, a little from the right and from above, degrees.
const YAW_DEG: f64 = 35.0;
const PITCH_DEG: f64 = 25.0;

/// Towards the light, in the viewer's frame: over the left shoulder.
const LIGHT: [f64; 3] = [-0.45, 0.65, 0.61];

/// The model's file as a `data:` URI of a PNG; `None` where it cannot be read or shows nothing from here.
pub(super) fn data_uri(file: &Path) -> Option<String> {
    let options =
        importer::Options { shapes: Some(mapper::shapes_file::READER), ..importer::Options::default() };
    let source = importer::read(file, &options).ok()?;
    let mesh = source.merged();
    let upright = mapper::scene::upright(source.frame.up);
    let positions: Vec<[f64; 3]> =
        mesh.positions.iter().map(|position| turned(mapper::scene::rotate(upright, *position))).collect();
    let pixels = drawn(&positions, &mesh.triangles)?;
    #[expect(clippy::cast_possible_truncation, reason = "a fixed size")]
    let png = png::grey_alpha(WIDTH as u32, HEIGHT as u32, &pixels);
    Some(format!("data:image/png;base64,{}", png::base64(&png)))
}

/// World to viewer: x right, y up, z towards the eye.
fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = YAW_DEG.to_radians().sin_cos();
    let (x, z) = (cos * x - sin * z, sin * x + cos * z);
    let (sin, cos) = PITCH_DEG.to_radians().sin_cos();
    [x, cos * y - sin * z, sin * y + cos * z]
}

/// Orthographic, with a depth buffer; grey by the angle to the light, clear where there is nothing.
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels"
)]
fn drawn(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Option<Vec<[u8; 2]>> {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for corner in triangles.iter().flatten() {
        let position = positions.get(*corner as usize)?;
        for axis in 0..2 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let [wide, tall] = [high[0] - low[0], high[1] - low[1]];
    if !(wide.is_finite() && tall.is_finite() && wide.max(tall) > 0.0) {
        return None;
    }
    let scale = (WIDTH as f64 * 0.92 / wide.max(1e-300)).min(HEIGHT as f64 * 0.92 / tall.max(1e-300));
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let on_screen = |corner: u32| {
        let [x, y, z] = positions[corner as usize];
        [
            WIDTH as f64 * 0.5 + (x - middle[0]) * scale,
            HEIGHT as f64 * 0.5 - (y - middle[1]) * scale,
            z * scale,
        ]
    };
    let mut pixels = vec![[0, 0]; WIDTH * HEIGHT];
    let mut depth = vec![f64::NEG_INFINITY; WIDTH * HEIGHT];
    for triangle in triangles {
        let [a, b, c] = triangle.map(on_screen);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 || !area.is_finite() {
            continue;
        }
        let grey = shade(a, b, c);
        let bounds = |axis: usize, most: usize| {
            let least = a[axis].min(b[axis]).min(c[axis]).floor().max(0.0);
            let last = a[axis].max(b[axis]).max(c[axis]).ceil().min(most as f64 - 1.0);
            (least as usize, last.max(0.0) as usize)
        };
        let ((left, right), (top, bottom)) = (bounds(0, WIDTH), bounds(1, HEIGHT));
        for row in top..=bottom {
            for column in left..=right {
                let [x, y] = [column as f64 + 0.5, row as f64 + 0.5];
                let weight = |p: [f64; 3], q: [f64; 3]| {
                    ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area
                };
                let [u, v, w] = [weight(b, c), weight(c, a), weight(a, b)];
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let z = u * a[2] + v * b[2] + w * c[2];
                let at = row * WIDTH + column;
                if z > depth[at] {
                    depth[at] = z;
                    pixels[at] = [grey, 255];
                }
            }
        }
    }
    pixels.iter().any(|[_, alpha]| *alpha > 0).then_some(pixels)
}

/// Lambert's law, both sides alike: many files are wound either way.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a grey level")]
fn shade(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> u8 {
    let [p, q]: [[f64; 3]; 2] = [b, c].map(|corner| std::array::from_fn(|axis| corner[axis] - a[axis]));
    // The screen's y points down.
    let normal = [-(p[1] * q[2] - p[2] * q[1]), p[2] * q[0] - p[0] * q[2], -(p[0] * q[1] - p[1] * q[0])];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let facing = if normal[2] < 0.0 { -1.0 } else { 1.0 };
    let light =
        facing * (0..3).map(|axis| normal[axis] * LIGHT[axis]).sum::<f64>() / length.max(f64::MIN_POSITIVE);
    (70.0 + 165.0 * light.max(0.0)).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_triangle_is_seen_and_the_rest_is_clear() {
        // A triangle that faces the eye before one that leans away.
        let positions = [
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, 1.0],
            [0.0, 1.0, 1.0],
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [0.0, 1.0, -3.0],
        ];
        let alone = drawn(&positions, &[[0, 1, 2]]).expect("drawn");
        let both = drawn(&positions, &[[3, 4, 5], [0, 1, 2]]).expect("drawn");
        assert_eq!(alone, both);
        assert_eq!(alone[0], [0, 0]);
        let middle = alone[HEIGHT / 2 * WIDTH + WIDTH / 2];
        assert!(middle[0] > 150 && middle[1] == 255, "{middle:?}");
        assert!(drawn(&positions, &[]).is_none());
        let edge_on = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(drawn(&edge_on, &[[0, 1, 2]]).is_none(), "nothing of it is seen from here");
    }
}
