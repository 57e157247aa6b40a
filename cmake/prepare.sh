#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, and configures build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  cmake ninja-build g++ pkg-config
  libopenvdb-dev libboost-iostreams-dev # OpenVDB's headers and its CMake module want Boost
  libopenimageio-dev openimageio-tools
  libtinygltf-dev libglm-dev libcli11-dev libfmt-dev libspdlog-dev nlohmann-json3-dev libtbb-dev libgtest-dev
  libjs-chart.js # plots of `sfumato stress --report`, compiled in
  libepoxy-dev libegl-dev libegl1 libegl-mesa0 libgl1-mesa-dri # OpenGL, and a driver that needs no GPU
)

installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
  grep -qx "$package installed" <<<"$installed" || missing+=("$package")
done

if ((${#missing[@]})); then
  echo "Installing ${missing[*]}"
  as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || {
      echo "prepare.sh: error: packages are missing and there is no sudo: as root, apt-get install ${missing[*]}" >&2
      exit 1
    }
    as_root=(sudo)
  fi
  apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q)
  "${apt[@]}" update
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}"
fi

launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset release --log-level=NOTICE "${launcher[@]}"
