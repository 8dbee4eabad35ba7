//! The paper's figure 10: a dog on a terrain of 115,200 triangles, made by formula.

use sim::gallery::build::{scene, surface};
use sim::{Entity, Pose, Shape, Velocity};

use super::subject::Subject;

/// Cells along each side: 2 · 240² triangles.
const CELLS: u32 = 240;

/// Hills of about 0.7 m on a square of 24 m.
fn height_m(x: f64, z: f64) -> f64 {
    0.4 * (0.9 * x).sin() * (0.7 * z).cos()
        + 0.2 * (2.3 * x + 1.0).cos() * (1.9 * z).sin()
        + 0.1 * (0.4 * (x + z)).sin()
}

fn terrain() -> Entity {
    let side = 0.1;
    let at = |i: u32| side * (f64::from(i) - 0.5 * f64::from(CELLS));
    let points = CELLS + 1;
    let positions =
        (0..points).flat_map(|i| (0..points).map(move |k| [at(i), height_m(at(i), at(k)), at(k)]));
    let triangles = (0..CELLS)
        .flat_map(|i| (0..CELLS).map(move |k| i * points + k))
        .flat_map(|n| [[n, n + 1, n + points], [n + points, n + 1, n + points + 1]]);
    let shape = Shape::TriangleMesh { positions: positions.collect(), triangles: triangles.collect() };
    sim::gallery::build::fixed("terrain", Pose::IDENTITY, shape, surface(0.6, 0.1))
}

/// Nine of the dog, falling from a height of 1 to 2 m, each turned another way.
#[must_use]
pub fn on_terrain(dog: Entity) -> Subject {
    let mut entities = vec![terrain()];
    let reach = sim::measure::reach(&dog.shapes);
    for n in 0..9_u32 {
        let mut one = dog.clone();
        let (x, z) = (3.0 * f64::from(n % 3) - 3.0, 3.0 * f64::from(n / 3) - 3.0);
        let turned = sim::gallery::build::turn([0.6, 0.0, 0.8], 40.0 * f64::from(n));
        one.pose = Pose { position: [x, height_m(x, z) + reach + 0.5, z], rotation: turned };
        one.velocity = Velocity::default();
        entities.push(one);
    }
    let about = "nine of a model's dog fall on a terrain of 115,200 triangles".to_owned();
    Subject::in_group(
        "seed-dog",
        about,
        "The paper's scenes and the engines'",
        scene("seed-dog", entities),
        5.0,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_terrain_has_the_paper_s_triangles_and_looks_up() {
        let terrain = terrain();
        let Shape::TriangleMesh { positions, triangles } = &terrain.shapes[0].shape else {
            unreachable!("a mesh")
        };
        assert_eq!(triangles.len(), 115_200);
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            let (u, v): ([f64; 3], [f64; 3]) =
                (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
            assert!(sim::measure::cross(u, v)[1] > 0.0);
        }
    }
}
