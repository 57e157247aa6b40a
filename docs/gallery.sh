#!/usr/bin/env bash
# Makes every picture of docs/gallery.md, docs/post_processing.md and docs/pipelines.md: builds, writes the scenes into out/gallery,
# renders them into docs/images.
# Arguments are passed on to `sfumato render`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake/prepare.sh
cmake --build --preset release --target sfumato make_gallery_scenes make_demo_scene
build/release/demos/make_gallery_scenes out/gallery

for scene in out/gallery/*.gltf; do
  picture="docs/images/$(basename "${scene%.gltf}").png"
  quality=(--quality high)
  if [[ $scene == *many_lights.gltf ]]; then quality+=(--shadow-res 512); fi # of 40 lamps, each with a cube of maps
  if [[ $scene == */many_lights.gltf ]]; then quality+=(--aov lights); fi
  if [[ $scene == */smoke.gltf ]]; then quality+=(--aov shadow-nodes); fi
  if [[ $scene == */multiscatter.gltf ]]; then quality+=(--multiscatter); fi
  if [[ $scene == */courtyard.gltf ]]; then quality+=(--ssao full --ssao-radius 0.5); fi
  echo "== $picture"
  build/release/app/sfumato render "$scene" --res 640x360 "${quality[@]}" -o "$picture" "$@"
done
build/release/app/sfumato render out/gallery/courtyard.gltf --res 640x360 --quality high -o docs/images/courtyard_open.png "$@"

# The pictures of docs/post_processing.md: NAME SCENE FLAGS...
shape() {
  echo "== docs/images/$1.png"
  build/release/app/sfumato render "out/gallery/$2.gltf" -o "docs/images/$1.png" "${@:3}"
}
small=(--res 400x225)
shape tonemap_neutral blades "${small[@]}" "$@"
shape tonemap_reinhard blades "${small[@]}" --tonemap reinhard "$@"
shape bloom_off slide "${small[@]}" "$@"
shape bloom_separable slide "${small[@]}" --bloom separable --bloom-strength 0.5 "$@"
shape bloom_mipmap slide "${small[@]}" --bloom mipmap --bloom-strength 0.5 "$@"
coarse=(--res 160x90 --quality draft)
shape aa_off grazing "${coarse[@]}" "$@"
shape aa_edges grazing "${coarse[@]}" --aa edges "$@"

# The pictures of docs/pipelines.md: the glass globe of the demo scene, drawn in several ways.
build/release/demos/make_demo_scene out
globe() {
  echo "== docs/images/globe_$1.png"
  build/release/app/sfumato render out/demo.gltf --res 240x192 --quality draft --fov 14 --look-at 1.05 1.15 2.5 \
    -o "docs/images/globe_$1.png" "${@:2}"
}
globe lund "$@"
globe interlaced --pipeline interlaced --shadows deep "$@"
globe table --pipeline interlaced --shadows deep --storage table "$@"
globe refraction --pipeline interlaced --shadows deep --refraction 0.15 "$@"
globe mask --pipeline forward-mask --shadows deep --refraction 0.15 "$@"
globe interlaced_shadows --pipeline interlaced "$@"
