//! A world with known faults, and the gate's command line for it.

use super::world::World;

const BASE: [&str; 8] =
    ["check", "models", "--db", "catalogue.db", "--catalog", "catalog.yaml", "--quiet", "--show=info"];

pub(crate) fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    BASE.iter().copied().chain(more.iter().copied()).collect()
}

/// A world with two faults: a crate far too heavy, and one that nothing names.
pub(crate) fn faulty() -> (tempfile::TempDir, World) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut world = World::clean(11);
    world.put("models/storage/crate_b.physics.yaml", "mass: 150 kg\n");
    world.put_box("misc/q17.glb", [0.2, 0.15, 0.2]);
    world.write(folder.path());
    (folder, world)
}
