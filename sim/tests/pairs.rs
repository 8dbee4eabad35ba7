//! Known pairs of materials: their coefficients reach the solver, and faults are refused.

#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

mod common;

use common::{G, awake, cube, floor, scene, track};
use sim::{MaterialPair, SceneError, Surface, Velocity, World};

const fn made_of(material: u32) -> Surface {
    Surface { material: Some(material), ..Surface::new(0.5, 0.0) }
}

#[test]
fn a_sliding_cube_stops_where_the_friction_of_the_pair_stops_it() {
    for (friction, material) in [(0.2, 1), (0.5, 3)] {
        let mut cube = cube([0.0, 0.5, 0.0], made_of(material));
        cube.velocity = Velocity { linear: [2.0, 0.0, 0.0], angular: [0.0; 3] };
        let mut scene = scene(vec![floor(made_of(2)), cube]);
        scene.pairs = vec![MaterialPair { between: [2, 1], friction: Some(0.2), restitution: None }];
        let (track, _) = track(&scene, &awake(), 1, 2.0);
        let way = track.poses.last().unwrap().position[0];
        let expected = 2.0 * 2.0 / (2.0 * friction * G);
        assert!((way / expected - 1.0).abs() < 0.03, "{way} m, expected {expected} m");
    }
}

#[test]
fn a_pair_out_of_range_is_refused_by_name() {
    let mut scene = scene(vec![floor(made_of(2))]);
    scene.pairs = vec![MaterialPair { between: [2, 1], friction: None, restitution: Some(1.2) }];
    let refused = World::new(&scene, &awake()).err();
    assert!(
        matches!(refused, Some(SceneError::Pair { between: [2, 1], what: "restitution", .. })),
        "{refused:?}"
    );
}
