// Names of one's own attributes that glTF does not allow get others, the same in all primitives and levels, and no two
// attributes fall together.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/draco_detail.h"
#include "lodestone/io/gltf/meshopt_detail.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"
#include "support/folder.h"

namespace lodestone::io {
namespace {

using test::GltfBuilder;
using test::Json;

class GltfNames : public test::InFolder {
 protected:
  // The file of the model and a level of half its triangles.
  Json written(const GltfBuilder& b, Compression compression = Compression::none) {
    Result<Model> model = read_gltf_bytes(b.glb(), "made.glb");
    EXPECT_TRUE(model) << model.error().line();
    if (!model) return {};
    Ladder ladder;
    ladder.original = *model;
    ladder.levels.resize(2);
    ladder.levels[1].model = std::move(*model);
    for (Mesh& mesh : ladder.levels[1].model.meshes) {
      mesh.triangles.resize(mesh.triangles.size() / 2);
      if (!mesh.face_group.empty()) mesh.face_group.resize(mesh.triangles.size());
    }
    WriteOptions options;
    options.compression = compression;
    const auto report = write_gltf(ladder, folder_ / "out.glb", options);
    EXPECT_TRUE(report) << report.error().line();
    if (!report) return {};
    warnings_ = report->warnings;
    return test::open_glb(*read_file(folder_ / "out.glb")).json;
  }
  // The values of attribute `name` in `level` of the file written last; they are all the same. -1 without it.
  float value_of(const std::string& name, std::size_t level) const {
    ReadOptions options;
    options.draw_level = level;
    const Result<Model> model = read_gltf(folder_ / "out.glb", options);
    EXPECT_TRUE(model) << model.error().line();
    if (!model) return -1;
    for (const AttributeStream& stream : model->meshes[model->instances[0].mesh].attributes) {
      if (stream.name == name) return std::get<std::vector<float>>(stream.values)[0];
    }
    return -1;
  }
  std::vector<std::string> warnings_;
};

std::size_t scalar(GltfBuilder& b, float value) { return b.accessor(std::vector<float>(25, value), "SCALAR", 1); }

GltfBuilder two_names() {
  GltfBuilder b;
  Json sheet = b.sheet(4, 0);
  sheet["attributes"]["FOO"] = scalar(b, 0.25F);
  sheet["attributes"]["_FOO"] = scalar(b, 0.75F);
  b.json["meshes"] = {{{"primitives", {sheet}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

TEST_F(GltfNames, an_attribute_keeps_its_values_beside_one_that_has_its_name_already) {
  std::vector<Compression> all{Compression::none};
  if (has_meshopt()) all.push_back(Compression::meshopt);
  if (has_draco()) all.push_back(Compression::draco);
  for (const Compression compression : all) {
    written(two_names(), compression);
    EXPECT_EQ(warnings_, (std::vector<std::string>{"attribute 'FOO' needs an underscore in glTF: named '__FOO'"}));
    for (std::size_t level = 0; level < 2; ++level) {
      EXPECT_NEAR(value_of("__FOO", level), 0.25, 1e-3);
      EXPECT_NEAR(value_of("_FOO", level), 0.75, 1e-3);
    }
  }
}

TEST_F(GltfNames, all_primitives_and_morph_targets_of_a_mesh_agree_on_a_name_at_every_level) {
  GltfBuilder b;
  Json first = b.sheet(4, 0), second = b.sheet(4, 1);
  first["attributes"]["FOO"] = scalar(b, 0.25F);
  second["attributes"]["_FOO"] = scalar(b, 0.75F);
  for (Json* primitive : {&first, &second}) {
    (*primitive)["targets"] = {{{"POSITION", b.positions(std::vector<float>(75, 0.5F))}, {"FOO", scalar(b, 0.5F)}}};
  }
  Json points = first;
  points["mode"] = 0;
  points.erase("indices");
  b.json["meshes"] = {{{"primitives", {first, points, second}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  const Json json = written(b);
  ASSERT_EQ(json["meshes"].size(), 2U);
  for (const Json& mesh : json["meshes"]) {
    ASSERT_GE(mesh["primitives"].size(), 2U);
    for (const Json& primitive : mesh["primitives"]) {
      EXPECT_FALSE(primitive["attributes"].contains("FOO"));
      EXPECT_NE(primitive["attributes"].contains("__FOO"), primitive["attributes"].contains("_FOO"));
      EXPECT_TRUE(primitive["targets"][0].contains("__FOO")) << primitive;
      EXPECT_EQ(primitive["targets"][0].size(), 2U);
    }
  }
}

TEST_F(GltfNames, a_stream_that_the_document_does_not_know_gets_a_name_too) {
  Result<Model> model = read_gltf_bytes(two_names().glb(), "made.glb");
  ASSERT_TRUE(model) << model.error().line();
  AttributeStream added = model->meshes[0].attributes[0];
  added.name = "ORIGIN";
  std::get<std::vector<float>>(added.values).assign(model->meshes[0].wedge_count(), 0.5F);
  model->meshes[0].attributes.push_back(added);
  ASSERT_TRUE(write_gltf(*model, folder_ / "out.glb"));
  EXPECT_EQ(value_of("_ORIGIN", 0), 0.5F);
  EXPECT_EQ(value_of("__FOO", 0), 0.25F);
  EXPECT_EQ(value_of("_FOO", 0), 0.75F);
}

}  // namespace
}  // namespace lodestone::io
