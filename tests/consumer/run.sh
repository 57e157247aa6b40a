#!/usr/bin/env bash
# Installs a build into an empty folder, builds a project against it that sees nothing else, and runs that and
# the installed program from another empty folder. Usage: run.sh BUILD EXAMPLE.cpp LAUNCHER...
set -euo pipefail
build=$1 example=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(mktemp -d --suffix=.sfumato)
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/installed" >/dev/null
cp "$here/CMakeLists.txt" "$example" "$folder"
cmake -S "$folder" -B "$folder/build" -G Ninja -DEXAMPLE="$(basename "$example")" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$folder/installed" "${@:3}" >/dev/null
cmake --build "$folder/build"

mkdir "$folder/empty"
cd "$folder/empty"
"$folder/build/consumer" picture.png
"$folder/installed/bin/sfumato" --version
"$folder/installed/bin/sfumato" render --volume plume.vdb --res 96x64 --quality draft -o program.exr -o program.png
"$folder/installed/bin/sfumato" compare program.png picture.png
[[ $(ls) == $'picture.png\nplume.vdb\nprogram.exr\nprogram.png' ]]
