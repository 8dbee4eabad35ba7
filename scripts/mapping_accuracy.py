#!/usr/bin/env python3
"""Measures the mapper on labelled tables and writes docs/mapping-accuracy.md.

  scripts/mapping_accuracy.py [ATTRIBUTES] [--split dev] [--physique target/release/physique] [--out FILE]

ATTRIBUTES   folder with dev/, taxonomy/ and tools/score.py [default: ../shared/attributes beside the project]

Runs `physique map --table` on records.csv and kind_names.csv, lets tools/score.py judge, and adds what that leaves
out. Units: a row is put into a wrong unit on purpose (its size times 1000, 100 or 39.37) or left as it is; found
means that `unit` names the unit that undoes it. The catalogue: how many of the models of the taxonomies' union, by
count, carry a category that it has; and whether the names by which the taxonomies call their categories lead to
them, those of the records and those of no record apart: a rule made for a row shows as a gap between the two.
Standard library only.
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
CLAIMS = ("mm", "cm", "in", "ft", "m as mm", "m as cm", "m as in")
COUNTS = ("n_b1k", "n_shapenetsem", "n_tdw", "n_ai2thor", "n_objaverse_lvis")
# Taxonomy file: column of the name, column of the number of models, source in the records, path a model may have.
TAXONOMIES = {
    "b1k_categories.csv": ("category", "n_objects", "b1k", "objects/{}/aaaaaa/usd/aaaaaa.usd"),
    "tdw_categories.csv": ("category", "n_models", "tdw", ""),
    "ai2thor_types.csv": ("category", "n_models", "ai2thor", ""),
    "lvis_v1_with_objaverse_counts.csv": ("name", "objaverse_lvis_models", "", ""),
    "shapenetsem_categories.csv": ("category", "n_models", "", ""),
}


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
    claimed = [a for a in answers if a["unit"] in CLAIMS]
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
    """The same on real errors, where the table has a ratio to the usual size of such things. That size is one of a
    whole class (a golf ball's is 39 cm there), so a ratio is near a unit's factor only within a tolerance."""
    answers = {a["id"]: a for a in answers}
    rows = [r for r in records if r.get("scale_ratio") and r["scale_suspect"]]
    claimed = [r for r in rows if answers[r["id"]]["unit"] in CLAIMS]
    wrong = sum(r["scale_suspect"] == "1" for r in claimed)
    lines = [f"rows {len(rows)}; another unit claimed for {len(claimed)}, {wrong} of them off by more than five times"]
    for tolerance in (1.42, 2.0, 3.0):

        def plain(row):
            off = abs(math.log(float(row["scale_ratio"])))
            near = any(abs(off - math.log(factor)) < math.log(tolerance) for factor in UNITS.values())
            return row["scale_suspect"] == "1" and near

        truth = [r for r in rows if plain(r)]
        both = sum(plain(r) for r in claimed)
        suspect = sum(answers[r["id"]]["scale_suspect"] == "1" for r in truth)
        lines.append(
            f"off by 1000, 100 or 39.37 either way within {tolerance} times: {len(truth)}; unit claimed: precision "
            f"{both / max(1, len(claimed)):.3f}, recall {both / max(1, len(truth)):.3f}; marked scale_suspect: "
            f"{suspect / max(1, len(truth)):.3f}"
        )
    return lines


def groups_like_crosswalk(known):
    """Subcategories whose group is another than the crosswalk gives their synset."""
    rows, category = [], ""
    text = (ROOT / "catalog.yaml").read_text(encoding="utf-8")
    text = text[text.index("\ncategories:\n") : text.index("\nrules:\n")]
    for block in re.split(r"\n(?= {2}(?: {4})?[a-z0-9-]+:\n)", text):
        group = re.search(r"^ +group: (\S+)", block, re.M)
        synset = re.search(r"^ {8}synset: (\S+)", block, re.M)
        if re.match(r" {2}[a-z0-9]", block):
            category = group[1] if group else ""
        elif synset and synset[1] in known:
            rows.append((group[1] if group else category) != known[synset[1]]["group"])
    return f"groups that differ from the crosswalk's: {sum(rows)} of {len(rows)}"


def union(attributes):
    with open(attributes / "taxonomy/synset_union.csv", encoding="utf-8", newline="") as file:
        return {row["synset"]: row for row in csv.DictReader(file)}


def near(known, one, other):
    """Equal, or one an ancestor of the other within three, as tools/score.py has it."""
    above = lambda synset: list(reversed(known[synset]["hypernym_path"].split(" > ")))[:4] if synset in known else []
    return one == other or other in above(one) or one in above(other)


def of_catalogue(physique, attributes, folder):
    """Share of the union's models whose category has a subcategory of that synset, or one that its words lead to."""
    known = union(attributes)
    table = folder / "union.csv"
    rows = [(synset, lemma.replace("_", " ")) for synset, row in known.items() for lemma in row["lemmas"].split("|")]
    write(table, ["id", "name"], [[f"{synset} {lemma}", lemma] for synset, lemma in rows])
    answers, _ = mapped(physique, table, folder / "union-out.csv")
    led = {}
    for (synset, _), answer in zip(rows, answers):
        led.setdefault(synset, []).append(answer["synset"])
    count = {synset: sum(int(row[column] or 0) for column in COUNTS) for synset, row in known.items()}
    total = sum(count.values())
    share = lambda test: sum(count[synset] for synset in known if test(synset)) / total
    here = set(re.findall(r"^ +synset: (\S+)", (ROOT / "catalog.yaml").read_text(encoding="utf-8"), re.M))
    return [
        f"models in the union {total}, categories {len(known)}",
        f"carry a subcategory of their very synset: {share(lambda synset: synset in here):.3f}",
        "led by one of their words to that synset or one near it: "
        f"{share(lambda synset: any(near(known, answer, synset) for answer in led[synset])):.3f}",
        groups_like_crosswalk(known),
    ]


def of_names(physique, attributes, records, folder):
    """A line a taxonomy: whether the names of its categories lead to them, weighted by models."""
    known = union(attributes)
    lines = []
    for file, (name, count, source, path) in TAXONOMIES.items():
        seen = {row["src_category"] for row in records if row["source"] == source}
        with open(attributes / "taxonomy" / file, encoding="utf-8", newline="") as opened:
            rows = [row for row in csv.DictReader(opened) if row["synset"]]
        table = folder / "names.csv"
        cells = [[str(at), path.format(row[name]), row[name].split(",")[0]] for at, row in enumerate(rows)]
        write(table, ["id", "path", "name"], cells)
        answers, _ = mapped(physique, table, folder / "names-out.csv")
        for title, wanted in (("in the records", True), ("in none", False)):
            pairs = [(r, a) for r, a in zip(rows, answers) if (r[name] in seen) == wanted]
            models = sum(int(r[count] or 0) for r, _ in pairs)
            if not models:
                continue
            right = [(r, a) for r, a in pairs if near(known, a["synset"], r["synset"])]
            lines.append(
                f"| {file.removesuffix('.csv')} | {title} | {len(pairs)} | {len(right) / len(pairs):.3f} "
                f"| {models} | {sum(int(r[count] or 0) for r, _ in right) / models:.3f} |"
            )
    return lines


def write(table, header, rows):
    with open(table, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([header, *rows])


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
        catalogue = of_catalogue(args.physique, args.attributes, folder)
        named = of_names(args.physique, args.attributes, records, folder)
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
    text += ["", "## The catalogue against the union of taxonomies", "", *(f"- {line}" for line in catalogue)]
    text += ["", "## Names of the taxonomies' categories", "", "Hierarchical: the synset, or one within three above or below."]
    text += ["", "| taxonomy | category stands | n | hier | models | hier by models |", "|---|---|---|---|---|---|", *named]
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.write_text("\n".join(text) + "\n", encoding="utf-8")
    print(f"{args.out}: {len(answers) / seconds:.0f} records a second, start and files included")


if __name__ == "__main__":
    main()
