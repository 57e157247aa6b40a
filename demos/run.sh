#!/usr/bin/env bash
# From a bare Debian 12 to a picture: installs what is missing, builds, makes the demo scene and renders it.
# Arguments are passed on to `sfumato render`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

echo "== Packages and configuration"
cmake/prepare.sh

echo "== Building"
cmake --build --preset release --target sfumato make_demo_scene

echo "== Making the scene: out/demo.gltf"
build/release/demos/make_demo_scene out

echo "== Rendering"
build/release/app/sfumato render out/demo.gltf --res 1280x720 --quality medium \
  -o out/demo.exr -o out/demo.png "$@"

echo "The picture is $PWD/out/demo.png (and demo.exr, in linear radiance)."
