#include "lodestone/io/gltf/read.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "lodestone/base/file.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/gltf/write.h"
#include "lodestone/io/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;

class Gltf : public test::InFolder {};

std::string base64(const std::string& bytes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string out;
  for (const T v : values) out.append(reinterpret_cast<const char*>(&v), sizeof(T));
  return out;
}

// Two triangles in a unit square: four positions (48 bytes), then six 16-bit indices (12 bytes).
std::string square_bytes() {
  return raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw<std::uint16_t>({0, 1, 2, 0, 2, 3});
}

std::string square_json(const std::string& primitive_extra = "", const std::string& root_extra = "",
                        const std::string& nodes = R"([{"mesh":0}])") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1)" + primitive_extra +
         R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)" +
         R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],)" +
         R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],)" +
         R"("buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)" + base64(square_bytes()) +
         "\"}]" + root_extra + "}";
}

TEST_F(Gltf, data_uris_transforms_and_units) {
  const auto model =
      read_gltf_bytes(square_json("", "", R"([{"mesh":0,"translation":[5,0,0],"scale":[2,2,2]}])"), "x.gltf");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(drawn_triangles(*model), 2U);
  EXPECT_EQ(model->meters_per_unit, 1);
  EXPECT_TRUE(model->uv_origin_top);
  const Box3d box = bounds_of(*model);
  EXPECT_EQ(box.min, (Vec3d{5, 0, 0}));
  EXPECT_EQ(box.max, (Vec3d{7, 2, 0}));
}

TEST_F(Gltf, strips_and_fans) {
  const auto fan = read_gltf_bytes(square_json(R"(,"mode":6)"), "x.gltf");
  ASSERT_TRUE(fan) << fan.error().line();
  const auto strip = read_gltf_bytes(square_json(R"(,"mode":5)"), "x.gltf");
  ASSERT_TRUE(strip) << strip.error().line();
  EXPECT_EQ(strip->meshes[0].triangles.size(), 3U) << "the one with a repeated vertex only stitches: left out";
  EXPECT_FALSE(read_gltf_bytes(square_json(R"(,"mode":1)"), "x.gltf")) << "lines alone are no triangles";
}

TEST_F(Gltf, sparse_accessors) {
  std::string json = square_json();
  const std::string extra =
      R"(,"sparse":{"count":1,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":3}})";
  json.insert(json.find(R"("count":4)") + 9, extra);
  const std::string more = raw<std::uint8_t>({2, 0, 0, 0}) + raw<float>({1, 1, 9});
  const std::size_t views = json.find(R"("bufferViews":[)") + 15;
  json.insert(
      views,
      R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12},{"buffer":1,"byteLength":1},{"buffer":1,"byteOffset":4,"byteLength":12},)");
  json.insert(json.find(R"("buffers":[)") + 11 +
                  std::string(R"({"byteLength":60,"uri":"data:application/octet-stream;base64,)").size() +
                  base64(square_bytes()).size() + 2,
              R"(,{"byteLength":16,"uri":"data:;base64,)" + base64(more) + "\"}");
  const auto model = read_gltf_bytes(json, "x.gltf");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(bounds_of(*model).max.z, 9);
}

TEST_F(Gltf, hostile_names_and_graphs_are_refused) {
  for (const char* uri :
       {"../secret.bin", "/etc/passwd", "http://example.org/a.bin", "%2e%2e/x.bin", "a/../../x.bin"}) {
    std::string json = square_json();
    const std::size_t at = json.find("data:application");
    json.replace(at, json.find('"', at) - at, uri);
    const fs::path file = folder_ / "x.gltf";
    auto out = OutputFile::create(file);
    out->write(json);
    ASSERT_TRUE(out->commit());
    const auto model = read_gltf(file);
    ASSERT_FALSE(model) << uri;
    EXPECT_NE(model.error().line().find("x.gltf"), std::string::npos) << model.error().line();
  }
  EXPECT_FALSE(read_gltf_bytes(square_json("", "", R"([{"mesh":0,"children":[0]}])"), "x.gltf")) << "a cycle";
  EXPECT_FALSE(read_gltf_bytes(square_json("", "", R"([{"mesh":7}])"), "x.gltf"));
}

// A model with everything: used for round trips.
Ladder textured_ladder() {
  Model model = make_model(test::with_uv_seam(test::grid(8, 0.1F)));
  model.meshes[0].name = "sheet";
  model.meshes[0].groups = {{0, "part"}};
  Material material;
  material.name = "paint";
  material.base_color = {0.5F, 0.25F, 1, 1};
  model.materials.push_back(material);
  Ladder ladder;
  ladder.original = model;
  ladder.levels.resize(2);
  ladder.levels[1].model = model;
  ladder.levels[1].model.meshes[0].triangles.resize(40);
  return ladder;
}

TEST_F(Gltf, a_ladder_reads_back_as_its_original_with_any_compression) {
  const Ladder ladder = textured_ladder();
  for (const Compression c : {Compression::none, Compression::meshopt, Compression::draco}) {
    WriteOptions options;
    options.compression = c;
    options.screen_coverage = {{0.5, 0}};
    const auto report = write_gltf(ladder, folder_ / "l.glb", options);
    ASSERT_TRUE(report) << report.error().line();
    EXPECT_EQ(report->level_bytes.size(), 2U);
    EXPECT_EQ(report->level_bytes[0] + report->level_bytes[1], fs::file_size(folder_ / "l.glb"));
    const auto back = read_gltf(folder_ / "l.glb");
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(drawn_triangles(*back), 128U) << "only level 0 is in the scene";
    EXPECT_EQ(back->meshes.size(), 2U);
    EXPECT_EQ(back->meshes[1].triangles.size(), 40U);
    EXPECT_EQ(back->materials.at(0).name, "paint");
    EXPECT_EQ(back->meshes[0].vertex_count(), 81U);
    EXPECT_EQ(back->meshes[0].wedge_count(), ladder.original.meshes[0].wedge_count()) << "the seam survives";
    EXPECT_NEAR(area_of(back->meshes[0]), area_of(ladder.original.meshes[0]), 1e-6);
    const auto text = read_file(folder_ / "l.glb");
    EXPECT_NE(text->find("MSFT_lod"), std::string::npos);
    EXPECT_NE(text->find("MSFT_screencoverage"), std::string::npos);
  }
}

TEST_F(Gltf, what_is_not_understood_comes_out_as_it_went_in) {
  const std::string json = square_json(
      R"(,"extras":{"note":[1,2]})",
      R"(,"extensionsUsed":["ACME_thing"],"extensions":{"ACME_thing":{"deep":{"er":true}}},"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])",
      R"([{"mesh":0,"name":"root","children":[1],"extras":{"id":7}},{"camera":0,"name":"eye"}])");
  const auto model = read_gltf_bytes(json, "x.gltf");
  ASSERT_TRUE(model) << model.error().line();
  Ladder ladder;
  ladder.original = *model;
  ladder.levels.resize(2);
  ladder.levels[1].model = *model;
  const auto report = write_gltf(ladder, folder_ / "x.gltf");
  ASSERT_TRUE(report) << report.error().line();
  const auto text = read_file(folder_ / "x.gltf");
  for (const char* kept : {"ACME_thing", "\"er\": true", "\"note\"", "\"yfov\"", "\"id\": 7", "\"eye\""}) {
    EXPECT_NE(text->find(kept), std::string::npos) << kept;
  }
  EXPECT_NE(text->find("root_mesh"), std::string::npos) << "a node with children hands its mesh to a leaf";
  const auto back = read_gltf(folder_ / "x.gltf");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_EQ(drawn_triangles(*back), 2U);
}

TEST_F(Gltf, writing_twice_gives_the_same_bytes) {
  const Ladder ladder = textured_ladder();
  ASSERT_TRUE(write_gltf(ladder, folder_ / "a.glb"));
  ASSERT_TRUE(write_gltf(ladder, folder_ / "b.glb"));
  EXPECT_EQ(*read_file(folder_ / "a.glb"), *read_file(folder_ / "b.glb"));
}

TEST_F(Gltf, damaged_files_give_a_model_or_an_error) {
  ASSERT_TRUE(write_gltf(textured_ladder(), folder_ / "a.glb"));
  const std::string whole = *read_file(folder_ / "a.glb");
  for (std::size_t n = 0; n < whole.size(); n += n < 64 ? 1 : 97) {
    EXPECT_FALSE(read_gltf_bytes(whole.substr(0, n), "cut.glb")) << n;
  }
  for (std::size_t i = 0; i < whole.size(); i += 13) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    const auto model = read_gltf_bytes(damaged, "damaged.glb");
    EXPECT_TRUE(!model || validate(*model)) << i;
  }
}

TEST_F(Gltf, an_offset_becomes_a_translation) {
  Mesh mesh = test::cube();
  mesh.offset = {1e6, 2e6, 3e6};
  ASSERT_TRUE(write_model(make_model(mesh), folder_ / "far.glb"));
  const auto back = read_gltf(folder_ / "far.glb");
  ASSERT_TRUE(back);
  EXPECT_EQ(bounds_of(*back).min, (Vec3d{1e6, 2e6, 3e6}));
  EXPECT_EQ(bounds_of(*back).max, (Vec3d{1e6 + 1, 2e6 + 1, 3e6 + 1}));
}

}  // namespace
}  // namespace lodestone::io
