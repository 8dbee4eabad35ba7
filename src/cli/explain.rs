//! `physique explain`: every value of a model with its reason.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Result;
use importer::collider::{Candidate, Shape as FileShape};
use mapper::ModelFacts;
use serde_json::json;
use sim::{Entity, Motion, Shape};

use super::End;
use super::args::{ExplainArgs, Format, Global};
use super::one::{One, one};
use super::{job, output};

/// # Errors
/// The model is refused, or the rules are not right.
pub(super) fn explain(global: &Global, args: &ExplainArgs) -> Result<End> {
    let root = args.root.as_deref();
    let db = job::db(global);
    let overrides_from = root_of(root, &args.model);
    let (mapper, _, sets) = job::mapping(global, &args.mapping, &overrides_from)?;
    let One { model, asset, mapped } = one(&args.model, root, &db, &mapper, &sets)?;
    let entity = mapper::scene::drop_entity(&model, &asset, &mapped, mapper.rules());
    if global.format == Format::Json {
        output::json(
            &json!({ "model": model, "mapped": mapped, "measures": asset.measures, "notes": asset.notes }),
        )?;
        return Ok(End::Clean);
    }
    let text = mapper::explain(&model, &mapped, &ModelFacts::new(&model, &asset));
    output::result(|out| {
        writeln!(out, "{}", text.trim_end())?;
        ladder(out, &asset.ladder, entity.as_ref().ok())?;
        match &entity {
            Ok(entity) => mass(out, entity)?,
            Err(error) => writeln!(out, "\nno body: {}. {}", error.reason(), error.way_out())?,
        }
        for note in &asset.notes {
            let place = if note.place.is_empty() { String::new() } else { format!(" at {}", note.place) };
            writeln!(out, "note [{}]{place}: {}", note.code, note.message)?;
        }
        Ok(())
    })?;
    Ok(End::Clean)
}

/// Where project overrides of a model are looked for: the demo keeps its own at the root of its models; so may
/// anyone.
pub(super) fn root_of(root: Option<&Path>, model: &Path) -> PathBuf {
    match root {
        Some(root) => root.to_path_buf(),
        None => model.parent().and_then(Path::parent).unwrap_or(model).to_path_buf(),
    }
}

/// The colliders that could stand for the model, cheap to dear, and which one does.
fn ladder(out: &mut dyn Write, ladder: &[Candidate], entity: Option<&Entity>) -> io::Result<()> {
    if ladder.is_empty() {
        return Ok(());
    }
    writeln!(out, "\ncolliders, cheap to dear; errors in % of the diagonal; * is used")?;
    writeln!(
        out,
        "    {:14}{:>7}{:>10}{:>12}{:>12}{:>9}",
        "shape", "pieces", "corners", "worst", "95 % below", "cost"
    )?;
    for candidate in ladder {
        let mark = if entity.is_some_and(|entity| stands_for(candidate, entity)) { '*' } else { ' ' };
        let name = format!("{:?}", candidate.rung).to_lowercase();
        writeln!(
            out,
            "  {mark} {name:14}{:>7}{:>10}{:>12.2}{:>12.2}{:>9.1}",
            candidate.shapes.len(),
            candidate.vertices,
            candidate.error.surface_max * 100.0,
            candidate.error.surface_p95 * 100.0,
            candidate.cost
        )?;
        if let Some(fallback) = &candidate.fallback {
            writeln!(out, "      {fallback}")?;
        }
    }
    Ok(())
}

/// Whether the entity's shapes are this candidate's: the mapper picks a rung whole.
fn stands_for(candidate: &Candidate, entity: &Entity) -> bool {
    candidate.shapes.len() == entity.shapes.len()
        && candidate.shapes.iter().zip(&entity.shapes).all(|(shape, child)| match (shape, &child.shape) {
            (FileShape::Hull { points }, Shape::Hull { points: used }) => points.len() == used.len(),
            (FileShape::Sphere { .. }, Shape::Sphere { .. })
            | (FileShape::Box { .. }, Shape::Box { .. })
            | (FileShape::Capsule { .. }, Shape::Capsule { .. })
            | (FileShape::Cylinder { .. }, Shape::Cylinder { .. })
            | (FileShape::TriangleMesh { .. }, Shape::TriangleMesh { .. }) => true,
            _ => false,
        })
}

fn mass(out: &mut dyn Write, entity: &Entity) -> io::Result<()> {
    match entity.motion {
        Motion::Static => writeln!(out, "\nfixed in place: simulated as static"),
        Motion::Dynamic(mass) => {
            let [xx, yy, zz, xy, xz, yz] = mass.inertia_kg_m2;
            writeln!(out, "\nmass {:.6} kg, inertia about the centre of mass in kg m2:", mass.mass_kg)?;
            writeln!(out, "  xx {xx:.4e}  yy {yy:.4e}  zz {zz:.4e}  xy {xy:.4e}  xz {xz:.4e}  yz {yz:.4e}")
        }
    }
}
