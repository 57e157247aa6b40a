#!/usr/bin/env bash
# Makes every picture of docs/gallery.md: builds, writes the scenes into out/gallery, renders them into docs/images.
# Arguments are passed on to `sfumato render`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake/prepare.sh
cmake --build --preset release --target sfumato make_gallery_scenes
build/release/demos/make_gallery_scenes out/gallery

for scene in out/gallery/*.gltf; do
  picture="docs/images/$(basename "${scene%.gltf}").png"
  quality=(--quality high)
  if [[ $scene == *many_lights.gltf ]]; then quality+=(--shadow-res 512); fi # of 40 lamps, each with a cube of maps
  if [[ $scene == */many_lights.gltf ]]; then quality+=(--aov lights); fi
  if [[ $scene == */smoke.gltf ]]; then quality+=(--aov shadow-nodes); fi
  if [[ $scene == */multiscatter.gltf ]]; then quality+=(--multiscatter); fi
  if [[ $scene == */courtyard.gltf ]]; then quality+=(--ssao full); fi
  echo "== $picture"
  build/release/app/sfumato render "$scene" --res 640x360 "${quality[@]}" -o "$picture" "$@"
done
build/release/app/sfumato render out/gallery/courtyard.gltf --res 640x360 --quality high -o docs/images/courtyard_open.png "$@"
