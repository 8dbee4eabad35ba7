-- From version 1: how a volume is known, and notes and bodies in tables of their own. Assets of version 1 were made
-- by an older algorithm: the next import makes them again and fills these.
ALTER TABLE asset ADD COLUMN geometry TEXT NOT NULL DEFAULT 'mesh';
ALTER TABLE asset ADD COLUMN volume_error REAL;
ALTER TABLE asset ADD COLUMN volume_confidence REAL;
CREATE TABLE note (
    asset   BLOB NOT NULL REFERENCES asset (key) ON DELETE CASCADE,
    note    INTEGER NOT NULL CHECK (note >= 0),
    code    TEXT NOT NULL, -- stable, kebab-case: unit-assumed, holes-filled, skin-ignored, ...
    place   TEXT NOT NULL, -- inside the file; empty for the whole
    message TEXT NOT NULL,
    PRIMARY KEY (asset, note)
) STRICT, WITHOUT ROWID;
CREATE INDEX note_by_code ON note (code);
CREATE TABLE body (
    asset      BLOB NOT NULL REFERENCES asset (key) ON DELETE CASCADE,
    body       INTEGER NOT NULL CHECK (body >= 0),
    role       TEXT NOT NULL, -- outer, cavity, inner, open, sheet
    triangles  INTEGER NOT NULL,
    volume     REAL NOT NULL, -- a cavity's is what it takes away
    method     TEXT,          -- as of an asset; NULL for a sheet
    error      REAL NOT NULL, -- half the width of the bound, as a share of `volume`
    confidence REAL NOT NULL,
    PRIMARY KEY (asset, body)
) STRICT, WITHOUT ROWID;
