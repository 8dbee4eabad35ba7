-- The catalogue: everything derived from a folder of models. Deletable: a run makes it again.
--
-- Version 1. A change here needs a step in migrate.rs that brings the previous version to this shape, and a
-- raised VERSION there. Lengths are in file units unless a column says metres; keys are 32 bytes of blake3.

-- Facts about the file itself: `tool`, `made_by`.
CREATE TABLE meta (
    name  TEXT PRIMARY KEY NOT NULL,
    value TEXT NOT NULL
) STRICT, WITHOUT ROWID;

-- One model file's content. Many models may hold the same one.
-- The columns are for queries; `facts` is what the asset is rebuilt from (JSON, without parts and shapes).
CREATE TABLE asset (
    key             BLOB PRIMARY KEY NOT NULL CHECK (length(key) = 32),
    options         TEXT NOT NULL,    -- fingerprint of options and algorithm version it was made under
    format          TEXT NOT NULL,    -- glb, gltf, obj, stl, ply
    metres_per_unit REAL NOT NULL,
    unit_stated     INTEGER NOT NULL CHECK (unit_stated IN (0, 1)),
    up              TEXT NOT NULL,    -- x, y, z
    up_stated       INTEGER NOT NULL CHECK (up_stated IN (0, 1)),
    triangles       INTEGER NOT NULL,
    vertices_welded INTEGER NOT NULL,
    closed          INTEGER NOT NULL CHECK (closed IN (0, 1)),
    wound           INTEGER NOT NULL CHECK (wound IN (0, 1)),
    bodies          INTEGER NOT NULL,
    volume          REAL,             -- NULL where nothing is enclosed
    volume_method   TEXT,             -- closed, oriented, hull
    area            REAL NOT NULL,
    size_x          REAL NOT NULL,
    size_y          REAL NOT NULL,
    size_z          REAL NOT NULL,
    parts           INTEGER NOT NULL,
    notes           INTEGER NOT NULL, -- how many; the notes are in `facts`
    facts           TEXT NOT NULL
) STRICT;

-- A mesh piece of an asset. `facts` is the part without its colliders (JSON).
CREATE TABLE part (
    asset     BLOB NOT NULL REFERENCES asset (key) ON DELETE CASCADE,
    part      INTEGER NOT NULL CHECK (part >= 0),
    name      TEXT NOT NULL,
    triangles INTEGER NOT NULL,
    closed    INTEGER NOT NULL CHECK (closed IN (0, 1)),
    volume    REAL,
    facts     TEXT NOT NULL,
    PRIMARY KEY (asset, part)
) STRICT;

-- A rung of a ladder of colliders. Errors are shares of the mesh's diagonal.
-- `shapes` is a JSON array that SQL can read: primitives whole, hulls and triangle meshes as counts, their
-- numbers following one another in `geometry` (f64 and u32, little-endian). That keeps every bit, takes a
-- third of the text's room, and is not parsed by who only wants the errors.
CREATE TABLE collider (
    asset         BLOB NOT NULL REFERENCES asset (key) ON DELETE CASCADE,
    part          INTEGER NOT NULL CHECK (part >= -1), -- -1: the whole asset
    step          INTEGER NOT NULL CHECK (step >= 0),  -- 0 is the cheapest
    rung          TEXT NOT NULL,
    surface_max   REAL,
    surface_p95   REAL,
    growth_max    REAL,
    outside_share REAL,
    volume_ratio  REAL,
    pieces        INTEGER NOT NULL,
    vertices      INTEGER NOT NULL,
    cost          REAL,
    facts         TEXT NOT NULL, -- the candidate without its shapes (JSON)
    shapes        TEXT NOT NULL,
    geometry      BLOB NOT NULL,
    PRIMARY KEY (asset, part, step)
) STRICT;

-- A path in the database. Which of three states it is in:
--   asset set                          imported
--   asset NULL, a row in `failure`     refused, and not tried again while nothing changes
--   asset NULL, no failure             to do
CREATE TABLE model (
    model       TEXT PRIMARY KEY NOT NULL, -- relative to `root`, '/' between folders
    root        TEXT NOT NULL,
    bytes       INTEGER NOT NULL,
    modified_ns INTEGER,                   -- since 1970; NULL: do not trust the stamp, hash the file again
    content     BLOB CHECK (length(content) = 32), -- key of the bytes even where they were refused
    options     TEXT NOT NULL,             -- fingerprint under which it was last tried
    asset       BLOB REFERENCES asset (key)
) STRICT;
CREATE INDEX model_by_asset ON model (asset);
CREATE INDEX model_by_root ON model (root);

-- A file that a model refers to (a glTF's buffers), with its stamp: a change in it changes the asset.
CREATE TABLE dependency (
    model       TEXT NOT NULL REFERENCES model (model) ON DELETE CASCADE,
    path        TEXT NOT NULL,             -- relative to the model's folder, '/' between folders
    bytes       INTEGER NOT NULL,
    modified_ns INTEGER,
    PRIMARY KEY (model, path)
) STRICT, WITHOUT ROWID;

-- What could not be done, by whom: `import` or the name of a later stage. A scene may stand for a model.
CREATE TABLE failure (
    model   TEXT NOT NULL,
    stage   TEXT NOT NULL,
    code    TEXT NOT NULL, -- stable, kebab-case
    place   TEXT NOT NULL, -- inside the file; empty for the whole
    reason  TEXT NOT NULL,
    way_out TEXT NOT NULL,
    PRIMARY KEY (model, stage)
) STRICT, WITHOUT ROWID;
CREATE INDEX failure_by_code ON failure (stage, code);

-- Results of later stages. The catalogue keeps them and does not know what they mean: a stage that finds its
-- `input_key` unchanged need not run again.
CREATE TABLE stage (
    model     TEXT NOT NULL,
    stage     TEXT NOT NULL,
    input_key TEXT NOT NULL,
    status    TEXT NOT NULL,
    result    TEXT NOT NULL, -- JSON
    PRIMARY KEY (model, stage)
) STRICT;
CREATE INDEX stage_by_stage ON stage (stage, model);

-- A model that is gone takes its failures and results with it.
CREATE TRIGGER model_gone AFTER DELETE ON model BEGIN
    DELETE FROM failure WHERE model = OLD.model;
    DELETE FROM stage WHERE model = OLD.model;
END;
