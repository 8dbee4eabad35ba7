//! A folder of models into the catalogue: only what changed, whatever happens on the way.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, SystemTime};

use importer::catalogue::FailureRow;
use importer::{
    Asset, Catalogue, CatalogueError, ModelRow, Options, Outcome, Progress, Shard, StageRow, import_folder,
    import_shard,
};
use tempfile::{TempDir, tempdir};

/// Small ladders: the batch is on trial, not the colliders.
fn quick() -> Options {
    Options { max_decomposition_triangles: 0, error_samples: 50, ..Options::default() }
}

/// Counts outcomes by model.
#[derive(Default)]
struct Tally {
    total: AtomicUsize,
    outcomes: Mutex<BTreeMap<String, Outcome>>,
}

impl Progress for Tally {
    fn total(&self, models: usize) {
        self.total.store(models, Ordering::SeqCst);
    }

    fn done(&self, model: &str, outcome: Outcome) {
        let before = self.outcomes.lock().unwrap().insert(model.to_owned(), outcome);
        assert_eq!(before, None, "{model} was done twice");
    }
}

impl Tally {
    /// Imported, cached, failed.
    fn counts(&self) -> [usize; 3] {
        let outcomes = self.outcomes.lock().unwrap();
        [Outcome::Imported, Outcome::Cached, Outcome::Failed]
            .map(|wanted| outcomes.values().filter(|outcome| **outcome == wanted).count())
    }
}

/// A folder of models and a catalogue beside it.
struct Database {
    folder: TempDir,
}

impl Database {
    fn new() -> Self {
        let folder = tempdir().unwrap();
        fs::create_dir(folder.path().join("models")).unwrap();
        Self { folder }
    }

    fn models(&self) -> PathBuf {
        self.folder.path().join("models")
    }

    fn catalogue_path(&self) -> PathBuf {
        self.folder.path().join("catalogue.sqlite")
    }

    /// Writes a file that has lain there for a while: `age` tells one writing from the next.
    fn put(&self, name: &str, bytes: impl AsRef<[u8]>, age: u64) {
        let path = self.models().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, bytes).unwrap();
        let then = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000 - age);
        File::options().write(true).open(&path).unwrap().set_modified(then).unwrap();
    }

    fn import(&self, options: &Options) -> (Vec<ModelRow>, [usize; 3]) {
        let catalogue = Catalogue::open(&self.catalogue_path()).unwrap();
        self.import_into(&catalogue, options, 3)
    }

    fn import_into(
        &self,
        catalogue: &Catalogue,
        options: &Options,
        threads: usize,
    ) -> (Vec<ModelRow>, [usize; 3]) {
        let tally = Tally::default();
        let rows =
            import_folder(&self.models(), catalogue, options, threads, &tally, &AtomicBool::new(false))
                .unwrap();
        assert_eq!(tally.total.load(Ordering::SeqCst), rows.len());
        assert_eq!(catalogue.models().unwrap(), rows);
        assert_eq!(catalogue.check().unwrap(), Vec::<String>::new());
        (rows, tally.counts())
    }
}

fn tetrahedron(size: f64) -> String {
    let [a, b, c, d] = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
    let faces = [[a, c, b], [a, b, d], [a, d, c], [b, c, d]];
    let mut text = "solid t\n".to_owned();
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face {
            text += &format!("vertex {x:.6} {y:.6} {z:.6}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid t\n"
}

/// A triangle whose corners lie in `buffer`.
fn gltf(buffer: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"uri":"{buffer}","byteLength":36}}]}}"#
    )
}

fn corners(size: f32) -> Vec<u8> {
    [0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size, 0.0].iter().flat_map(|x: &f32| x.to_le_bytes()).collect()
}

/// A dozen sound models and some that are not.
fn mixed() -> Database {
    let database = Database::new();
    for index in 1..=12_u32 {
        database.put(&format!("{}/t{index}.stl", index % 3), tetrahedron(f64::from(index)), 0);
    }
    database.put("bad/garbage.stl", "solid x\nfacet normal 0 0 0\nouter", 0);
    database.put("bad/empty.obj", "", 0);
    database.put("bad/cut.glb", b"glTF\x02\0\0\0\x60\0\0\0", 0);
    database.put("readme.txt", "not a model", 0);
    database
}

/// Everything a catalogue says.
#[derive(Debug, PartialEq)]
struct Dump {
    models: Vec<ModelRow>,
    assets: Vec<Option<Asset>>,
    failures: Vec<FailureRow>,
    stages: Vec<StageRow>,
}

fn dump(catalogue: &Catalogue) -> Dump {
    assert_eq!(catalogue.check().unwrap(), Vec::<String>::new());
    let models = catalogue.models().unwrap();
    let assets = models.iter().filter_map(|row| row.key).map(|key| catalogue.asset(&key).unwrap()).collect();
    Dump { models, assets, failures: catalogue.failures().unwrap(), stages: catalogue.stages("map").unwrap() }
}

#[test]
fn a_second_run_opens_no_file() {
    let database = mixed();
    let (first, counts) = database.import(&quick());
    assert_eq!(counts, [12, 0, 3]);
    assert!(first.is_sorted_by(|a, b| a.model < b.model));
    let names: Vec<&str> = first.iter().map(|row| row.model.as_str()).collect();
    assert!(names.contains(&"0/t12.stl") && names.contains(&"bad/cut.glb"), "{names:?}");
    assert_eq!(first[0].path(), database.models().canonicalize().unwrap().join("0/t12.stl"));

    // Other bytes under the same stamp: who opened the files would notice.
    database.put("1/t1.stl", tetrahedron(2.0), 0);
    database.put("bad/empty.obj", "", 0);
    let (second, counts) = database.import(&quick());
    assert_eq!(counts, [0, 15, 0]);
    assert_eq!(second, first);
}

#[test]
fn only_what_changed_is_imported_again() {
    let database = mixed();
    let (first, _) = database.import(&quick());
    database.put("1/t1.stl", tetrahedron(77.0), 5);
    database.put("bad/empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 5);
    database.put("new.stl", tetrahedron(78.0), 5);
    database.put("2/t2.stl", tetrahedron(2.0), 5); // touched only
    let (second, counts) = database.import(&quick());
    assert_eq!(counts, [3, 13, 0]);
    let row = |rows: &[ModelRow], model: &str| rows.iter().find(|row| row.model == model).unwrap().clone();
    assert_ne!(row(&first, "1/t1.stl").key, row(&second, "1/t1.stl").key);
    assert_eq!(row(&first, "2/t2.stl"), row(&second, "2/t2.stl"));
    assert!(row(&first, "bad/empty.obj").failure.is_some());
    assert_eq!(row(&second, "bad/empty.obj").failure, None);
    assert_eq!(Catalogue::open(&database.catalogue_path()).unwrap().summary().unwrap().assets, 14);
    let (_, counts) = database.import(&quick());
    assert_eq!(counts, [0, 16, 0]);
}

#[test]
fn a_file_written_just_now_is_compared_by_content() {
    let database = Database::new();
    let path = database.models().join("a.stl");
    fs::write(&path, tetrahedron(1.0)).unwrap();
    let (first, counts) = database.import(&quick());
    assert_eq!(counts, [1, 0, 0]);
    let (_, counts) = database.import(&quick());
    assert_eq!(counts, [0, 1, 0]);
    fs::write(&path, tetrahedron(2.0)).unwrap();
    let (second, counts) = database.import(&quick());
    assert_eq!(counts, [1, 0, 0]);
    assert_ne!(first[0].key, second[0].key);
}

#[test]
fn other_options_do_everything_anew_and_refusals_too() {
    let database = mixed();
    database.import(&quick());
    let other = Options { hull_vertices: 32, ..quick() };
    let (_, counts) = database.import(&other);
    assert_eq!(counts, [12, 0, 3]);
    let (_, counts) = database.import(&other);
    assert_eq!(counts, [0, 15, 0]);
}

#[test]
fn deleted_models_are_forgotten_and_moved_ones_keep_their_asset() {
    let database = mixed();
    let catalogue = Catalogue::open(&database.catalogue_path()).unwrap();
    database.import_into(&catalogue, &quick(), 2);
    for model in ["1/t1.stl", "bad/cut.glb", "2/t2.stl"] {
        let (model, stage) = (model.to_owned(), "map".to_owned());
        let row =
            StageRow { model, stage, input_key: String::new(), status: String::new(), result: String::new() };
        catalogue.put_stage(row).unwrap();
    }
    fs::remove_file(database.models().join("1/t1.stl")).unwrap();
    fs::remove_file(database.models().join("bad/cut.glb")).unwrap();
    fs::rename(database.models().join("0/t3.stl"), database.models().join("moved.stl")).unwrap();
    let (rows, counts) = database.import_into(&catalogue, &quick(), 2);
    assert_eq!(counts, [0, 13, 0]);
    assert!(rows.iter().all(|row| !["1/t1.stl", "bad/cut.glb", "0/t3.stl"].contains(&row.model.as_str())));
    assert_eq!(catalogue.summary().unwrap().assets, 11);
    assert_eq!(catalogue.stages("map").unwrap().len(), 1);
    assert!(catalogue.failures().unwrap().iter().all(|row| row.model != "bad/cut.glb"));
}

#[test]
fn a_refusal_names_place_reason_and_way_out() {
    let database = mixed();
    let (rows, _) = database.import(&quick());
    let failures: Vec<_> = rows.iter().filter(|row| row.failure.is_some()).collect();
    assert_eq!(failures.len(), 3);
    for row in failures {
        assert_eq!(row.key, None);
        let failure = row.failure.clone().unwrap();
        assert!(!failure.code.is_empty() && !failure.reason.is_empty() && !failure.way_out.is_empty());
    }
}

#[test]
fn equal_bytes_are_measured_once() {
    let database = Database::new();
    for index in 0..20 {
        database.put(&format!("copy{index}.stl"), tetrahedron(3.0), index);
        database.put(&format!("broken{index}.stl"), "solid", index);
    }
    let (rows, counts) = database.import(&quick());
    assert_eq!(counts, [1, 19, 20]);
    let keys: Vec<_> = rows.iter().filter_map(|row| row.key).collect();
    assert!(keys.len() == 20 && keys.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn a_change_in_a_buffer_file_is_a_change_of_the_model() {
    let database = Database::new();
    database.put("m.gltf", gltf("my%20data.bin"), 0);
    let (missing, counts) = database.import(&quick());
    assert_eq!(counts, [0, 0, 1]);
    assert_eq!(missing[0].failure.as_ref().unwrap().code, "missing-file");

    // The model's own stamp stays what it was in all that follows.
    database.put("my data.bin", corners(1.0), 0);
    let (first, counts) = database.import(&quick());
    assert_eq!(counts, [1, 0, 0]);
    let (_, counts) = database.import(&quick());
    assert_eq!(counts, [0, 1, 0]);
    database.put("my data.bin", corners(1.0), 9); // touched only
    let (same, counts) = database.import(&quick());
    assert_eq!((same, counts), (first.clone(), [0, 1, 0]));
    database.put("my data.bin", corners(2.0), 8);
    let (changed, counts) = database.import(&quick());
    assert_eq!(counts, [1, 0, 0]);
    assert_ne!(changed[0].key, first[0].key);
}

/// Sets the flag when a number of models are done.
struct StopAfter<'a>(AtomicUsize, &'a AtomicBool);

impl Progress for StopAfter<'_> {
    fn total(&self, _: usize) {}

    fn done(&self, _: &str, _: Outcome) {
        if self.0.fetch_sub(1, Ordering::SeqCst) == 1 {
            self.1.store(true, Ordering::SeqCst);
        }
    }
}

#[test]
fn a_stopped_batch_returns_what_is_done_and_the_next_does_the_rest() {
    let database = mixed();
    let catalogue = Catalogue::open(&database.catalogue_path()).unwrap();
    let stop = AtomicBool::new(false);
    let progress = StopAfter(AtomicUsize::new(5), &stop);
    let rows = import_folder(&database.models(), &catalogue, &quick(), 1, &progress, &stop).unwrap();
    assert_eq!(rows.len(), 5);
    assert_eq!(catalogue.models().unwrap(), rows);
    let (_, [imported, cached, failed]) = database.import_into(&catalogue, &quick(), 1);
    assert_eq!((imported + failed, cached), (10, 5));

    let stopped = AtomicBool::new(true);
    assert_eq!(import_folder(&database.models(), &catalogue, &quick(), 2, &(), &stopped), Ok(Vec::new()));
    assert_eq!(catalogue.models().unwrap().len(), 15, "a stopped batch forgets nothing");
}

#[test]
fn a_single_file_leaves_its_siblings_alone() {
    let database = mixed();
    let catalogue = Catalogue::open(&database.catalogue_path()).unwrap();
    let folder = database.models().join("1");
    let never = AtomicBool::new(false);
    import_folder(&folder, &catalogue, &quick(), 1, &(), &never).unwrap();
    let all = catalogue.models().unwrap();
    let rows = import_folder(&folder.join("t1.stl"), &catalogue, &quick(), 1, &(), &never).unwrap();
    assert_eq!(rows.iter().map(|row| row.model.as_str()).collect::<Vec<_>>(), ["t1.stl"]);
    assert_eq!(catalogue.models().unwrap(), all);

    let absent = import_folder(&folder.join("none.stl"), &catalogue, &quick(), 1, &(), &never);
    let Err(CatalogueError::Root { reason, .. }) = absent else { panic!("{absent:?}") };
    assert!(reason.contains("none.stl"), "{reason}");
}

#[test]
fn threads_change_nothing() {
    let database = mixed();
    database.put("twin.stl", tetrahedron(4.0), 0);
    let dumps: Vec<Dump> = [1, 2, 8, 0]
        .into_iter()
        .map(|threads| {
            let catalogue = Catalogue::open_in_memory().unwrap();
            database.import_into(&catalogue, &quick(), threads);
            dump(&catalogue)
        })
        .collect();
    assert_eq!(dumps[0].models.len(), 16);
    assert!(dumps.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn shards_merged_are_the_whole() {
    let database = mixed();
    database.put("twin.stl", tetrahedron(4.0), 0);
    let whole = Catalogue::open(&database.catalogue_path()).unwrap();
    database.import_into(&whole, &quick(), 2);
    let merged = Catalogue::open(&database.folder.path().join("merged.sqlite")).unwrap();
    let mut done = 0;
    for index in 0..3 {
        let path = database.folder.path().join(format!("shard{index}.sqlite"));
        let shard = Catalogue::open(&path).unwrap();
        let share = Shard::new(index, 3).unwrap();
        let never = AtomicBool::new(false);
        done += import_shard(&database.models(), &shard, &quick(), share, 2, &(), &never).unwrap().len();
        merged.merge_from(&path).unwrap();
    }
    assert_eq!(done, 16);
    assert_eq!(dump(&merged), dump(&whole));
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_not_utf8_is_a_row() {
    use std::os::unix::ffi::OsStrExt;
    let database = Database::new();
    let name = std::ffi::OsStr::from_bytes(b"caf\xE9.stl");
    fs::write(database.models().join(name), tetrahedron(1.0)).unwrap();
    database.put("good.stl", tetrahedron(2.0), 0);
    let (rows, counts) = database.import(&quick());
    assert_eq!(counts, [1, 0, 1]);
    assert_eq!(rows[0].failure.as_ref().unwrap().code, "path-not-utf8");
}

/// Set in a child process: the folder of the database it works on.
const CHILD: &str = "IMPORTER_TEST_CHILD";

/// Says each model that is safely on disk.
struct Speaking(Catalogue);

impl Progress for Speaking {
    fn total(&self, _: usize) {}

    fn done(&self, model: &str, outcome: Outcome) {
        println!("done {outcome:?} {model}");
    }
}

fn be_a_child(folder: &Path) {
    let catalogue = Catalogue::open(&folder.join("catalogue.sqlite")).unwrap();
    let progress = Speaking(catalogue.clone());
    import_folder(&folder.join("models"), &catalogue, &quick(), 2, &progress, &AtomicBool::new(false))
        .unwrap();
    drop(progress.0);
}

/// This test again, in a process of its own.
fn child(test: &str, folder: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture", "--test-threads=1"])
        .env(CHILD, folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn outcomes(child: &mut Child) -> impl Iterator<Item = String> + use<> {
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    // The harness's own words may stand before ours on the line.
    lines.map_while(Result::ok).filter_map(|line| line.split_once("done ").map(|(_, rest)| rest.to_owned()))
}

#[test]
fn killed_at_any_moment_it_resumes_to_the_same_catalogue() {
    if let Some(folder) = std::env::var_os(CHILD) {
        return be_a_child(Path::new(&folder));
    }
    let database = mixed();
    for index in 0..1_500_u32 {
        database.put(&format!("many/{index}.stl"), tetrahedron(100.0 + f64::from(index)), 0);
    }
    let calm = Catalogue::open_in_memory().unwrap();
    let (_, counts) = database.import_into(&calm, &quick(), 2);

    let mut cached = 0;
    for kill_after in [0, 1, 40, 333, 501, 760, 999, 1_200, 1_400, 1_510] {
        let mut child =
            child("killed_at_any_moment_it_resumes_to_the_same_catalogue", database.folder.path());
        let seen: Vec<String> = outcomes(&mut child).take(kill_after).collect();
        child.kill().unwrap();
        child.wait().unwrap();
        cached = seen.iter().filter(|line| line.starts_with("Cached")).count();
        let left = Catalogue::open(&database.catalogue_path()).unwrap();
        assert_eq!(left.check().unwrap(), Vec::<String>::new());
    }
    assert!(cached >= 500, "{cached}: the last one began where the ones before it were killed");

    let catalogue = Catalogue::open(&database.catalogue_path()).unwrap();
    let (_, [imported, cached, failed]) = database.import_into(&catalogue, &quick(), 2);
    assert_eq!(imported + cached + failed, counts.iter().sum::<usize>());
    assert_eq!(dump(&catalogue), dump(&calm));
}

#[test]
fn two_processes_on_one_catalogue_come_to_the_same() {
    if let Some(folder) = std::env::var_os(CHILD) {
        return be_a_child(Path::new(&folder));
    }
    let database = mixed();
    for index in 0..200_u32 {
        database.put(&format!("many/{index}.stl"), tetrahedron(100.0 + f64::from(index)), 0);
    }
    let calm = Catalogue::open_in_memory().unwrap();
    database.import_into(&calm, &quick(), 2);
    let name = "two_processes_on_one_catalogue_come_to_the_same";
    let mut children = [child(name, database.folder.path()), child(name, database.folder.path())];
    for child in &mut children {
        assert_eq!(outcomes(child).count(), 215);
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(dump(&Catalogue::open(&database.catalogue_path()).unwrap()), dump(&calm));
}

#[test]
fn a_model_that_a_dead_run_had_in_work_is_imported_in_a_process_of_its_own() {
    let folder = tempdir().unwrap();
    let models = folder.path().join("models");
    fs::create_dir(&models).unwrap();
    let stl = "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n";
    for name in ["good.stl", "kills.stl", "hangs.stl"] {
        fs::write(models.join(name), format!("{stl}{name}")).unwrap();
    }
    let db = folder.path().join("c.db");
    drop(Catalogue::open(&db).unwrap());
    let run = |script: &str, suspect: &str| {
        let work = folder.path().join("c.db-work");
        fs::create_dir_all(&work).unwrap();
        fs::write(work.join("1-1"), format!("+{suspect}\n")).unwrap();
        let alone = importer::Alone {
            program: "sh".into(),
            arguments: vec!["-c".to_owned(), script.to_owned()],
            seconds: 1,
            memory_bytes: 1 << 30,
        };
        let options = Options { alone: Some(alone), ..quick() };
        let catalogue = Catalogue::open(&db).unwrap();
        let rows = import_folder(&models, &catalogue, &options, 2, &(), &AtomicBool::new(false)).unwrap();
        let failed: Vec<(String, String)> =
            rows.into_iter().filter_map(|row| Some((row.model, row.failure?.code))).collect();
        assert!(!work.exists());
        failed
    };
    assert_eq!(run("kill -SEGV $$", "kills.stl"), [("kills.stl".to_owned(), "crashed".to_owned())]);
    fs::write(models.join("hangs.stl"), format!("{stl}again")).unwrap();
    let failed = run("sleep 100", "hangs.stl");
    assert!(failed.contains(&("hangs.stl".to_owned(), "runaway".to_owned())), "{failed:?}");
}
