//! Models made by code: boxes, turned profiles and bent tubes, with convex colliders.

use std::f32::consts::{PI, TAU};

use sim::{ChildShape, Entity, Mass, Motion, Pose, Shape, Surface, Velocity};
use viewer::{Visual, VisualMesh};

/// A model in its own frame: Y up, origin anywhere.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) category: &'static str,
    pub(crate) name: String,
    pub(crate) meshes: Vec<VisualMesh>,
    pub(crate) colliders: Vec<Shaped>,
}

/// A shape and where its origin is.
#[derive(Clone, Debug)]
pub(crate) struct Shaped(pub(crate) Shape, pub(crate) [f64; 3]);

const SURFACE: Surface = Surface::new(0.5, 0.2);

impl Model {
    /// A body of `density` kg/m³ as if its bounding box were a tenth full, tilted, its lowest point `height` m up.
    pub(crate) fn entity(&self, index: usize, height: f64, at: [f64; 2], tilt: f64) -> (Entity, Visual) {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in self.meshes.iter().flat_map(|m| &m.positions) {
            for i in 0..3 {
                low[i] = low[i].min(f64::from(point[i]));
                high[i] = high[i].max(f64::from(point[i]));
            }
        }
        let size: [f64; 3] = std::array::from_fn(|i| high[i] - low[i]);
        let center: [f64; 3] =
            std::array::from_fn(|i| (high[i] + low[i]) / 2.0 - if i == 1 { 0.1 * size[1] } else { 0.0 });
        let mass_kg = 60.0 * size[0] * size[1] * size[2];
        let square = size.map(|x| x * x);
        let moment = |a: usize, b: usize| mass_kg * (square[a] + square[b]) / 12.0;
        let inertia_kg_m2 = [moment(1, 2), moment(0, 2), moment(0, 1), 0.0, 0.0, 0.0];
        let shapes = self.colliders.iter().map(|Shaped(shape, origin)| ChildShape {
            shape: shape.clone(),
            body_from_shape: Pose::at(std::array::from_fn(|i| origin[i] - center[i])),
            surface: SURFACE,
            part: 0,
        });
        #[expect(clippy::cast_possible_truncation)]
        let shift = center.map(|x| x as f32);
        let meshes = self.meshes.iter().map(|mesh| VisualMesh {
            positions: mesh.positions.iter().map(|p| std::array::from_fn(|i| p[i] - shift[i])).collect(),
            ..mesh.clone()
        });
        let reach = size.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0;
        let lift = if tilt == 0.0 { center[1] - low[1] } else { reach };
        let half = tilt / 2.0;
        let entity = Entity {
            name: self.name.clone(),
            motion: Motion::Dynamic(Mass { mass_kg, inertia_kg_m2 }),
            pose: Pose {
                position: [at[0], lift + height, at[1]],
                rotation: [half.sin() * 0.6, 0.0, half.sin() * 0.8, half.cos()],
            },
            velocity: Velocity::default(),
            shapes: shapes.collect(),
        };
        (entity, Visual { entity: index, meshes: meshes.collect() })
    }
}

/// The floor of every scene.
pub(crate) fn floor() -> Entity {
    Entity {
        name: "floor".to_owned(),
        motion: Motion::Static,
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes: vec![ChildShape {
            shape: Shape::HalfSpace,
            body_from_shape: Pose::IDENTITY,
            surface: SURFACE,
            part: 0,
        }],
    }
}

/// A cube of half a metre, drawn by its shape.
pub(crate) fn cube(name: String, position: [f64; 3]) -> Entity {
    Entity {
        name,
        motion: Motion::Dynamic(Mass { mass_kg: 125.0, inertia_kg_m2: [5.2, 5.2, 5.2, 0.0, 0.0, 0.0] }),
        pose: Pose::at(position),
        velocity: Velocity::default(),
        shapes: vec![ChildShape {
            shape: Shape::Box { half_extents: [0.25; 3] },
            body_from_shape: Pose::IDENTITY,
            surface: SURFACE,
            part: 0,
        }],
    }
}

fn slab(center: [f32; 3], half: [f32; 3], color: [u8; 4]) -> (VisualMesh, Shaped) {
    let corner = |i: u8| -> [f32; 3] {
        std::array::from_fn(|k| center[k] + if i >> k & 1 == 1 { half[k] } else { -half[k] })
    };
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let shape = Shape::Box { half_extents: half.map(f64::from) };
    (
        VisualMesh { positions: (0..8).map(corner).collect(), triangles, color },
        Shaped(shape, center.map(f64::from)),
    )
}

fn of(category: &'static str, name: &str, parts: Vec<(VisualMesh, Shaped)>) -> Model {
    let (meshes, colliders) = parts.into_iter().unzip();
    Model { category, name: name.to_owned(), meshes, colliders }
}

const WOOD: [u8; 4] = [176, 122, 74, 255];
const DARK: [u8; 4] = [112, 74, 46, 255];
const RED: [u8; 4] = [186, 66, 58, 255];
const CHINA: [u8; 4] = [206, 214, 222, 255];
const BLUE: [u8; 4] = [70, 112, 178, 255];
const GREEN: [u8; 4] = [72, 132, 92, 255];
const YELLOW: [u8; 4] = [222, 178, 70, 255];

pub(crate) fn chair(name: &str) -> Model {
    let mut parts = vec![
        slab([0.0, 0.45, 0.0], [0.22, 0.02, 0.22], RED),
        slab([0.0, 0.72, -0.2], [0.2, 0.22, 0.015], WOOD),
    ];
    for (x, z) in [(-0.19, -0.19), (0.19, -0.19), (-0.19, 0.19), (0.19, 0.19)] {
        parts.push(slab([x, 0.215, z], [0.02, 0.215, 0.02], DARK));
    }
    of("furniture/chair", name, parts)
}

pub(crate) fn table(name: &str) -> Model {
    let mut parts = vec![slab([0.0, 0.73, 0.0], [0.7, 0.02, 0.4], WOOD)];
    for (x, z) in [(-0.64, -0.34), (0.64, -0.34), (-0.64, 0.34), (0.64, 0.34)] {
        parts.push(slab([x, 0.355, z], [0.03, 0.355, 0.03], DARK));
    }
    of("furniture/table", name, parts)
}

pub(crate) fn shelf(name: &str) -> Model {
    let mut parts = vec![
        slab([-0.38, 0.9, 0.0], [0.02, 0.9, 0.15], DARK),
        slab([0.38, 0.9, 0.0], [0.02, 0.9, 0.15], DARK),
    ];
    for k in 0..5u8 {
        parts.push(slab([0.0, 0.05 + 0.42 * f32::from(k), 0.0], [0.36, 0.015, 0.15], WOOD));
    }
    of("furniture/shelf", name, parts)
}

/// A profile of (radius, height) turned about Y.
fn turned(profile: &[(f32, f32)], color: [u8; 4]) -> VisualMesh {
    const AROUND: u32 = 48;
    let mut mesh = VisualMesh { color, ..VisualMesh::default() };
    for (radius, height) in profile {
        for i in 0..AROUND {
            #[expect(clippy::cast_precision_loss)]
            let turn = TAU * i as f32 / AROUND as f32;
            mesh.positions.push([radius * turn.cos(), *height, radius * turn.sin()]);
        }
    }
    for k in 1..u32::try_from(profile.len()).unwrap_or(0) {
        for i in 0..AROUND {
            let at = |ring: u32, i: u32| ring * AROUND + i % AROUND;
            let [a, b, c, d] = [at(k - 1, i), at(k - 1, i + 1), at(k, i), at(k, i + 1)];
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    mesh
}

/// A tube along a path in the XY plane, its radius going from `start` to `end`.
fn tube(path: &[[f32; 2]], start: f32, end: f32, color: [u8; 4]) -> VisualMesh {
    const AROUND: u32 = 16;
    let mut mesh = VisualMesh { color, ..VisualMesh::default() };
    for (k, point) in path.iter().enumerate() {
        let before = path[k.saturating_sub(1)];
        let after = path[(k + 1).min(path.len() - 1)];
        let [dx, dy] = [after[0] - before[0], after[1] - before[1]];
        let length = dx.hypot(dy);
        let side = [-dy / length, dx / length];
        #[expect(clippy::cast_precision_loss)]
        let radius = start + (end - start) * k as f32 / (path.len() - 1) as f32;
        for i in 0..AROUND {
            #[expect(clippy::cast_precision_loss)]
            let turn = TAU * i as f32 / AROUND as f32;
            let [s, c] = [radius * turn.sin(), radius * turn.cos()];
            mesh.positions.push([point[0] + side[0] * c, point[1] + side[1] * c, s]);
        }
    }
    for k in 1..u32::try_from(path.len()).unwrap_or(0) {
        for i in 0..AROUND {
            let at = |ring: u32, i: u32| ring * AROUND + i % AROUND;
            let [a, b, c, d] = [at(k - 1, i), at(k - 1, i + 1), at(k, i), at(k, i + 1)];
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    mesh
}

fn arc(center: [f32; 2], radius: [f32; 2], from: f32, to: f32) -> Vec<[f32; 2]> {
    (0..=14u8)
        .map(|k| from + (to - from) * f32::from(k) / 14.0)
        .map(|turn| [center[0] + radius[0] * turn.cos(), center[1] + radius[1] * turn.sin()])
        .collect()
}

/// Hull over every eighth point of a ring, which is near enough for a fall.
fn hull(meshes: &[VisualMesh]) -> Vec<Shaped> {
    let points = meshes[0].positions.iter().step_by(8).map(|p| p.map(f64::from)).collect();
    vec![Shaped(Shape::Hull { points }, [0.0; 3])]
}

pub(crate) fn teapot(name: &str) -> Model {
    let body = turned(
        &[
            (0.0, 0.0),
            (0.07, 0.0),
            (0.10, 0.02),
            (0.125, 0.06),
            (0.12, 0.10),
            (0.09, 0.14),
            (0.06, 0.155),
            (0.055, 0.16),
            (0.02, 0.175),
            (0.012, 0.18),
            (0.02, 0.19),
            (0.018, 0.2),
            (0.0, 0.205),
        ],
        BLUE,
    );
    let spout =
        tube(&[[0.1, 0.05], [0.14, 0.06], [0.165, 0.09], [0.18, 0.125], [0.205, 0.145]], 0.028, 0.011, BLUE);
    let handle = tube(&arc([-0.115, 0.085], [0.075, 0.05], PI * 0.42, PI * 1.58), 0.011, 0.011, CHINA);
    let meshes = vec![body, spout, handle];
    Model { category: "household/teapot", name: name.to_owned(), colliders: hull(&meshes), meshes }
}

pub(crate) fn mug(name: &str) -> Model {
    let body = turned(
        &[(0.0, 0.0), (0.04, 0.0), (0.042, 0.004), (0.042, 0.1), (0.038, 0.1), (0.038, 0.008), (0.0, 0.008)],
        YELLOW,
    );
    let handle = tube(&arc([0.042, 0.05], [0.03, 0.032], -PI * 0.5, PI * 0.5), 0.006, 0.006, YELLOW);
    let meshes = vec![body, handle];
    let can = Shape::Cylinder { half_height: 0.05, radius: 0.042 };
    Model {
        category: "household/mug",
        name: name.to_owned(),
        colliders: vec![Shaped(can, [0.0, 0.05, 0.0])],
        meshes,
    }
}

pub(crate) fn bottle(name: &str) -> Model {
    let body = turned(
        &[
            (0.0, 0.0),
            (0.036, 0.0),
            (0.038, 0.01),
            (0.038, 0.19),
            (0.03, 0.22),
            (0.014, 0.25),
            (0.013, 0.3),
            (0.016, 0.3),
            (0.016, 0.315),
            (0.0, 0.315),
        ],
        GREEN,
    );
    let meshes = vec![body];
    Model { category: "containers/bottle", name: name.to_owned(), colliders: hull(&meshes), meshes }
}

pub(crate) fn ball(name: &str) -> Model {
    let profile: Vec<(f32, f32)> = (0..=24u8)
        .map(|k| PI * f32::from(k) / 24.0)
        .map(|t| (0.11 * t.sin(), 0.11 - 0.11 * t.cos()))
        .collect();
    let meshes = vec![turned(&profile, RED)];
    Model {
        category: "toys/ball",
        name: name.to_owned(),
        colliders: vec![Shaped(Shape::Sphere { radius: 0.11 }, [0.0, 0.11, 0.0])],
        meshes,
    }
}

pub(crate) fn lamp(name: &str) -> Model {
    let foot = turned(
        &[(0.0, 0.0), (0.14, 0.0), (0.14, 0.015), (0.02, 0.03), (0.012, 0.05), (0.012, 0.36), (0.0, 0.36)],
        DARK,
    );
    let shade = turned(
        &[(0.16, 0.34), (0.09, 0.56), (0.085, 0.56), (0.155, 0.34), (0.16, 0.34)],
        [236, 222, 186, 255],
    );
    let colliders = vec![
        Shaped(Shape::Cylinder { half_height: 0.0125, radius: 0.14 }, [0.0, 0.0125, 0.0]),
        Shaped(Shape::Cylinder { half_height: 0.17, radius: 0.012 }, [0.0, 0.19, 0.0]),
        Shaped(Shape::Cylinder { half_height: 0.11, radius: 0.14 }, [0.0, 0.45, 0.0]),
    ];
    Model { category: "furniture/lamp", name: name.to_owned(), colliders, meshes: vec![foot, shade] }
}

/// `count` models, the same kinds side by side.
pub(crate) fn many(count: usize) -> Vec<Model> {
    let kinds: [fn(&str) -> Model; 8] = [chair, table, shelf, lamp, teapot, mug, bottle, ball];
    let each = count.div_ceil(kinds.len());
    kinds
        .iter()
        .flat_map(|make| (0..each).map(move |k| make(&format!("model_{k:02}.glb"))))
        .take(count)
        .collect()
}
