//! A stage of one model: done again only when its input changed, its failures kept as rows.

use importer::catalogue::{Catalogue, CatalogueError, Failure, FailureRow, StageRow};
use serde::Serialize;
use serde::de::DeserializeOwned;

use importer::catch_panic;

use super::failure;

const DONE: &str = "done";
const FAILED: &str = "failed";

/// The stored result if its input was the same, else what `work` makes of the model, which is then stored. A
/// panic in `work` is a failure of this model and of no other.
///
/// # Errors
/// The catalogue cannot be read or written.
pub(crate) fn staged<T: Serialize + DeserializeOwned>(
    catalogue: &Catalogue,
    model: &str,
    stage: &str,
    input_key: &str,
    work: impl FnOnce() -> Result<T, Failure>,
) -> Result<Result<T, Failure>, CatalogueError> {
    let stored = catalogue.stage(model, stage)?;
    if let Some(result) = stored.as_ref().filter(|row| row.input_key == input_key).and_then(read) {
        return Ok(result);
    }
    let result = catch_panic(work).unwrap_or_else(|panic| Err(failure::of_panic(stage, &panic)));
    let encoded = match &result {
        Ok(value) => serde_json::to_string(value),
        Err(failure) => serde_json::to_string(failure),
    };
    let result = match (encoded, result) {
        (Ok(text), result) => {
            let status = if result.is_ok() { DONE } else { FAILED };
            catalogue.put_stage(StageRow {
                model: model.to_owned(),
                stage: stage.to_owned(),
                input_key: input_key.to_owned(),
                status: status.to_owned(),
                result: text,
            })?;
            result
        }
        (Err(error), _) => Err(Failure {
            code: "unstorable".to_owned(),
            place: stage.to_owned(),
            reason: format!("the result cannot be stored: {error}"),
            way_out: "Please report it with the model".to_owned(),
        }),
    };
    match &result {
        Err(failure) => catalogue.put_failure(FailureRow {
            model: model.to_owned(),
            stage: stage.to_owned(),
            failure: failure.clone(),
        })?,
        Ok(_) if stored.is_some_and(|row| row.status == FAILED) => catalogue.clear_failure(model, stage)?,
        Ok(_) => {}
    }
    Ok(result)
}

/// A stored result that can be understood; one that cannot is made again.
pub(super) fn read<T: DeserializeOwned>(row: &StageRow) -> Option<Result<T, Failure>> {
    match row.status.as_str() {
        DONE => serde_json::from_str(&row.result).ok().map(Ok),
        FAILED => serde_json::from_str(&row.result).ok().map(Err),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure() -> Failure {
        Failure {
            code: "no-mass".to_owned(),
            place: String::new(),
            reason: "it weighs nothing".to_owned(),
            way_out: "give it a density".to_owned(),
        }
    }

    #[test]
    fn work_is_done_once_for_an_input_and_again_for_another() {
        let catalogue = Catalogue::open_in_memory().expect("opened");
        let mut calls = 0;
        let mut run = |key: &str| {
            let staged = staged(&catalogue, "a.glb", "map", key, || {
                calls += 1;
                Ok(calls)
            });
            catalogue.flush().expect("flushed");
            staged.expect("stored")
        };
        assert_eq!([run("one"), run("one"), run("two")], [Ok(1), Ok(1), Ok(2)]);
    }

    #[test]
    fn failures_and_panics_are_rows_until_the_work_succeeds() {
        let catalogue = Catalogue::open_in_memory().expect("opened");
        let rows = |catalogue: &Catalogue| {
            catalogue.flush().expect("flushed");
            catalogue.failures().expect("read").into_iter().map(|row| row.failure.code).collect::<Vec<_>>()
        };
        let run = |key: &str, work: fn() -> Result<u32, Failure>| {
            let staged = staged(&catalogue, "a.glb", "map", key, work);
            (staged.map(|result| result.is_ok()), rows(&catalogue))
        };
        assert_eq!(run("one", || Err(failure())), (Ok(false), vec!["no-mass".to_owned()]));
        assert_eq!(
            run("one", || Ok(1)),
            (Ok(false), vec!["no-mass".to_owned()]),
            "the failure is remembered"
        );
        assert_eq!(run("two", || panic!("out of cheese")), (Ok(false), vec!["panic".to_owned()]));
        assert_eq!(run("three", || Ok(1)), (Ok(true), Vec::new()));
    }
}
