// Makes four levels of a model and prints how far each one is from the original.
#include <cstdio>
#include <utility>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/io/read.h"

int main(int argc, char** argv) {
  auto model = lodestone::io::read_model(argc > 1 ? argv[1] : "");
  if (!model) return std::fprintf(stderr, "%s\n", model.error().line().c_str()), 1;
  auto result = lodestone::chain::build_ladder(std::move(*model));
  if (!result) return std::fprintf(stderr, "%s\n", result.error().line().c_str()), 1;
  for (const lodestone::Level& level : result->ladder.levels)
    std::printf("%9zu triangles, at most %g from the original\n", level.triangles, level.error.error);
  return 0;
}
