// What draws validates what it is given.
#include <gtest/gtest.h>

#include "lodestone/render/render.h"
#include "lodestone/render/scene.h"
#include "tests/support/broken.h"

namespace lodestone::render {
namespace {

TEST(Entries, of_render_refuse_a_broken_model) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    test::expect_refused(Scene::create(model), line, name);
    test::expect_refused(render(model, Camera{}), line, name);
  }
}

}  // namespace
}  // namespace lodestone::render
