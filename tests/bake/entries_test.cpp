// What bakes validates what it is given.
#include <gtest/gtest.h>

#include <string>

#include "lodestone/bake/atlas.h"
#include "lodestone/bake/bake.h"
#include "lodestone/bake/transfer.h"
#include "tests/support/broken.h"

namespace lodestone::bake {
namespace {

TEST(Entries, of_bake_refuse_what_is_broken) {
  const Model whole = test::whole_model();
  const Result<BakeSource> source = BakeSource::create(whole);
  ASSERT_TRUE(source);
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    test::expect_refused(BakeSource::create(model), line, name);
    if (!mesh) continue;
    const std::string told = "box" + line.substr(line.find(')') + 1);
    test::expect_refused(make_atlas(model.meshes[0]), told, name);
    test::expect_refused(transfer_attributes(model.meshes[0], *source), told, name);
    test::expect_refused(bake_textures(model.meshes[0], *source), told, name);
  }
}

}  // namespace
}  // namespace lodestone::bake
