//! The errors of every crate as the rows of one table.

use importer::{CatalogueError, Failure};
use mapper::MapError;
use mapper::scene::SceneError as PlacingError;

/// A mapping, override or scene file that is wrong.
#[must_use]
pub fn of_map(error: &MapError) -> Failure {
    let way_out = Some(error.way_out()).filter(|way_out| !way_out.is_empty());
    Failure {
        code: error.code().to_owned(),
        place: error.place(),
        reason: error.reason(),
        way_out: way_out.unwrap_or_else(|| {
            "Correct the place or take it out; `physique schema overrides` makes an editor point at it"
                .to_owned()
        }),
    }
}

/// A model that cannot be made a body.
#[must_use]
pub fn of_placing(error: &PlacingError) -> Failure {
    // The row names the model already.
    let model = error.place();
    let reason = error.reason();
    let reason = reason.strip_prefix(&model).and_then(|rest| rest.strip_prefix(": ")).unwrap_or(&reason);
    Failure {
        code: error.code().to_owned(),
        place: String::new(),
        reason: reason.to_owned(),
        way_out: error.way_out(),
    }
}

/// A scene that the solver refuses. Its sentence holds the way out.
#[must_use]
pub fn of_scene(error: &sim::SceneError) -> Failure {
    Failure {
        code: "scene-refused".to_owned(),
        place: String::new(),
        reason: error.to_string(),
        way_out: "Correct the value in an override file, or leave the model out".to_owned(),
    }
}

pub(crate) fn of_catalogue(error: &CatalogueError) -> Failure {
    Failure {
        code: "catalogue".to_owned(),
        place: String::new(),
        reason: error.to_string(),
        way_out: "Delete the catalogue: it is derived from the models and is made again".to_owned(),
    }
}

/// A panic in a stage, which is a failure of one model and of no other.
pub(super) fn of_panic(stage: &str, panic: &str) -> Failure {
    Failure {
        code: "panic".to_owned(),
        place: stage.to_owned(),
        reason: format!("the stage panicked: {panic}"),
        way_out: "Please report it with the model; the other models are not affected".to_owned(),
    }
}

/// The importer says that a model is in the catalogue, and it is not.
pub(crate) fn missing_asset() -> Failure {
    Failure {
        code: "catalogue".to_owned(),
        place: String::new(),
        reason: "the model's asset is not in the catalogue".to_owned(),
        way_out: "Delete the catalogue: it is derived from the models and is made again".to_owned(),
    }
}
