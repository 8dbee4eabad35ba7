#!/usr/bin/env python3
"""Measures the mapper on labelled tables and writes docs/mapping-accuracy.md.

  scripts/mapping_accuracy.py [ATTRIBUTES] [--split dev] [--physique target/release/physique] [--out FILE]

ATTRIBUTES   folder with dev/, taxonomy/ and tools/score.py [default: ../shared/attributes beside the project]

Runs `physique map --table` on records.csv and kind_names.csv, lets tools/score.py judge, and adds what that leaves
out: units. A row is put into a wrong unit on purpose (its size times 1000, 100 or 39.37) or left as it is; found
means that `unit` names the unit that undoes it. Standard library only.
"""

import argparse
import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
UNITS = {"mm": 1000.0, "cm": 100.0, "in": 39.37}


def mapped(physique, table, out):
    start = time.monotonic()
    subprocess.run([physique, "map", "--table", str(table), "--out", str(out)], check=True)
    seconds = time.monotonic() - start
    with open(out, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file)), seconds


def injected(physique, records, folder):
    """Precision and recall of units: every third row of trusted size is written in a wrong unit."""
    rows, truth = [], {}
    trusted = [r for r in records if r["dim_x"] and r["dim_y"] and r["dim_z"] and r["scale_suspect"] != "1"]
    for index, row in enumerate(trusted):
        unit = list(UNITS)[index // 3 % 3] if index % 3 == 0 else "m"
        factor = UNITS.get(unit, 1.0)
        truth[row["id"]] = unit
        sides = {key: float(row[key]) * factor for key in ("dim_x", "dim_y", "dim_z")}
        rows.append({key: row[key] for key in ("id", "path", "name", "text")} | sides)
    table = folder / "units.csv"
    with open(table, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    answers, _ = mapped(physique, table, folder / "units-out.csv")
    wrong = [a for a in answers if truth[a["id"]] != "m"]
    claimed = [a for a in answers if a["unit"] in ("mm", "cm", "in", "ft")]
    named = sum(a["unit"] == truth[a["id"]] for a in wrong)
    found = sum(truth[a["id"]] != "m" for a in claimed)
    known = [a for a in wrong if a["category"]]
    known_found = sum(a["unit"] in UNITS for a in known)
    return [
        f"rows {len(rows)}, in a wrong unit {len(wrong)}",
        f"claimed to be in a wrong unit: precision {found / max(1, len(claimed)):.3f}, "
        f"recall {found / max(1, len(wrong)):.3f}",
        f"the very unit named: {named / max(1, len(wrong)):.3f} of those in a wrong unit",
        f"recall among rows with a category: {known_found / max(1, len(known)):.3f}",
    ]


def real_units(records, answers):
    """The same on real errors, where the table has a ratio to the usual size of such things."""
    answers = {a["id"]: a for a in answers}
    rows = [r for r in records if r.get("scale_ratio") and r["scale_suspect"]]

    def plain(row):
        off = abs(math.log(float(row["scale_ratio"])))
        return row["scale_suspect"] == "1" and any(abs(off - math.log(f)) < 0.35 for f in UNITS.values())

    claimed = [r for r in rows if answers[r["id"]]["unit"] in ("mm", "cm", "in", "ft")]
    truth = [r for r in rows if plain(r)]
    both = [r for r in claimed if plain(r)]
    suspect = [r for r in truth if answers[r["id"]]["scale_suspect"] == "1"]
    return [
        f"rows {len(rows)}, off by about 1000, 100 or 39.37 either way: {len(truth)}",
        f"unit named: precision {len(both) / max(1, len(claimed)):.3f} ({len(both)} of {len(claimed)}), "
        f"recall {len(both) / max(1, len(truth)):.3f}",
        f"of them marked scale_suspect: {len(suspect) / max(1, len(truth)):.3f}",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("attributes", nargs="?", type=pathlib.Path, default=ROOT / "../shared/attributes")
    parser.add_argument("--split", default="dev")
    parser.add_argument("--physique", default=str(ROOT / "target/release/physique"))
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/mapping-accuracy.md")
    args = parser.parse_args()
    data = args.attributes / args.split
    if not data.is_dir():
        sys.exit(f"{data} is not there; name the folder of labelled tables")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        answers, seconds = mapped(args.physique, data / "records.csv", folder / "records.csv")
        names, _ = mapped(args.physique, data / "kind_names.csv", folder / "names.csv")
        both = folder / "both.csv"
        with open(both, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(answers[0]))
            writer.writeheader()
            writer.writerows(answers + names)
        score = [sys.executable, str(args.attributes / "tools/score.py"), str(args.attributes), args.split]
        scored = subprocess.run([*score, str(both)], check=True, capture_output=True, text=True).stdout
        with open(data / "records.csv", encoding="utf-8", newline="") as file:
            records = list(csv.DictReader(file))
        units = injected(args.physique, records, folder)
        real = real_units(records, answers)
    text = [
        "# Accuracy of the mapper",
        "",
        "Written by `scripts/mapping_accuracy.py`; not edited by hand. Truth columns are not read by the mapper.",
        f"{len(answers)} records and {len(names)} names of the split `{args.split}`.",
        "",
    ]
    for line in scored.splitlines():
        if line.startswith("== unit/scale"):
            figures = re.search(r"n=(\d+) precision=(\S+) recall=(\S+)", line)
            text += ["", "## Size off by more than five times", ""]
            text += ["| rows | precision | recall |", "|---|---|---|"]
            text.append("| " + " | ".join(figures.groups()) + " |")
        elif line.startswith("=="):
            text += ["", "## " + line[2:].strip().capitalize(), ""]
            header = True
        else:
            first = re.search(r"\s+n=", line)
            if not first:
                text.append(line.strip())
                continue
            fields = re.findall(r"(\w+)=(\{.*?\}|\s*-\s|\S+)", line[first.start():])
            if header:
                text.append("| what | " + " | ".join(key for key, _ in fields) + " |")
                text.append("|---|" + "---|" * len(fields))
                header = False
            title = " ".join(line[: first.start()].split())
            text.append(f"| {title} | " + " | ".join(value.strip() for _, value in fields) + " |")
    text += ["", "## Units written wrong on purpose", "", *(f"- {line}" for line in units)]
    text += ["", "## Units wrong in the records", "", *(f"- {line}" for line in real)]
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.write_text("\n".join(text) + "\n", encoding="utf-8")
    print(f"{args.out}: {len(answers) / seconds:.0f} records a second, start and files included")


if __name__ == "__main__":
    main()
