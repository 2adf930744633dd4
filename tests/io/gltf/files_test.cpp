// Written glTF as files: pairs of .gltf and .bin, pictures, compression, models that came from other formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"
#include "lodestone/io/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::Json;

class GltfFiles : public test::InFolder {
 protected:
  void put(const char* name, const std::string& bytes) {
    auto file = OutputFile::create(folder_ / name);
    file->write(bytes);
    ASSERT_TRUE(file->commit());
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
  }
  Json written(const Model& model, const WriteOptions& options = {}) {
    const auto report = write_model(model, folder_ / "out.glb", options);
    EXPECT_TRUE(report) << report.error().line();
    if (!report) return {};
    warnings_ = report->warnings;
    return test::open_glb(*read_file(folder_ / "out.glb")).json;
  }
  std::vector<std::string> warnings_;
};

// Each triangle as its corners' positions and attributes, starting at the smallest corner, in sorted order: what a
// codec may reorder but not change.
std::vector<std::vector<double>> content(const Mesh& mesh) {
  std::vector<std::vector<double>> out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::vector<double> corners[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t w = mesh.triangles[t][c];
      const Vec3f p = mesh.positions[mesh.vertex_of(w)];
      corners[c] = {p.x, p.y, p.z};
      std::vector<const AttributeStream*> streams;
      for (const AttributeStream& s : mesh.attributes) streams.push_back(&s);
      std::sort(streams.begin(), streams.end(), [](auto* a, auto* b) { return a->name < b->name; });
      for (const AttributeStream* s : streams) {
        std::visit(
            [&](const auto& values) {
              for (std::size_t k = 0; k < s->components; ++k) {
                corners[c].push_back(static_cast<double>(values[w * s->components + k]));
              }
            },
            s->values);
      }
    }
    std::rotate(corners, std::min_element(corners, corners + 3), corners + 3);
    std::vector<double> all{static_cast<double>(mesh.group_of(t))};
    for (const auto& corner : corners) all.insert(all.end(), corner.begin(), corner.end());
    out.push_back(std::move(all));
  }
  std::sort(out.begin(), out.end());
  return out;
}

// A skinned sheet with all kinds of attributes.
GltfBuilder rich_sheet() {
  GltfBuilder b;
  Json sheet = b.sheet(7, 0);
  std::vector<float> normals, uvs, heat;
  std::vector<std::uint8_t> colors, joints, weights;
  std::vector<std::uint16_t> ids;
  for (int v = 0; v < 64; ++v) {
    normals.insert(normals.end(), {0, 0, 1});
    uvs.insert(uvs.end(), {static_cast<float>(v) / 7, static_cast<float>(v) / 64});
    heat.push_back(static_cast<float>(v * v) * 0.37F);
    colors.insert(colors.end(), {static_cast<std::uint8_t>(v), 7, 9, 255});
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {static_cast<std::uint8_t>(55 + v), static_cast<std::uint8_t>(200 - v), 0, 0});
    ids.push_back(static_cast<std::uint16_t>(v * 900));
  }
  Json& a = sheet["attributes"];
  a["NORMAL"] = b.accessor(normals, "VEC3", 3);
  a["TEXCOORD_0"] = b.accessor(uvs, "VEC2", 2);
  a["_HEAT"] = b.accessor(heat, "SCALAR", 1);
  a["COLOR_0"] = b.accessor(colors, "VEC4", 4, true);
  a["JOINTS_0"] = b.accessor(joints, "VEC4", 4);
  a["WEIGHTS_0"] = b.accessor(weights, "VEC4", 4, true);
  a["_ID"] = b.accessor(ids, "SCALAR", 1, false, 4);
  b.json["meshes"] = {{{"primitives", {sheet, b.sheet(2, 3)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "bone"}}, {{"name", "bone"}}};
  b.json["skins"] = {{{"joints", {1, 2}}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2};
  return b;
}

TEST_F(GltfFiles, compression_loses_nothing) {
  const auto model = read_gltf_bytes(rich_sheet().glb(), "x.glb");
  ASSERT_TRUE(model) << model.error().line();
  Ladder ladder;
  ladder.levels.resize(2);
  ladder.original = *model;
  ladder.levels[1].model = *model;
  Mesh& coarse = ladder.levels[1].model.meshes[0];
  coarse.triangles.resize(60);
  coarse.face_group.resize(60);
  for (const Compression c : {Compression::none, Compression::meshopt, Compression::draco}) {
    WriteOptions options;
    options.compression = c;
    ASSERT_TRUE(write_gltf(ladder, folder_ / "out.glb", options));
    const auto back = read_gltf(folder_ / "out.glb");
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(content(back->meshes.at(0)), content(model->meshes[0]));
    EXPECT_EQ(content(back->meshes.at(1)), content(coarse)) << "groups and all";
    const Json json = test::open_glb(*read_file(folder_ / "out.glb")).json;
    const char* name = c == Compression::meshopt ? "EXT_meshopt_compression" : "KHR_draco_mesh_compression";
    EXPECT_EQ(json.value("extensionsRequired", Json::array()),
              c == Compression::none ? Json::array() : Json::array({name}));
    // And out again: a decoded extension is no longer asked for.
    ASSERT_TRUE(write_model(*back, folder_ / "plain.glb"));
    const Json plain = test::open_glb(*read_file(folder_ / "plain.glb")).json;
    EXPECT_FALSE(plain.contains("extensionsRequired"));
    EXPECT_EQ(plain["buffers"].size(), 1U);
    const auto again = read_gltf(folder_ / "plain.glb");
    ASSERT_TRUE(again) << again.error().line();
    EXPECT_EQ(content(again->meshes[0]), content(model->meshes[0]));
    EXPECT_EQ(content(again->meshes[1]), content(coarse));
  }
}

TEST_F(GltfFiles, a_text_file_comes_with_its_bin_and_both_or_none_appear) {
  const Model model = make_model(test::sphere(8));
  fs::create_directories(folder_ / "a b.bin");
  EXPECT_FALSE(write_model(model, folder_ / "a b.gltf")) << "a folder is in the way of the .bin";
  EXPECT_EQ(names(), std::vector<std::string>{"a b.bin"});
  fs::remove(folder_ / "a b.bin");
  const auto report = write_model(model, folder_ / "a b.gltf");
  ASSERT_TRUE(report) << report.error().line();
  EXPECT_EQ(names(), (std::vector<std::string>{"a b.bin", "a b.gltf"}));
  EXPECT_EQ(report->total_bytes, fs::file_size(folder_ / "a b.bin") + fs::file_size(folder_ / "a b.gltf"));
  const auto back = read_gltf(folder_ / "a b.gltf");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_EQ(content(back->meshes[0]), content(model.meshes[0]));
}

TEST_F(GltfFiles, pictures_beside_the_model_come_along_and_names_are_percent_decoded) {
  const std::string png = "\x89PNG\r\n\x1a\nnot really";
  put("my picture.png", png);
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(2, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["images"] = {{{"uri", "my%20picture.png"}, {"name", "kept"}}};
  b.json["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "x%2Ebin"}}};
  put("x.bin", b.bin);
  put("in.gltf", b.json.dump());
  const auto model = read_gltf(folder_ / "in.gltf");
  ASSERT_TRUE(model) << model.error().line();
  const Json image = written(*model)["images"][0];
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(image["name"], "kept");
  EXPECT_FALSE(image.contains("uri"));
  EXPECT_NE(read_file(folder_ / "out.glb")->find(png), std::string::npos);
}

TEST_F(GltfFiles, offset_and_turned_instances_are_folded_into_the_node) {
  Model model = make_model(test::cube());
  model.meshes[0].offset = {1000, 0, 0};
  model.instances[0].transform = Mat4d::rotation(0, 0, std::sqrt(0.5), std::sqrt(0.5));
  const Box3d box = bounds_of(model);
  const Json node = written(model)["nodes"][0];
  EXPECT_TRUE(node.contains("matrix"));
  const auto back = read_gltf(folder_ / "out.glb");
  ASSERT_TRUE(back);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(bounds_of(*back).min[k], box.min[k], 1e-9);
}

TEST_F(GltfFiles, attributes_of_other_formats_get_legal_names_or_are_told) {
  Mesh mesh = test::cube();
  const auto add = [&](const char* name, Semantic semantic, std::uint32_t components, ComponentType type) {
    mesh.attributes.push_back(make_stream(name, semantic, components, type, false, mesh.wedge_count()));
    return &mesh.attributes.back();
  };
  add("my quality", Semantic::generic, 1, ComponentType::float32);
  add("my-quality", Semantic::generic, 1, ComponentType::float32);
  add("depth", Semantic::generic, 1, ComponentType::float64);
  add("label", Semantic::categorical, 1, ComponentType::int32);
  std::get<std::vector<std::uint32_t>>(add("huge", Semantic::categorical, 1, ComponentType::uint32)->values)[3] = 1U
                                                                                                                  << 24;
  const Json json = written(make_model(mesh));
  const Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  for (const char* name : {"_MY_QUALITY", "_MY_QUALITY_2", "_DEPTH", "_LABEL"})
    EXPECT_TRUE(attributes.contains(name)) << name;
  EXPECT_EQ(attributes.size(), 5U) << "and POSITION";
  EXPECT_EQ(warnings_.size(), 2U) << "the double and the one too large";
  const auto accessor = json["accessors"][attributes["_LABEL"].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5126);
}

TEST_F(GltfFiles, a_textured_material_on_faces_without_uvs_loses_its_texture_there) {
  Model model = make_model(test::with_uv_seam(test::grid(4)));
  auto image = std::make_shared<Image>();
  image->mime = "image/png";
  image->encoded.resize(9);
  Material paint;
  paint.name = "paint";
  paint.base_color_texture = image;
  model.materials = {paint};
  Mesh& mesh = model.meshes[0];
  mesh.groups = {{0, "with"}, {0, "without"}, {0, "without"}};
  mesh.face_group.assign(mesh.triangles.size(), 0);
  mesh.face_group[3] = 1;
  mesh.face_group[4] = 2;
  mesh.attributes[0].present = {1, 0, 0};
  const Json json = written(model);
  const Json& primitives = json["meshes"][0]["primitives"];
  EXPECT_EQ(primitives[0]["material"], 0);
  EXPECT_EQ(primitives[1]["material"], 1);
  EXPECT_EQ(primitives[2]["material"], 1) << "one twin is enough";
  EXPECT_EQ(json["materials"].size(), 2U);
  EXPECT_TRUE(json["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
  EXPECT_FALSE(json["materials"][1]["pbrMetallicRoughness"].contains("baseColorTexture"));
}

}  // namespace
}  // namespace lodestone::io
