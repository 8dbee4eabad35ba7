#!/usr/bin/env python3
"""How good the colliders are by a ruler that knows nothing of Physique.

    physique report --colliders MODELS --tolerance 0.01 --piles 0 --out OUT
    python scripts/collider_quality.py RULER MODELS OUT

RULER is a folder with a module `ruler` whose `Reference(mesh).measure(pieces)` gives a dict of figures for pieces as
lists of points; it and its packages (trimesh among them) must be importable. Prints a line a model and tool, and the
medians of each tool.
"""

import json
import statistics
import sys
from multiprocessing import Pool
from pathlib import Path


def measure(job):
    tool, mesh_path, pieces_path = job
    import trimesh
    from ruler import Reference

    loaded = trimesh.load(mesh_path)
    mesh = loaded.to_geometry() if isinstance(loaded, trimesh.Scene) else loaded
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    return tool, mesh_path.name, Reference(mesh).measure(json.loads(pieces_path.read_text()))


def jobs(models, out):
    for pieces in sorted((out / "pieces").glob("*.json")):
        name = pieces.name.removesuffix(".json")
        tool = "parry" if name.endswith(".parry") else "physique"
        mesh = models / name.removesuffix(".parry").replace("__", "/")
        if mesh.is_file():
            yield tool, mesh, pieces


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    ruler, models, out = map(Path, sys.argv[1:])
    sys.path.insert(0, str(ruler))
    with Pool() as pool:
        rows = pool.map(measure, jobs(models, out), chunksize=1)
    keys = sorted({key for _, _, row in rows for key, value in row.items() if isinstance(value, (int, float))})
    print("tool", "model", *keys, sep="\t")
    for tool, name, row in rows:
        print(tool, name, *(f"{row[key]:.3f}" if row.get(key) is not None else "-" for key in keys), sep="\t")
    for tool in sorted({tool for tool, _, _ in rows}):
        values = {key: [row[key] for t, _, row in rows if t == tool and row.get(key) is not None] for key in keys}
        print(tool, "median", *(f"{statistics.median(v):.3f}" if v else "-" for v in values.values()), sep="\t")


if __name__ == "__main__":
    main()
