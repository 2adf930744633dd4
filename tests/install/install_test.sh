#!/bin/sh
# install_test.sh BUILD_DIR COMPILER [FLAGS…]: the installed tree serves an outside program through find_package and
# through pkg-config, wherever it stands, and holds the command.
set -eu
build=$1
compiler=$2
shift 2
examples=$(cd "$(dirname "$0")/../../examples" && pwd)
example=$examples/measure_levels
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --prefix "$scratch/first" >"$scratch/install.log" || {
  cat "$scratch/install.log"
  exit 1
}
mv "$scratch/first" "$scratch/tree"  # nothing in it may know where it was installed
if grep -rlF --include='*.cmake' --include='*.pc' --include='*.h' -e "$scratch" -e "$build" "$scratch/tree"; then
  echo "the files above name a folder of the build" >&2
  exit 1
fi
pc=$(find "$scratch/tree" -name lodestone.pc)
[ -n "$pc" ] || {
  echo "no lodestone.pc was installed" >&2
  exit 1
}

"$scratch/tree/bin/lod" sample sphere -o "$scratch/sphere.ply" --triangles 5000 --quiet

cmake -S "$example" -B "$scratch/cmake" -DCMAKE_PREFIX_PATH="$scratch/tree" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_CXX_FLAGS="$*" >"$scratch/configure.log"
cmake --build "$scratch/cmake" >"$scratch/build.log" || {
  cat "$scratch/build.log"
  exit 1
}
"$scratch/cmake/measure_levels" "$scratch/sphere.ply" >"$scratch/by_cmake"

PKG_CONFIG_PATH=$(dirname "$pc") && export PKG_CONFIG_PATH
# shellcheck disable=SC2046
"$compiler" "$@" -std=c++20 "$example/main.cpp" $(pkg-config --cflags --libs lodestone) -o "$scratch/by_hand"
"$scratch/by_hand" "$scratch/sphere.ply" >"$scratch/by_pkg_config"

"$compiler" "$@" -std=c++20 "$examples/arrays/main.cpp" $(pkg-config --cflags --libs lodestone) -o "$scratch/arrays"
"$scratch/arrays" >"$scratch/of_arrays" 2>/dev/null
cat "$scratch/of_arrays"
[ "$(wc -l <"$scratch/of_arrays")" -eq 5 ]
[ "$(head -n 1 "$scratch/of_arrays")" = " 10201 vertices,  20000 triangles, at most 0 from the original" ]

cat "$scratch/by_cmake"
cmp "$scratch/by_cmake" "$scratch/by_pkg_config"
[ "$(wc -l <"$scratch/by_cmake")" -eq 5 ]
# Every installed header stands on its own.
find "$scratch/tree/include" -name '*.h' | sort | while read -r header; do
  echo "#include \"${header#"$scratch/tree/include/"}\"" |
    "$compiler" "$@" -std=c++20 -fsyntax-only -x c++ -I"$scratch/tree/include" - || {
    echo "$header does not compile on its own" >&2
    exit 1
  }
done
