#!/usr/bin/env python3
"""How long `physique diff` takes to say what a change of two presets does to many models, and what it says.

    diff_speed.py BINARY [--models 10000] [--folder FOLDER]

Makes boxes of random sizes, named as things in a database are, imports and maps them once (minutes), and compares the
catalogue of rules with one in which ceramic is lighter and oak slides less. Python's standard library only.
"""

import argparse
import pathlib
import random
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MATERIALS = ["", "", "", "oak", "steel", "plastic", "ceramic", "pine", "glass"]
# Things by folder, each with its longest side in metres.
THINGS = {
    "kitchen": {"mug": 0.1, "plate": 0.25, "bowl": 0.2, "pan": 0.3, "kettle": 0.25, "fork": 0.2, "knife": 0.25},
    "furniture": {"chair": 0.9, "table": 1.4, "sofa": 2.0, "bookcase": 1.8, "stool": 0.5, "bed": 2.0, "desk": 1.4},
    "storage": {"crate": 0.5, "barrel": 0.9, "box": 0.4, "pallet": 1.2, "bucket": 0.3, "basket": 0.4},
    "tools": {"hammer": 0.3, "wrench": 0.25, "saw": 0.5, "drill": 0.25, "ladder": 2.5, "shovel": 1.2},
    "toys": {"ball": 0.22, "teddy": 0.3, "dice": 0.02, "puzzle": 0.3},
    "food": {"apple": 0.08, "banana": 0.18, "bread": 0.3, "cheese": 0.15, "lemon": 0.08, "melon": 0.3},
    "nature": {"rock": 0.5, "log": 1.0, "stump": 0.5},
    "office": {"book": 0.25, "pen": 0.14, "laptop": 0.35, "lamp": 0.5, "monitor": 0.6, "keyboard": 0.45},
}
QUADS = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]


def models(folder, count):
    chance = random.Random(3)
    things = [(place, name, side) for place, names in THINGS.items() for name, side in names.items()]
    for index in range(count):
        place, name, side = things[index % len(things)]
        x = side * chance.uniform(0.9, 1.1)
        half = [0.5 * x, 0.5 * x * chance.uniform(0.4, 1), 0.5 * x * chance.uniform(0.3, 0.9)]
        signs = [(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
        lines = ["v " + " ".join(f"{sign * side:.6f}" for sign, side in zip(corner, half)) for corner in signs]
        lines += [f"f {quad}" for quad in QUADS]
        words = [word for word in (chance.choice(MATERIALS), name, f"{index:05}") if word]
        file = folder / place / name / ("_".join(words) + ".obj")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("\n".join(lines) + "\n")


def changed(text, preset, attribute, old, new):
    """One figure of one preset."""
    lines = text.split("\n")
    at = lines.index(f"  {preset}:")
    at += next(after for after, line in enumerate(lines[at:]) if line.strip().startswith(f"{attribute}:"))
    assert old in lines[at], lines[at]
    lines[at] = lines[at].replace(old, new)
    return "\n".join(lines)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("binary", type=pathlib.Path)
    arguments.add_argument("--models", type=int, default=10_000)
    arguments.add_argument("--folder", type=pathlib.Path, help="kept, and used again")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = given.folder or pathlib.Path(name)
        binary = given.binary.resolve()
        if not (folder / "models").is_dir():
            models(folder / "models", given.models)
        subprocess.run([binary, "lock", "models", "--db", "models.db", "--quiet"], cwd=folder, check=True)
        text = (ROOT / "catalog.yaml").read_text()
        (folder / "before.yaml").write_text(text)
        text = changed(text, "ceramic", "density", "2300", "2180")
        text = changed(text, "oak", "friction_dynamic", "0.32", "0.40")
        (folder / "after.yaml").write_text(text)
        times = []
        for _ in range(5):
            begun = time.perf_counter()
            command = [binary, "diff", "before.yaml", "after.yaml", "--db", "models.db", "--quiet"]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            times.append(time.perf_counter() - begun)
            assert done.returncode == 1, done.stderr
        print(done.stdout)
        print("seconds: " + ", ".join(f"{seconds:.2f}" for seconds in times))


if __name__ == "__main__":
    main()
