#!/usr/bin/env bash
# Builds the image around a static program and runs it as its users do.
#
#   tests/container.sh [PROFILE]       profile of cargo for the program, release without it
#
# Compose file, Kubernetes manifests and image are held against their schemas and against what
# server/deploy promises; then `solve`, `legs` and `serve` run from the image's files: an
# unprivileged user, a read-only root, one volume; and the commands of the Compose file with Postgres,
# in its order and by its health checks. No container engine is needed, but root is.
set -euo pipefail
cd "$(dirname "$0")/.."
profile=${1:-release}

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
fi
missing=()
for program in buildah readelf:binutils unshare:util-linux; do
    command -v "${program%%:*}" >/dev/null || missing+=("${program##*:}")
done
# Several processes are run on a Postgres of this system.
if ! ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1 && ! command -v initdb >/dev/null; then
    missing+=(postgresql)
fi
if [ ${#missing[@]} -gt 0 ]; then
    "${as_root[@]}" apt-get update
    "${as_root[@]}" apt-get install --yes --no-install-recommends "${missing[@]}"
fi

work=$(mktemp -d)
# A store of its own: no other image is needed, and none is left behind.
buildah=("${as_root[@]}" buildah --storage-driver vfs --root "$work/store" --runroot "$work/run")
clean() {
    "${buildah[@]}" umount --all >/dev/null 2>&1 || true
    "${as_root[@]}" rm -rf "$work"
}
trap clean EXIT

server/deploy/prebuild.sh "$work/image" "$profile"
"${buildah[@]}" bud --isolation chroot --format docker --file server/deploy/Containerfile \
    --target prebuilt --tag slewplan "$work/image"
"${buildah[@]}" inspect --type image slewplan >"$work/image.json"
sandbox=$("${buildah[@]}" from slewplan)

python3 tests/container/manifests.py "$work/image.json"

# The system calls that engines allow by default are enough, and buildah's own way to run agrees.
"${buildah[@]}" run --isolation chroot "$sandbox" -- /slewplan solve - \
    <tests/fixtures/two-targets.json >"$work/plan.json"
grep -q '"status": "optimal"' "$work/plan.json"
echo "ok   solve within buildah's sandbox"

container=$("${buildah[@]}" from slewplan)
root=$("${buildah[@]}" mount "$container")
"${as_root[@]}" env PYTHONDONTWRITEBYTECODE=1 python3 tests/container/run.py "$work/image.json" "$root"
