#!/usr/bin/env bash
# Builds the static program and lays out what the target `prebuilt` of the Containerfile takes.
#
#   server/deploy/prebuild.sh FOLDER [PROFILE]       profile of cargo, release without it
#
# FOLDER gets `slewplan` and the empty `volumes/data`. The program in cargo's own folder is static too
# until the next build.
set -euo pipefail
folder=$(realpath -m "$1")
profile=${2:-release}
cd "$(dirname "$0")/../.."

# Only the last step differs from any other build: a program is made static when it is linked. glibc,
# not musl, because it is what everything else is tested with. It cannot look up names of hosts and
# users when it is static, nor load libraries; nothing here does. Relative relocations
# are packed, a bit for each instead of 24 bytes: a megabyte less.
cargo rustc --locked --package slewplan-server --bin slewplan --profile "$profile" -- \
    -C target-feature=+crt-static -C link-arg=-Wl,-z,pack-relative-relocs
case $profile in
    dev) output=debug ;;
    *) output=$profile ;;
esac
built=${CARGO_TARGET_DIR:-target}/$output/slewplan

if readelf --program-headers "$built" | grep -q INTERP; then
    echo "$built asks for a dynamic loader; an empty root has none" >&2
    exit 1
fi
mkdir -p "$folder/volumes/data"
strip --strip-all -o "$folder/slewplan" "$built"
