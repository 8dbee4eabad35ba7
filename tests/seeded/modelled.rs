//! Faults of models, of what was measured of them, and of how they behave.

use importer::VolumeMethod;
use importer::collider::Shape;
use physique::demo::Mesh;
use serde_json::json;

use crate::mutation::{Mutation, asset, fault, proof};
use crate::world::{World, cuboid, glb};

const CATALOG: &str = "catalog.yaml";
const SIDECAR: &str = "models/storage/crate_b.physics.yaml";
const CRATE: &str = "storage/crate_a.glb";
const CRATE_B: &str = "storage/crate_b.glb";
const BRICK: &str = "storage/brick_a.glb";
const ANVIL: &str = "tools/anvil.glb";

pub(crate) const MUTATIONS: &[Mutation] = &[
    // Geometry.
    fault("a missing face", "GEO001", |w, _| w.reshape(CRATE, |mesh| mesh.triangles.truncate(11))).of(CRATE),
    fault("a body inside out", "GEO002", |w, _| {
        w.reshape(CRATE, |mesh| mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1)));
    })
    .of(CRATE),
    fault("a triangle wound against its neighbours", "GEO003", |w, rng| {
        let index = usize::try_from(rng.next() % 12).unwrap_or(0);
        w.reshape(CRATE, |mesh| mesh.triangles[index].swap(0, 1));
    })
    .of(CRATE),
    fault("triangles without area", "GEO004", |w, _| w.reshape(CRATE, |mesh| mesh.triangles.extend([[0, 0, 1]; 3]))).of(CRATE),
    fault("a fin on an edge", "GEO005", |w, _| {
        w.reshape(CRATE, |mesh| {
            mesh.positions.push([0.3, 0.4, 0.0]);
            mesh.triangles.push([0, 1, 8]);
        });
    })
    .of(CRATE),
    fault("a sheet without thickness", "GEO006", |w, _| w.put_box(CRATE, [0.2, 0.000_05, 0.2])).of(CRATE),
    fault("millimetres taken for metres", "GEO007", |w, _| w.edit(SIDECAR, "mass:", "unit: mm\nmass:")).of(CRATE_B).at(CATALOG, "[30 cm, 80 cm]"),
    fault("a size that fits no unit", "GEO008", |w, _| w.put_box(CRATE, [2.5, 1.8, 2.2])).of(CRATE),
    fault("a format without units", "GEO009", |w, _| obj(w, "storage/crate_c", "")).of("storage/crate_c.obj"),
    fault("a format without an up axis", "GEO010", |w, _| stl(w, "storage/crate_c.stl")).of("storage/crate_c.stl"),
    fault("a model far from its origin", "GEO011", |w, rng| {
        let far = rng.between(20.0, 40.0);
        w.reshape(CRATE, |mesh| mesh.positions.iter_mut().for_each(|position| position[0] += far));
    })
    .of(CRATE),
    fault("more triangles than the bound of the configuration", "GEO012", |w, _| bounds(w, "GEO012: 11")).of(CRATE),
    fault("more bodies than the bound of the configuration", "GEO013", |w, _| bounds(w, "GEO013: 0")).of(CRATE),
    fault("half millimetres taken for metres", "GEO014", |w, _| w.edit(SIDECAR, "mass:", "unit: 0.5 mm\nmass:")).of(CRATE_B),
    fault("kilometres taken for metres", "GEO015", |w, _| w.edit(SIDECAR, "mass:", "unit: 2 km\nmass:")).of(CRATE_B),
    fault("a face of a corner that is not there", "GEO016", |w, _| obj(w, "storage/crate_c", "f 1 2 99\n")).of("storage/crate_c.obj"),
    // Mass.
    fault("nothing to weigh", "MAS001", |w, _| {
        let mut sheet = cuboid([0.3, 0.1, 0.2]);
        sheet.triangles.truncate(2);
        sheet.positions.iter_mut().for_each(|position| position[0] = 0.0);
        w.put_model("misc/q17.glb", glb(sheet));
    })
    .of("misc/q17.glb"),
    fault("a crate like an anvil", "MAS002", |w, rng| {
        let mass = rng.between(90.0, 200.0);
        w.put(SIDECAR, &format!("mass: {mass} kg\n"));
    })
    .of(CRATE_B)
    .at(SIDECAR, "mass:"),
    fault("a mass model far off", "MAS003", |w, _| w.edit(CATALOG, "mass: [2 kg, 25 kg]", "mass: [0.3 kg, 0.6 kg]"))
        .of(CRATE)
        .at(CATALOG, "{ fill: 0.2 }"),
    fault("a mass against a density", "MAS004", |w, _| {
        w.put("models/storage/brick_a.physics.yaml", "mass: 8.5 kg\n");
    })
    .of(BRICK)
    .at("models/storage/brick_a.physics.yaml", "8.5"),
    asset("an inertia that no body has", "MAS005", |asset| {
        asset.measures.solid.iter_mut().for_each(|solid| solid.inertia[0] = solid.inertia[1] * 9.0);
    })
    .of(CRATE),
    asset("a centre beside the mesh", "MAS006", |asset| {
        asset.measures.solid.iter_mut().for_each(|solid| solid.centroid = [5.0, 0.0, 0.0]);
    })
    .of(CRATE),
    Mutation {
        change: |w, _| w.edit(CATALOG, "        mass: [1 kg, 9 kg]\n", ""),
        ..asset("a mass by the hull", "MAS007", |asset| asset.measures.solid_method = Some(VolumeMethod::Hull))
    }
    .of(BRICK)
    .at(CATALOG, "mass_model: solid"),
    fault("a brick denser than osmium", "MAS008", |w, _| w.put("models/storage/brick_a.physics.yaml", "mass: 300 kg\n"))
        .of(BRICK)
        .at("models/storage/brick_a.physics.yaml", "300"),
    fault("a crate lighter than air", "MAS009", |w, _| w.put(SIDECAR, "mass: 2 g\n")).of(CRATE_B).at(SIDECAR, "2 g"),
    asset("an inertia of another unit", "MAS010", |asset| {
        asset.measures.solid.iter_mut().for_each(|solid| solid.inertia = solid.inertia.map(|entry| entry * 10.0));
    })
    .of(CRATE),
    fault("a mass by the range", "MAS011", |w, _| w.reshape(CRATE, two_sides)).of(CRATE).at(CATALOG, "[2 kg, 25 kg]"),
    asset("a centre beside the collider", "MAS013", |asset| {
        asset.measures.solid.iter_mut().for_each(|solid| solid.centroid = [5.0, 0.0, 0.0]);
    })
    .of(CRATE),
    asset("a volume known by half", "MAS014", |asset| {
        asset.measures.solid_method = Some(VolumeMethod::Capped);
        asset.measures.solid_error = Some(0.5);
    })
    .of(CRATE)
    .at(CATALOG, "{ fill: 0.2 }"),
    // Colliders.
    asset("no collider", "COL001", |asset| asset.ladder.clear()).of(CRATE),
    asset("a collider off its mesh", "COL002", |asset| errors(asset, |error| error.surface_p95 = 0.06)).of(CRATE),
    asset("a collider far off its mesh", "COL003", |asset| errors(asset, |error| error.surface_max = 0.2)).of(CRATE),
    asset("a collider that grows", "COL004", |asset| errors(asset, |error| error.growth_max = 0.1)).of(CRATE),
    asset("a collider that misses", "COL005", |asset| errors(asset, |error| error.outside_share = 0.5)).of(CRATE),
    asset("a collider too big", "COL006", |asset| errors(asset, |error| error.volume_ratio = Some(3.0))).of(CRATE),
    asset("a collider too small", "COL007", |asset| errors(asset, |error| error.volume_ratio = Some(0.4))).of(CRATE),
    asset("a collider of many pieces", "COL008", |asset| {
        asset.ladder.iter_mut().for_each(|candidate| candidate.shapes = vec![candidate.shapes[0].clone(); 70]);
    })
    .of(CRATE),
    asset("a collider of many corners", "COL009", |asset| {
        asset.ladder.iter_mut().for_each(|candidate| candidate.vertices = 5000);
    })
    .of(CRATE),
    asset("a collider by a detour", "COL010", |asset| {
        asset.ladder.iter_mut().for_each(|candidate| candidate.fallback = Some("the hull failed".to_owned()));
    })
    .of(CRATE),
    asset("a bare surface that moves", "COL011", bare_surface).of(CRATE),
    fault("a thin plate", "COL012", |w, _| w.put_box(CRATE, [0.15, 0.000_4, 0.1])).of(CRATE),
    // Simulation: what can be brought about by models and mappings is, the rest by what the trials showed.
    asset("a body that the solver refuses", "SIM001", bare_surface).of(CRATE),
    fault("a thing that bounces for ever", "SIM002", |w, _| w.put(SIDECAR, "restitution: 1\n")).of(CRATE_B).at(SIDECAR, "restitution"),
    proof("energy from nowhere", "SIM003", |proof| proof["drop"]["energy_rise_percent"] = json!(0.4)).of(CRATE),
    proof("a body sunk in", "SIM004", |proof| proof["drop"]["rest_depth"] = json!(1.7)).of(CRATE),
    proof("a body that sinks on impact", "SIM005", |proof| proof["drop"]["most_depth"] = json!(9.0)).of(CRATE),
    proof("a body that tunnels", "SIM006", |proof| proof["drop"]["tunnelled"] = json!(true)).of(CRATE),
    proof("a body that is thrown", "SIM007", |proof| proof["drop"]["launch_percent"] = json!(12.0)).of(CRATE),
    proof("a body that is no number", "SIM008", |proof| proof["drop"]["quarantined"] = json!(true)).of(CRATE),
    proof("a slope that does not hold", "SIM009", |proof| proof["slope"]["hold_percent"]["ours"] = json!(6.0)).of(CRATE).at(CATALOG, "friction_dynamic: { value"),
    proof("a slope that holds too well", "SIM010", |proof| proof["slope"]["slide_percent"]["ours"] = json!(4.0)).of(CRATE),
    proof("a body that creeps", "SIM011", |proof| proof["stay"]["ours"] = json!(3.0)).of(CRATE),
    fault("a model that leans over", "SIM012", |w, rng| {
        let lean = rng.between(0.5, 0.6);
        w.reshape(CRATE, |mesh| mesh.positions.iter_mut().filter(|p| p[1] > 0.1).for_each(|p| p[0] += lean));
    })
    .of(CRATE),
    proof("a body that falls from a broad base", "SIM013", |proof| proof["stand"]["tilt_deg"]["ours"] = json!(80.0)).of(CRATE),
    fault("bricks with a roof", "SIM014", |w, _| {
        let [x, y, _] = w.boxes[BRICK];
        w.reshape(BRICK, |mesh| {
            // A steep ridge off the middle: nothing stands on it.
            mesh.positions.iter_mut().filter(|p| p[1] > y).for_each(|p| *p = [x * (0.3 + 0.002 * p[0].signum()), p[1] * 2.0, p[2]]);
        });
    })
    .of(BRICK),
    fault("a crate on ice", "SIM015", |w, _| w.put(SIDECAR, "friction_dynamic: 0.01\n")).of(CRATE_B).at(SIDECAR, "friction_dynamic"),
    proof("another rest in rapier", "SIM016", |proof| proof["drop"]["rapier_differs"] = json!("lies on another side")).of(CRATE),
    proof("another slope in rapier", "SIM017", |proof| proof["slope"]["hold_percent"]["rapier"] = json!(60.0)).of(CRATE),
    proof("no rest in rapier", "SIM018", |proof| proof["stay"]["rapier"] = json!(40.0)).of(CRATE),
    proof("another stack in rapier", "SIM019", |proof| proof["stack"] = json!({ "ours": 0.1, "rapier": 170.0 })).of(CRATE),
    // Import.
    fault("a format that it is not", "IMP003", |w, _| w.put_model("storage/crate_c.glb", b"once upon a time".to_vec())).of("storage/crate_c.glb"),
    fault("half a file", "IMP003", |w, rng| {
        let mut bytes = w.files[&format!("models/{CRATE}")].clone();
        let kept = bytes.len() / 2 + usize::try_from(rng.next() % 40).unwrap_or(0);
        bytes.truncate(kept);
        w.put_model(CRATE, bytes);
    })
    .of(CRATE),
    fault("an extension that is required and not read", "IMP004", |w, _| {
        let text = json!({ "asset": { "version": "2.0" }, "extensionsUsed": ["KHR_gaussian_splatting"], "extensionsRequired": ["KHR_gaussian_splatting"] });
        w.put_model("storage/crate_c.gltf", text.to_string().into_bytes());
    })
    .of("storage/crate_c.gltf"),
    fault("a buffer that is not there", "IMP005", |w, _| {
        let text = json!({
            "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "uri": "gone.bin", "byteLength": 36 }],
        });
        w.put_model("storage/crate_c.gltf", text.to_string().into_bytes());
    })
    .of("storage/crate_c.gltf"),
    fault("points without a surface", "IMP006", |w, _| w.put_model("storage/crate_c.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_vec()))
        .of("storage/crate_c.obj"),
    fault("lines beside the faces", "IMP010", |w, _| obj(w, "storage/crate_c", "l 1 2\n")).of("storage/crate_c.obj"),
    fault("a sidecar without its model", "IMP011", |w, _| w.put("models/storage/create_b.physics.yaml", "mass: 9 kg\n")),
    asset("a mass spread by hull where none is known", "GEO001", |asset| {
        asset.measures.closed = false;
        asset.measures.solid_method = Some(VolumeMethod::Hull);
    })
    .of(ANVIL),
];

/// Leaves two sides that meet: what an angle holds is next to nothing.
fn two_sides(mesh: &mut Mesh) {
    mesh.triangles = [&mesh.triangles[0..2], &mesh.triangles[4..6]].concat();
}

/// A surface where a solid shape should be.
fn bare_surface(asset: &mut importer::Asset) {
    let mesh = cuboid([0.2, 0.15, 0.2]);
    for candidate in &mut asset.ladder {
        candidate.shapes = vec![Shape::TriangleMesh {
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
        }];
    }
}

fn errors(asset: &mut importer::Asset, change: impl Fn(&mut importer::collider::ColliderError)) {
    asset.ladder.iter_mut().for_each(|candidate| change(&mut candidate.error));
}

fn bounds(world: &mut World, bound: &str) {
    let text = format!("{}bounds: {{ {bound} }}\n", world.text("physique.yaml"));
    world.put("physique.yaml", &text);
}

/// A box of the size of a crate as OBJ, with more lines at its end.
fn obj(world: &mut World, model: &str, more: &str) {
    let mesh = cuboid([0.2, 0.16, 0.21]);
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        text.push_str(&format!("v {x} {y} {z}\n"));
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| corner + 1);
        text.push_str(&format!("f {a} {b} {c}\n"));
    }
    world.put_model(&format!("{model}.obj"), (text + more).into_bytes());
}

fn stl(world: &mut World, model: &str) {
    let mesh = cuboid([0.2, 0.16, 0.21]);
    let mut text = "solid crate\n".to_owned();
    for triangle in &mesh.triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for corner in triangle {
            let [x, y, z] = mesh.positions[*corner as usize];
            text.push_str(&format!("vertex {x} {y} {z}\n"));
        }
        text.push_str("endloop\nendfacet\n");
    }
    world.put_model(model, (text + "endsolid crate\n").into_bytes());
}
