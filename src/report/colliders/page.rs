//! The page of pictures: mesh and collider side by side, worst first.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};

use super::{Row, Tool, file_name};

/// Writes `colliders.html` into `folder`; pictures lie in its `pictures/`.
///
/// # Errors
/// The file cannot be written.
pub fn write_page(folder: &Path, rows: &[Row], tolerance: f64) -> Result<()> {
    let mut ours: Vec<&Row> = rows.iter().filter(|row| row.tool == Tool::Physique).collect();
    ours.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.model.cmp(&b.model)));
    let mut html = String::from(
        "<!doctype html><meta charset=\"utf-8\"><title>Colliders</title><style>\
         body{font:14px/1.4 system-ui,sans-serif;margin:2em;max-width:1100px}\
         figure{margin:0 0 1.5em;border-top:1px solid #ccc;padding-top:.7em}\
         img{max-width:100%}b.over{color:#b00}</style><h1>Colliders, worst first</h1>",
    );
    let _ = write!(
        html,
        "<p>Left the mesh, in the middle the collider with a colour a piece, right both: red is mesh that sticks \
         out. Errors in % of the diagonal, 95 % / farthest; 95 % may be off by {:.1} %.</p>",
        tolerance * 100.0
    );
    for row in ours {
        let e = &row.error;
        let class = if row.excess > 1.0 { " class=\"over\"" } else { "" };
        let parry = rows.iter().find(|other| other.tool == Tool::Parry && other.model == row.model);
        let beside = parry.map_or_else(String::new, |p| {
            format!(
                " (parry: {} pieces, {} corners, mesh {:.2} / {:.2}, grown {:.2} / {:.2})",
                p.pieces,
                p.vertices,
                p.error.surface_p95 * 100.0,
                p.error.surface_max * 100.0,
                p.error.growth_p95 * 100.0,
                p.error.growth_max * 100.0
            )
        });
        let _ = write!(
            html,
            "<figure><b{class}>{}</b>: {}, {} pieces, {} corners, mesh {:.2} / {:.2}, grown {:.2} / {:.2}, outside \
             {:.2} %, {:.2} s{}{}<br><img loading=\"lazy\" src=\"pictures/{}\"></figure>",
            escaped(&row.model),
            row.shape,
            row.pieces,
            row.vertices,
            e.surface_p95 * 100.0,
            e.surface_max * 100.0,
            e.growth_p95 * 100.0,
            e.growth_max * 100.0,
            e.outside_share * 100.0,
            row.seconds,
            beside,
            row.note.as_ref().map_or_else(String::new, |note| format!("; {}", escaped(note))),
            escaped(&file_name(&row.model, "png")).replace('%', "%25").replace('#', "%23"),
        );
    }
    let file = folder.join("colliders.html");
    std::fs::write(&file, html).with_context(|| format!("cannot write {}", file.display()))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
