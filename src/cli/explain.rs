//! `physique explain`: every value of a model with its reason.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Result;
use importer::Asset;
use importer::collider::{REACH, verdict};
use mapper::scene::{COLLIDER_TOLERANCE, collider, collider_tolerance};
use mapper::{Mapped, ModelFacts};
use serde_json::json;
use sim::{Entity, Motion};

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
        ladder(out, &asset, &mapped)?;
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

/// The colliders that could stand for the model, cheap to dear, which one does, and why not the others.
fn ladder(out: &mut dyn Write, asset: &Asset, mapped: &Mapped) -> io::Result<()> {
    let Some(chosen) = collider(asset, mapped) else { return Ok(()) };
    let tolerance = collider_tolerance(asset, mapped);
    writeln!(
        out,
        "\ncolliders, cheap to dear; errors in % of the diagonal, of mesh and of collider; * is used; \
         95 % within {:.1} %, all within {:.1} %",
        tolerance * 100.0,
        tolerance * REACH * 100.0
    )?;
    if let Some(said) = &mapped.collider_tolerance {
        writeln!(out, "    tolerance {} m, by {} at {}", said.metres, said.by.by, said.by.place())?;
        if tolerance < COLLIDER_TOLERANCE {
            let made_for = COLLIDER_TOLERANCE * 100.0;
            writeln!(out, "    decompositions are made for {made_for} %: a finer one is not among them")?;
        }
    }
    writeln!(
        out,
        "    {:14}{:>7}{:>8}{:>14}{:>14}{:>9}{:>8}  why",
        "shape", "pieces", "corners", "mesh 95/max", "grown 95/max", "outside", "cost"
    )?;
    for candidate in &asset.ladder {
        let error = &candidate.error;
        let mark = if std::ptr::eq(candidate, chosen) { '*' } else { ' ' };
        let pair = |a: f64, b: f64| format!("{:.2} / {:.2}", a * 100.0, b * 100.0);
        writeln!(
            out,
            "  {mark} {:14}{:>7}{:>8}{:>14}{:>14}{:>9.2}{:>8.1}  {}",
            candidate.rung.name(),
            candidate.shapes.len(),
            candidate.vertices,
            pair(error.surface_p95, error.surface_max),
            pair(error.growth_p95, error.growth_max),
            error.outside_share * 100.0,
            candidate.cost,
            verdict(candidate, chosen, tolerance),
        )?;
        if let Some(fallback) = &candidate.fallback {
            writeln!(out, "      {fallback}")?;
        }
    }
    Ok(())
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
