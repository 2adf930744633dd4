// What simplifies validates what it is given.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/simplify/prune/prune_order.h"
#include "tests/support/broken.h"

namespace lodestone::simplify {
namespace {

TEST(Entries, of_simplify_refuse_a_broken_mesh) {
  EdgeCollapseOptions options;
  options.target_triangles = 4;
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    if (!mesh) continue;
    const std::string told = "box" + line.substr(line.find(')') + 1);
    test::expect_refused(collapse_edges(model.meshes[0], options), told, name);
    test::expect_refused(prune_order(model.meshes[0]), told, name);
  }
}

TEST(Entries, of_simplify_refuse_options_that_do_not_fit_the_mesh) {
  const Mesh mesh = test::whole_model().meshes[0];
  EdgeCollapseOptions options;
  options.target_triangles = 4;
  options.metric.m[0] = NAN;
  test::expect_bad_argument(collapse_edges(mesh, options), "metric");
  PruneOptions thin;
  thin.left_out = {12};
  test::expect_refused(prune_order(mesh, thin), "thin parts: triangle 12 of 12 is to be left out", "left out");
}

}  // namespace
}  // namespace lodestone::simplify
