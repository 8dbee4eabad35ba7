#!/usr/bin/env bash
# The gate as the forges run it: checks, writes every report they take in, and ends with the gate's exit code.
#   PHYSIQUE_MODELS  folder of models                      [models]
#   PHYSIQUE_ARGS    more flags of physique check, in words: --changed-since origin/main --locked
#   PHYSIQUE_DB      catalogue, to be kept between runs     [.physique/catalogue.db]
#   PHYSIQUE_OUT     folder of the reports                  [physique-reports]
#   PHYSIQUE_FORGE   github or gitlab
set -uo pipefail
models=${PHYSIQUE_MODELS:-models}
db=${PHYSIQUE_DB:-.physique/catalogue.db}
out=${PHYSIQUE_OUT:-physique-reports}
forge=${PHYSIQUE_FORGE:-github}
read -r -a more <<<"${PHYSIQUE_ARGS:-}"

reports=(--report "html=$out/physique.html" --report "markdown=$out/physique.md" --report "json=$out/physique.json")
if [ "$forge" = github ]; then
    format=github
    reports+=(--report "sarif=$out/physique.sarif")
else
    format=concise
    reports+=(--report "gitlab=$out/gl-code-quality-report.json" --report "junit=$out/junit.xml")
fi
physique check "$models" --db "$db" --format "$format" "${reports[@]}" ${more[@]+"${more[@]}"}
code=$?

if [ "$forge" = github ]; then
    [ -z "${GITHUB_STEP_SUMMARY:-}" ] || [ ! -f "$out/physique.md" ] || cat "$out/physique.md" >>"$GITHUB_STEP_SUMMARY"
    [ -z "${GITHUB_OUTPUT:-}" ] || printf 'sarif=%s\nhtml=%s\nexit-code=%s\n' "$out/physique.sarif" "$out/physique.html" "$code" >>"$GITHUB_OUTPUT"
fi
exit "$code"
