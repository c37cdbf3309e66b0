#!/usr/bin/env bash
# Generates requests from openapi.yaml and holds the answers against it.
#
#   tests/schemathesis.sh [EXAMPLES [OPTION...]]     examples for each operation, 20 without it
#
# SLEWPLAN names a built binary; without it the binary is built. The long form is EXAMPLES=2000; it
# takes the generator, not the service, more than an hour on a busy machine. Options go to
# schemathesis: --phases examples,coverage,fuzzing and --phases stateful can run side by side.
set -euo pipefail
cd "$(dirname "$0")/.."
examples=${1:-20}
version=4.32.5

if [ -z "${SLEWPLAN:-}" ]; then
    cargo build --locked --package slewplan-server
    SLEWPLAN=${CARGO_TARGET_DIR:-target}/debug/slewplan
fi

tools=${SCHEMATHESIS_VENV:-${XDG_CACHE_HOME:-$HOME/.cache}/slewplan/schemathesis-$version}
if [ ! -x "$tools/bin/schemathesis" ]; then
    python3 -m venv "$tools"
    "$tools/bin/pip" install --quiet "schemathesis==$version"
fi

work=$(mktemp -d)
"$SLEWPLAN" serve --listen 127.0.0.1:0 --database "$work/fuzz.db" --log warn \
    >"$work/out" 2>"$work/log" &
service=$!
trap 'kill "$service" 2>/dev/null || true; wait "$service" 2>/dev/null || true; rm -rf "$work"' EXIT
for _ in $(seq 100); do
    grep -q listening "$work/out" && break
    sleep 0.1
done
address=$(sed -n 's/^listening on //p' "$work/out")

status=0
# Requests that compute may take a minute. The study of authorities flies plans by the thousand, which
# takes a development build that long for every request: tests/service/studies.rs holds it to account.
"$tools/bin/schemathesis" --config-file tests/schemathesis.toml run openapi.yaml \
    --url "$address" --checks all --max-examples "$examples" --seed 1 \
    --generation-database none --request-timeout 90 --max-response-time 80 \
    --exclude-path /v1/studies/authority "${@:2}" || status=$?
if grep -E 'ERROR|panic' "$work/log"; then
    echo "the service logged errors" >&2
    status=1
fi
exit "$status"
