//! A small rasteriser: orthographic, one light, a depth buffer.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use importer::Mesh;
use importer::collider::{Shape, surface};

/// Side of one view, pixels.
const SIDE: usize = 340;
/// Views: mesh, collider, both.
const VIEWS: usize = 3;
/// Where it is looked at from, as directions of the picture's right, up and towards the eye.
const RIGHT: [f64; 3] = [0.8, 0.0, -0.6];
const UP: [f64; 3] = [-0.24, 0.917, -0.32];
const EYE: [f64; 3] = [0.55, 0.4, 0.733];
/// Light from over the left shoulder.
const LIGHT: [f64; 3] = [0.2, 0.85, 0.49];

/// A triangle soup of one colour.
struct Layer {
    triangles: Vec<[[f64; 3]; 3]>,
    colour: [f64; 3],
}

/// Mesh, collider, and both over one another, side by side as a PNG.
pub(super) fn write(path: &Path, mesh: &Mesh, shapes: &[Shape]) -> io::Result<()> {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    let model = |colour| Layer { triangles: mesh.triangles.iter().map(corners).collect(), colour };
    let pieces: Vec<Layer> = shapes
        .iter()
        .enumerate()
        .map(|(i, shape)| {
            let (positions, triangles) = surface(shape);
            Layer {
                triangles: triangles.iter().map(|t| t.map(|k| positions[k as usize])).collect(),
                colour: hue(i),
            }
        })
        .collect();
    let frame = Frame::around(mesh);
    let mut image = Image::new();
    image.draw(0, &frame, &[model([0.75, 0.75, 0.72])]);
    image.draw(1, &frame, &pieces);
    let mut both = vec![model([0.85, 0.2, 0.15])];
    both.extend(pieces.into_iter().map(|layer| Layer { colour: [0.62, 0.7, 0.8], ..layer }));
    image.draw(2, &frame, &both);
    image.save(path)
}

/// Colours that differ from their neighbours': steps of the golden ratio around the circle.
fn hue(index: usize) -> [f64; 3] {
    let turn = (index as f64 * 0.618_034).fract() * 6.0;
    let level = |shift: f64| (((turn + shift) % 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0) * 0.65 + 0.3;
    [level(0.0), level(4.0), level(2.0)]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// From file units to pixels and depth.
struct Frame {
    centre: [f64; 3],
    scale: f64,
}

impl Frame {
    fn around(mesh: &Mesh) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for p in mesh.triangles.iter().flatten().map(|&i| mesh.positions[i as usize]) {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let diagonal = (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt();
        Self {
            centre: std::array::from_fn(|k| (low[k] + high[k]) / 2.0),
            scale: SIDE as f64 * 0.94 / diagonal.max(f64::MIN_POSITIVE),
        }
    }

    fn place(&self, p: [f64; 3]) -> [f64; 3] {
        let q: [f64; 3] = std::array::from_fn(|k| (p[k] - self.centre[k]) * self.scale);
        let middle = SIDE as f64 / 2.0;
        [middle + dot(q, RIGHT), middle - dot(q, UP), dot(q, EYE)]
    }
}

struct Image {
    pixels: Vec<u8>,
}

impl Image {
    fn new() -> Self {
        Self { pixels: vec![255; SIDE * VIEWS * SIDE * 3] }
    }

    fn draw(&mut self, view: usize, frame: &Frame, layers: &[Layer]) {
        let mut depths = vec![f64::NEG_INFINITY; SIDE * SIDE];
        for layer in layers {
            for triangle in &layer.triangles {
                let [a, b, c] = triangle.map(|p| frame.place(p));
                let light = shade(triangle);
                let colour = layer.colour.map(|level| (level * light * 255.0) as u8);
                self.fill(view, [a, b, c], colour, &mut depths);
            }
        }
    }

    fn fill(&mut self, view: usize, [a, b, c]: [[f64; 3]; 3], colour: [u8; 3], depths: &mut [f64]) {
        let area = turn(a, b, c);
        if !area.is_normal() {
            return;
        }
        let range = |k: usize| {
            let low = a[k].min(b[k]).min(c[k]).floor().clamp(0.0, SIDE as f64) as usize;
            let high = a[k].max(b[k]).max(c[k]).ceil().clamp(0.0, SIDE as f64) as usize;
            low..high
        };
        for y in range(1) {
            for x in range(0) {
                let p = [x as f64 + 0.5, y as f64 + 0.5, 0.0];
                let weights = [turn(b, c, p) / area, turn(c, a, p) / area, turn(a, b, p) / area];
                if weights.iter().any(|weight| *weight < 0.0) {
                    continue;
                }
                let depth = a[2] * weights[0] + b[2] * weights[1] + c[2] * weights[2];
                if depth > depths[y * SIDE + x] {
                    depths[y * SIDE + x] = depth;
                    let at = (y * SIDE * VIEWS + view * SIDE + x) * 3;
                    self.pixels[at..at + 3].copy_from_slice(&colour);
                }
            }
        }
    }

    fn save(&self, path: &Path) -> io::Result<()> {
        let mut encoder =
            png::Encoder::new(BufWriter::new(File::create(path)?), (SIDE * VIEWS) as u32, SIDE as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        writer.write_image_data(&self.pixels).map_err(io::Error::other)
    }
}

/// Brightness of a face, the same from both sides.
fn shade([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    let edge = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| p[k] - a[k]) };
    let (u, v) = (edge(b), edge(c));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = dot(normal, normal).sqrt().max(f64::MIN_POSITIVE);
    0.45 + 0.55 * (dot(normal, LIGHT) / length).abs().min(1.0)
}

fn turn(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
