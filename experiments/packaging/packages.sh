#!/usr/bin/env bash
# Debian packages for any x86-64: hagfish, python3-hagfish, libhagfish-dev, in out/packages or a folder that is named.
#   bash experiments/packaging/packages.sh [OUTPUT_FOLDER]
# With --try it installs them in a bare Debian 12 in a folder (debootstrap; as root), and runs the program there.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
try=
if [[ ${1-} == --try ]]; then
  try=1
  shift
fi
out=${1:-$root/out/packages}
mkdir -p "$out"
out=$(cd "$out" && pwd)
PRESET=package bash "$root/experiments/setup.sh"
(cd "$root/build/package" && cpack -B "$out")
rm -rf "$out/_CPack_Packages"
ls "$out"
[[ -n $try ]] || exit 0

bare=$(mktemp -d)
trap 'rm -rf --one-file-system "$bare"' EXIT
debootstrap --variant=minbase bookworm "$bare"
cp "$out"/hagfish_*.deb "$bare/tmp/"
chroot "$bare" bash -euc '
  apt-get install -y --no-install-recommends /tmp/hagfish_*.deb
  cd /tmp && hagfish run living_overhand --out knot.h5 && hagfish check knot.h5 && hagfish view knot.h5 --out knot.html && ls -l knot.html'
