#!/usr/bin/env python3
"""Asks the public schemas what they say of the reports of `physique check`.

    check_formats.py BINARY

Makes a small database with the demo, checks it into every format, and validates
  sarif   by the OASIS schema 2.1.0 (rtm.5), as the npm package @microsoft/jest-sarif carries it
  junit   by JUnitXml's reader (PyPI junitparser) and the structure that common consumers read
  gitlab  by the fields that GitLab documents for a code quality report
  github  by the grammar of workflow commands
  json    by reading it; jsonl line by line
  action.yml, integrations/gitlab.yml and .pre-commit-hooks.yaml by the schemas that check-jsonschema carries and by
          pre-commit itself
Needs node with npm, and Python; what else it needs it installs into a temporary folder.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import venv

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEVERITIES = {"info", "minor", "major", "critical", "blocker"}


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


def sarif(text, folder):
    fetch("npm", "install", "--no-audit", "--no-fund", "--prefix", folder, "@microsoft/jest-sarif@1.0.0-beta.0")
    schema = next(folder.glob("node_modules/@microsoft/jest-sarif/lib/schemas/sarif-2.1.0*.json"))
    import jsonschema

    log = json.loads(text)
    jsonschema.validators.validator_for(json.loads(schema.read_text()))(json.loads(schema.read_text())).validate(log)
    assert log["version"] == "2.1.0" and log["runs"][0]["results"]


def junit(path):
    from junitparser import JUnitXml

    suites = list(JUnitXml.fromfile(str(path)))
    cases = [case for suite in suites for case in suite]
    assert cases and all(case.name and case.classname for case in cases)
    failed = [case for case in cases if any(type(result).__name__ == "Failure" for result in case.result)]
    assert len(failed) == sum(suite.failures for suite in suites), failed
    assert any(case.name == "furniture/chair.glb" for case in failed), failed
    for suite in suites:
        assert suite.tests == len(list(suite))


def gitlab(text):
    issues = json.loads(text)
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


def main():
    binary = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        venv.create(folder / "venv", with_pip=True)
        tools = folder / "venv" / "bin"
        fetch(tools / "pip", "install", "--quiet", "jsonschema", "junitparser", "check-jsonschema", "pre-commit")
        site = next((folder / "venv" / "lib").glob("python*/site-packages"))
        sys.path.insert(0, str(site))
        reports = check(binary, folder)
        json.loads(reports["json"])
        for line in reports["jsonl"].splitlines():
            json.loads(line)
        sarif(reports["sarif"], folder)
        junit(folder / "junit.out")
        gitlab(reports["gitlab"])
        github(reports["github"])
        schema = tools / "check-jsonschema"
        run(schema, "--builtin-schema", "vendor.github-actions", ROOT / "action.yml")
        run(schema, "--builtin-schema", "vendor.gitlab-ci", "--data-transform", "gitlab-ci", ROOT / "integrations/gitlab.yml")
        run(tools / "pre-commit", "validate-manifest", ROOT / ".pre-commit-hooks.yaml")
        print(f"{len(reports)} formats and 3 files for the forges are valid")


if __name__ == "__main__":
    main()
