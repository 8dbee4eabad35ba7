#!/usr/bin/env python3
"""Asks the public schemas what they say of the reports of `physique check`.

    check_formats.py BINARY

Makes a small database with the demo, checks it into every format, and validates
  sarif   by the OASIS schema 2.1.0 (rtm.5), as the npm package @microsoft/jest-sarif carries it
  junit   by the XSD of Jenkins' xUnit plugin, which most consumers follow, as the sources of pytest carry it (PyPI), and
          by junitparser, a reader
  gitlab  by the Code Climate specification, which GitLab's report follows, as the types of the npm package
          codeclimate-types have it and the TypeScript compiler checks them; by the schema that GitLab itself reads
          reports with, where gitlab.com can be reached; and by what its documentation asks beyond both
  github  by the grammar of workflow commands
  json    by reading it; jsonl line by line
  action.yml, integrations/gitlab.yml and .pre-commit-hooks.yaml by the schemas that check-jsonschema carries and by
          pre-commit itself, which also runs the hook, on rules that are sound and on rules that are not
Needs node with npm, and Python; what else it needs it installs into a folder beside BINARY. What cannot be
had is skipped and said: the exit code is 0 then, and a line begins with `skipped:`.
"""

import argparse
import contextlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import urllib.error
import urllib.request
import venv

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEVERITIES = {"info", "minor", "major", "critical", "blocker"}
PYTEST = "8.4.2"
PYTHON_PACKAGES = ["jsonschema", "junitparser", "xmlschema", "check-jsonschema", "pre-commit"]
NODE_PACKAGES = ["@microsoft/jest-sarif@1.0.0-beta.0", "codeclimate-types@0.3.1", "typescript@5.9.3"]
GITLAB_SCHEMA = "https://gitlab.com/gitlab-org/gitlab/-/raw/master/app/validators/json_schemas/codeclimate.json"


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def fetch(*command):
    """Installs what judges the reports; without a network there is no verdict, and none is made up."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        last = (done.stderr or done.stdout).strip().splitlines()[-1:]
        print(f"skipped: {command[-1]} cannot be had here: {''.join(last)}")
        sys.exit(0)


def install(tools):
    """What judges, and where its programs are; nothing is fetched that is there already."""
    programs = tools / "venv" / "bin"
    if not (programs / "pre-commit").exists():
        venv.create(tools / "venv", with_pip=True)
        fetch(programs / "pip", "install", "--quiet", *PYTHON_PACKAGES)
    if not (tools / f"pytest-{PYTEST}.tar.gz").exists():
        # The wheel has no tests; the sources have, and the XSD among them.
        source = ["--quiet", "--no-deps", "--no-binary", "pytest", "--dest", tools]
        fetch(programs / "pip", "download", *source, f"pytest=={PYTEST}")
    if not (tools / "node_modules" / "typescript").exists():
        fetch("npm", "install", "--no-audit", "--no-fund", "--prefix", tools, *NODE_PACKAGES)
    sys.path.insert(0, str(next((tools / "venv" / "lib").glob("python*/site-packages"))))
    return programs


def check(binary, folder):
    models = folder / "demo"
    subprocess.run([binary, "demo", "--out", models, "--no-record", "--quiet"], stdout=subprocess.DEVNULL, check=False)
    (models / "models" / "furniture" / "chair.physics.yaml").write_text("mass: 900 kg\n")
    names = ["json", "jsonl", "junit", "sarif", "github", "gitlab", "markdown", "html"]
    command = [binary, "check", "demo/models", "--db", "demo/catalogue.db", "--quiet", "--deny", "MAS002"]
    command += [f"--report={name}={name}.out" for name in names]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 1, (done.returncode, done.stderr)
    return {name: (folder / f"{name}.out").read_text() for name in names}


def sarif(text, tools):
    import jsonschema

    file = next(tools.glob("node_modules/@microsoft/jest-sarif/lib/schemas/sarif-2.1.0*.json"))
    schema = json.loads(file.read_text())
    log = json.loads(text)
    jsonschema.validators.validator_for(schema)(schema).validate(log)
    assert log["version"] == "2.1.0" and log["runs"][0]["results"]


def junit(path, tools):
    from junitparser import JUnitXml
    import xmlschema

    with tarfile.open(tools / f"pytest-{PYTEST}.tar.gz") as archive:
        xsd = archive.extractfile(f"pytest-{PYTEST}/testing/example_scripts/junit-10.xsd").read()
    xmlschema.XMLSchema(xsd.decode()).validate(str(path))

    suites = list(JUnitXml.fromfile(str(path)))
    cases = [case for suite in suites for case in suite]
    assert cases and all(case.name and case.classname for case in cases)
    failed = [case for case in cases if any(type(result).__name__ == "Failure" for result in case.result)]
    assert len(failed) == sum(suite.failures for suite in suites), failed
    assert any(case.name == "furniture/chair.glb" for case in failed), failed
    for suite in suites:
        assert suite.tests == len(list(suite))


def gitlab(text, tools, folder):
    import jsonschema

    # The compiler refuses fields that the specification does not have, and values that it does not know. It finds the
    # types beside its own file.
    (folder / "node_modules").symlink_to(tools / "node_modules")
    typed = folder / "gitlab.ts"
    typed.write_text(f'import type {{ Issue }} from "codeclimate-types"\nexport const report: Issue[] = {text}')
    run(tools / "node_modules" / ".bin" / "tsc", "--noEmit", "--strict", "--module", "nodenext", typed)

    issues = json.loads(text)
    try:
        with urllib.request.urlopen(GITLAB_SCHEMA, timeout=20) as answer:
            schema = json.load(answer)
    except (urllib.error.URLError, TimeoutError) as error:
        print(f"skipped: the schema of GitLab's own reader cannot be had here: {error}")
    else:
        for issue in issues:
            jsonschema.validate(issue, schema)
    assert issues and len({issue["fingerprint"] for issue in issues}) == len(issues)
    for issue in issues:
        assert all(isinstance(issue[name], str) and issue[name] for name in ("description", "check_name", "fingerprint"))
        assert issue["severity"] in SEVERITIES
        path = issue["location"]["path"]
        assert path and not path.startswith(("/", "./")), path
        assert isinstance(issue["location"]["lines"]["begin"], int) and issue["location"]["lines"]["begin"] >= 1


def github(text):
    command = re.compile(r"^::(error|warning|notice) (?:(?:file|line|col|title)=[^:,\r\n]*,?)+::[^\r\n]+$")
    commands = [line for line in text.splitlines() if line.startswith("::")]
    assert commands
    for line in commands:
        assert command.match(line), line


def hook(programs, binary, folder):
    """The hook as pre-commit runs it in a repository of rules: it lets sound ones pass and stops broken ones."""
    if not (ROOT / ".git").exists():
        print("skipped: pre-commit runs hooks of git repositories, and this folder is none")
        return
    rules = folder / "rules"
    rules.mkdir()
    shutil.copy(ROOT / "catalog.yaml", rules)
    environment = {
        **os.environ,
        "PATH": f"{binary.parent}{os.pathsep}{os.environ['PATH']}",
        "PRE_COMMIT_HOME": str(folder / "pre-commit"),
    }

    def tried():
        command = [programs / "pre-commit", "try-repo", ROOT, "physique-check", "--files", "catalog.yaml"]
        return subprocess.run(command, cwd=rules, env=environment, capture_output=True, text=True)

    run("git", "init", "--quiet", rules)
    run("git", "-C", rules, "add", "--all")
    sound = tried()
    assert sound.returncode == 0, sound.stdout + sound.stderr
    text = (rules / "catalog.yaml").read_text()
    (rules / "catalog.yaml").write_text(text.replace("\n  steel:", "\n  steel: [", 1))
    broken = tried()
    assert broken.returncode == 1 and "MAP001" in broken.stdout, broken.stdout + broken.stderr


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("binary", type=pathlib.Path)
    given = arguments.parse_args()
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        binary = given.binary.resolve()
        tools = binary.parent / "format-tools"
        tools.mkdir(exist_ok=True)
        programs = install(tools)
        reports = check(binary, folder)
        json.loads(reports["json"])
        for line in reports["jsonl"].splitlines():
            json.loads(line)
        sarif(reports["sarif"], tools)
        junit(folder / "junit.out", tools)
        gitlab(reports["gitlab"], tools, folder)
        github(reports["github"])
        schema = programs / "check-jsonschema"
        run(schema, "--builtin-schema", "vendor.github-actions", ROOT / "action.yml")
        run(schema, "--builtin-schema", "vendor.gitlab-ci", "--data-transform", "gitlab-ci", ROOT / "integrations/gitlab.yml")
        run(programs / "pre-commit", "validate-manifest", ROOT / ".pre-commit-hooks.yaml")
        hook(programs, binary, folder)
        print(f"{len(reports)} formats and 3 files for the forges are valid")


if __name__ == "__main__":
    main()
