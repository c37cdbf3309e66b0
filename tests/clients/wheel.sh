#!/usr/bin/env bash
# Builds the wheel of program and Python module, and uses it as a planner without Rust does.
#
#   tests/clients/wheel.sh [PROFILE]       profile of cargo for the program, release without it
#
# The environment in which it is installed has no other programs than those of Python. There the
# notebook of server/docs/python.md runs as it is printed, and the typed client plans with a service.
set -euo pipefail
cd "$(dirname "$0")/../.."
profile=${1:-release}

work=$(mktemp -d)
service=
clean() {
    if [ -n "$service" ]; then
        kill "$service" 2>/dev/null || true
        wait "$service" 2>/dev/null || true
    fi
    rm -rf "$work"
}
trap clean EXIT

python3 -m venv "$work/build"
# The same folder of cargo as all other builds: of the development profile nothing is built twice.
CARGO_TARGET_DIR=$(realpath -m "${CARGO_TARGET_DIR:-target}") "$work/build/bin/pip" wheel --quiet \
    --disable-pip-version-check --no-deps --wheel-dir "$work/dist" \
    --config-settings "build-args=--profile $profile" ./server/python
ls "$work/dist"

python3 -m venv "$work/planner"
clean_env=(env -i "HOME=$work" "PATH=$work/planner/bin")
if "${clean_env[@]}" "$work/planner/bin/python" -c 'import shutil, sys; sys.exit(shutil.which("cargo") is None)'; then
    echo "the environment has Rust" >&2
    exit 1
fi
"${clean_env[@]}" pip install --quiet --disable-pip-version-check --no-index "$work"/dist/slewplan-*.whl
echo "ok   the wheel installs without Rust and without other packages"

page=$PWD/server/docs/python.md
example=$PWD/tests/clients/python/example.py
scenario=$PWD/tests/fixtures/two-targets.json
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
cd "$work"
[ "$("${clean_env[@]}" slewplan --version)" = "slewplan $version" ]
[ "$("${clean_env[@]}" python -m slewplan --version)" = "slewplan $version" ]
echo "ok   slewplan $version"
"${clean_env[@]}" slewplan init
"${clean_env[@]}" slewplan validate scenario.json

# The blocks of a language on the page.
block() {
    sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/p" "$page" | sed '/^```/d'
}
block csv >targets.csv
block python >notebook.py
"${clean_env[@]}" python notebook.py | tee notebook.out
grep -q '^optimal: ' notebook.out
for target in m31 m33 pleiades; do
    grep -q " s  $target\$" notebook.out
done
"${clean_env[@]}" python -c 'import xml.etree.ElementTree as tree; assert tree.parse("plan.svg").getroot().tag.endswith("svg")'
echo "ok   the notebook of the page reads a table, plans and draws"

"${clean_env[@]}" slewplan serve --listen 127.0.0.1:0 --database "$work/plans.db" --log warn >out 2>log &
service=$!
for _ in $(seq 100); do
    grep -q listening out && break
    sleep 0.1
done
"${clean_env[@]}" python "$example" "$(sed -n 's/^listening on //p' out)" "$scenario" "$work/answers"
[ -s answers/plan.json ] && [ -s answers/plan.aem ]
echo "ok   the typed client plans with a service"
