#!/usr/bin/env bash
# Smoke under a sun, drawn by Sfumato and by OpenVDB's own vdb_render (Debian: libopenvdb-tools) in steps of one voxel.
# Prints, for each quality, the medians over some runs in turn of the wall-clock and the processor's seconds of both
# whole programs, the seconds of Sfumato's frame alone, and the relative RMSE of its picture to its reference quality.
#   tests/bench/vdb_render_comparison.sh FOLDER [SFUMATO [RUNS [RESOLUTION [SIGMA]]]]
# FOLDER holds sun.gltf and smoke.vdb; its floor is taken away, as vdb_render knows no surfaces. SIGMA, extinction per unit
# of density in 1/m, is 7 as in the scene; vdb_render's own is 1.6.
set -euo pipefail
folder=$(realpath "${1:?usage: $0 FOLDER [SFUMATO [RUNS [RESOLUTION [SIGMA]]]]}")
sfumato=${2:-build/release/app/sfumato}
runs=${3:-3}
resolution=${4:-640x480}
sigma=${5:-7}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

ln -s "$folder/smoke.vdb" "$work/smoke.vdb"
python3 - "$folder/sun.gltf" "$work/sun.gltf" "$sigma" <<'PYTHON'
import json, sys
scene = json.load(open(sys.argv[1]))
for node in scene["nodes"]:
    node.pop("mesh", None)
    if "extras" in node:
        node["extras"]["volume_scale"] = float(sys.argv[3])
for unused in ("meshes", "materials", "accessors", "bufferViews", "buffers"):
    scene.pop(unused, None)
json.dump(scene, open(sys.argv[2], "w"))
PYTHON
scatter=$(awk -v s="$sigma" 'BEGIN { print 0.9 * s }')
absorb=$(awk -v s="$sigma" 'BEGIN { print 0.1 * s }')
width=${resolution%x*}
height=${resolution#*x}
# Across; 0.59341 up.
fov=$(awk -v a="$width" -v b="$height" 'BEGIN { t = sin(0.296706) / cos(0.296706) * a / b; print 2 * atan2(t, 1) * 57.29578 }')

# Appends the wall-clock and the processor's seconds of a command to a file.
clocked() {
  local into=$1
  shift
  TIMEFORMAT='%R %U %S'
  { time "$@" >"$work/log" 2>&1; } 2>"$work/time" || { cat "$work/log" >&2; exit 1; }
  awk '{ printf "%.2f %.2f\n", $1, $2 + $3 }' "$work/time" >>"$into"
}
median() { cut -d' ' -f"$2" "$1" | sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

# The camera, light and medium of sun.gltf, in the space of its grid.
theirs() {
  clocked "$1" vdb_render "$work/smoke.vdb" "$work/vdb_render.exr" -name density -res "$resolution" -step 1 -shadowstep 1 \
    -fov "$fov" -translate 0,1.98,8.2 -lookat 0,1.83,0.001 -light 0.597,0.697,0.398,6,5.6,5 \
    -scatter "$scatter,$scatter,$scatter" -absorb "$absorb,$absorb,$absorb"
}
ours() {
  local render=("$sfumato" render "$work/sun.gltf" --res "$resolution" --quality "$2" -o "$work/$2.exr")
  clocked "$1" "${render[@]}"
  "${render[@]}" --stats "$work/$2.json" >"$work/log" 2>&1 # apart: counting takes time
  python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["frame"]["seconds"][0])' "$work/$2.json" >>"$1.frame"
}

echo "$resolution, sigma_t $sigma 1/m; wall clock, processor"
ours "$work/none" reference
for quality in draft medium high; do
  ours "$work/none" "$quality" # compiles
  for ((i = 0; i < runs; ++i)); do
    theirs "$work/$quality.theirs"
    ours "$work/$quality.ours" "$quality"
  done
  rmse=$("$sfumato" compare "$work/$quality.exr" "$work/reference.exr" --fail 1e9 2>/dev/null | awk '/relative RMSE/ { print $3 }')
  echo "$quality: $(median "$work/$quality.ours" 1) s, $(median "$work/$quality.ours" 2) s," \
    "frame $(median "$work/$quality.ours.frame" 1) s; vdb_render: $(median "$work/$quality.theirs" 1) s," \
    "$(median "$work/$quality.theirs" 2) s; relative RMSE $rmse"
done
