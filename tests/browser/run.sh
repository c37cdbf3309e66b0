#!/usr/bin/env bash
# Uses the page in a browser: Chromium without a window, on a service of its own.
#
#   tests/browser/run.sh [PART...]        the parts are those of run.mjs; all without it
#
# SLEWPLAN names a built binary; without it the binary is built. SCREENSHOTS names a folder for
# pictures of every view. Chromium and Node.js come from the system or by apt, the rest from npm.
set -euo pipefail
cd "$(dirname "$0")/../.."
playwright=1.65.1
axe=4.14.1

missing=()
# A browser without any letters would show nothing.
for program in "chromium:chromium fonts-liberation" node:nodejs npm:npm; do
    command -v "${program%%:*}" >/dev/null || missing+=(${program##*:})
done
if [ ${#missing[@]} -gt 0 ]; then
    as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update
    "${as_root[@]}" apt-get install --yes --no-install-recommends "${missing[@]}"
fi

if [ -z "${SLEWPLAN:-}" ]; then
    cargo build --locked --package slewplan-server
    SLEWPLAN=${CARGO_TARGET_DIR:-target}/debug/slewplan
fi
export SLEWPLAN

tools=${BROWSER_TOOLS:-${XDG_CACHE_HOME:-$HOME/.cache}/slewplan/browser-$playwright-$axe}
if [ ! -f "$tools/complete" ]; then
    mkdir -p "$tools"
    npm install --prefix "$tools" --no-save --no-audit --no-fund --ignore-scripts \
        "playwright-core@$playwright" "axe-core@$axe"
    touch "$tools/complete"
fi
export BROWSER_TOOLS=$tools
exec node tests/browser/run.mjs "$@"
