#!/bin/sh
# lod_alone_test.sh BUILD_DIR NINJA: `cmake --install` serves those who have built the target lod and nothing else, as
# `make demo` does. Nothing is compiled: a copy of the build folder gets what building that target makes.
set -eu
build=$1
ninja=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

take() { # names in the build folder, one a line
  sort -u | while read -r name; do
    name=${name#"$build/"}
    case $name in /* | *..*) continue ;; esac
    [ -f "$build/$name" ] || continue
    mkdir -p "$scratch/build/$(dirname "$name")"
    cp "$build/$name" "$scratch/build/$name"
  done
}
"$ninja" -C "$build" -t commands lod | tr ' ' '\n' | take
(cd "$build" && find . -name cmake_install.cmake -o -name '*.pc' -o -name 'lodestone-*.cmake' -o -name CMakeCache.txt) | take
find "$scratch/build" -name '*.cmake' -exec sed -i "s|$build|$scratch/build|g" {} +

cmake --install "$scratch/build" --prefix "$scratch/tree" >"$scratch/install.log" 2>&1 || {
  tail -n 5 "$scratch/install.log"
  exit 1
}
for file in /bin/lod /man1/lod.1 /completions/lod /lodestone-config.cmake /lodestone-targets.cmake /lodestone.pc /core/mesh.h; do
  find "$scratch/tree" -path "*$file" | grep -q . || {
    echo "no $file was installed" >&2
    exit 1
  }
done
"$scratch/tree/bin/lod" help >/dev/null
