#!/usr/bin/env bash
# Prepares a Debian 12 machine and builds the project: installs the Debian packages that are missing
# (asks for root or sudo only then), configures and builds build/release (or PRESET). The other scripts call it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if ! (. /etc/os-release 2>/dev/null && [[ $ID == debian && $VERSION_ID == 12 ]]); then
  echo "setup: this builds on Debian 12; elsewhere use the container, the packages or the page for a browser: experiments/packaging/README.md" >&2
  exit 2
fi

packages=(
  g++ cmake ninja-build pkg-config git ca-certificates  # to build
  libeigen3-dev libfmt-dev libtoml11-dev libcli11-dev   # C++ libraries
  nlohmann-json3-dev libcereal-dev
  libhdf5-dev coinor-libipopt-dev libmujoco-dev
  libegl-dev libgl1-mesa-dri libpng-dev                 # pictures, without a display
  libqhull-dev libgl-dev libopengl-dev                  # named by MuJoCo's CMake file, but not by its package
  libgtest-dev libbenchmark-dev                         # tests and benchmarks
  python3 python3-h5py python3-matplotlib               # figures
  pybind11-dev python3-dev                              # the Python module
  libjs-three node-d3                                   # replays in a browser
)
if [[ -z ${HAGFISH_RUN_ONLY-} ]]; then
  packages+=(
    python3-pytest python3-xarray python3-h5netcdf mypy # tests, and logs in Python
    ffmpeg                                              # films
  )
fi
if [[ -n ${HAGFISH_CLUSTER-} ]]; then
  packages+=(snakemake slurmctld slurmd slurm-client munge time) # sweeps on a cluster, and a cluster to try them on
fi

if [[ -n ${HAGFISH_WEB-} ]]; then
  packages+=(clang-16 lld-16 llvm-16 libc++-16-dev-wasm32 libc++abi-16-dev-wasm32 libclang-rt-16-dev-wasm32 wasi-libc libsimde-dev
    nodejs chromium) # the page that runs the simulator in a browser, and its tests
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "Installing Debian packages: ${missing[*]}"
  as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "setup: these packages are missing, and there is no sudo; run as root:" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
      exit 2
    fi
    as_root=(sudo)
  fi
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
         "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
           apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "setup: the packages above could not be installed (whole log: $log)" >&2
    exit 2
  fi
  rm -f "$log"
fi

preset=${PRESET:-${HAGFISH_WEB:+web}}
preset=${preset:-release}
log=$(mktemp)
cmake --preset "$preset" >"$log" 2>&1 || { cat "$log" >&2; exit 2; }
rm -f "$log"
cmake --build --preset "$preset" "$@"
