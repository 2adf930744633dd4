// What written ladders keep of the glTF that they came from: attributes by primitive, types, nodes, animations.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using test::GlbContent;
using test::GltfBuilder;
using test::Json;

class GltfLevels : public test::InFolder {
 protected:
  static Model read(const GltfBuilder& b) {
    Result<Model> model = read_gltf_bytes(b.glb(), "made.glb");
    EXPECT_TRUE(model) << model.error().line();
    return model ? std::move(*model) : Model{};
  }
  // One coarser level that keeps the first `keep` triangles of each group.
  static Ladder halved(Model model, std::size_t keep) {
    Ladder ladder;
    ladder.levels.resize(2);
    ladder.original = model;
    ladder.levels[1].model = std::move(model);
    for (Mesh& mesh : ladder.levels[1].model.meshes) {
      std::vector<Triangle> triangles;
      std::vector<std::uint32_t> groups, taken(mesh.groups.size() + 1, 0);
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (taken[mesh.group_of(t)]++ >= keep) continue;
        triangles.push_back(mesh.triangles[t]);
        groups.push_back(mesh.group_of(t));
      }
      mesh.triangles = std::move(triangles);
      mesh.face_group = std::move(groups);
    }
    return ladder;
  }
  GlbContent written(const Ladder& ladder, const WriteOptions& options = {}) {
    const auto report = write_gltf(ladder, folder_ / "out.glb", options);
    EXPECT_TRUE(report) << report.error().line();
    if (!report) return {};
    report_ = *report;
    return test::open_glb(*read_file(folder_ / "out.glb"));
  }
  static const Json& level_mesh(const Json& json, std::size_t node, std::size_t level) {
    const std::size_t id = json["nodes"][node]["extensions"]["MSFT_lod"]["ids"][level - 1].get<std::size_t>();
    return json["meshes"][json["nodes"][id]["mesh"].get<std::size_t>()];
  }
  WriteReport report_;
};

// Two sheets with different attributes and types, and a line between them.
GltfBuilder two_kinds() {
  GltfBuilder b;
  Json first = b.sheet(3, 0), second = b.sheet(3, 1);
  std::vector<std::uint16_t> uvs;
  std::vector<float> normals;
  std::vector<std::uint8_t> colors;
  for (int i = 0; i < 16; ++i) {
    uvs.insert(uvs.end(), {static_cast<std::uint16_t>(i * 4000), static_cast<std::uint16_t>(60000 - i * 1000)});
    normals.insert(normals.end(), {0, 0, 1});
    colors.insert(colors.end(), {static_cast<std::uint8_t>(i * 10), 20, 30, 255});
  }
  first["attributes"]["NORMAL"] = b.accessor(normals, "VEC3", 3);
  first["attributes"]["TEXCOORD_0"] = b.accessor(uvs, "VEC2", 2, true);
  second["attributes"]["COLOR_0"] = b.accessor(colors, "VEC4", 4, true);
  second["extras"] = {{"kept", true}};
  Json line = {{"mode", 1}, {"attributes", {{"POSITION", b.positions<float>({0, 0, 0, 1, 1, 1})}}}};
  b.json["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  first["material"] = 1;
  b.json["meshes"] = {{{"name", "pair"}, {"extras", 5}, {"primitives", {first, line, second}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

TEST_F(GltfLevels, each_primitive_keeps_its_own_attributes_and_their_types) {
  const Model model = read(two_kinds());
  ASSERT_EQ(model.meshes.at(0).groups.size(), 2U);
  ASSERT_EQ(model.meshes[0].triangles.size(), 36U);
  for (std::size_t t = 0; t < 36; ++t) EXPECT_EQ(model.meshes[0].group_of(t), t / 18);
  const GlbContent out = written(halved(model, 4));
  const Json& mesh = level_mesh(out.json, 0, 1);
  EXPECT_EQ(mesh["extras"], 5);
  const Json& primitives = mesh["primitives"];
  ASSERT_EQ(primitives.size(), 3U);
  EXPECT_EQ(primitives[1]["mode"], 1) << "lines stay";
  EXPECT_EQ(primitives[0]["material"], 1);
  EXPECT_EQ(primitives[2]["extras"]["kept"], true);
  const auto type = [&](const Json& p, const char* name) {
    const Json& a = out.json["accessors"][p["attributes"][name].get<std::size_t>()];
    return std::pair(a["componentType"].get<int>(), a.value("normalized", false));
  };
  EXPECT_EQ(primitives[0]["attributes"].size(), 3U);
  EXPECT_EQ(type(primitives[0], "TEXCOORD_0"), std::pair(5123, true));
  EXPECT_EQ(type(primitives[0], "NORMAL"), std::pair(5126, false));
  EXPECT_EQ(primitives[2]["attributes"].size(), 2U);
  EXPECT_EQ(type(primitives[2], "COLOR_0"), std::pair(5121, true));
  const auto colors = test::stored_values(out, primitives[2]["attributes"]["COLOR_0"].get<std::size_t>(), 4);
  EXPECT_EQ(colors[1], 20);
  EXPECT_EQ(out.json["meshes"][0], test::open_glb(two_kinds().glb()).json["meshes"][0]) << "level 0 is as it was";
}

TEST_F(GltfLevels, a_primitive_without_triangles_is_left_out_and_a_mesh_without_any_is_no_mesh) {
  Ladder ladder = halved(read(two_kinds()), 4);
  Mesh& mesh = ladder.levels[1].model.meshes[0];
  for (std::uint32_t& g : mesh.face_group) g = 0;
  EXPECT_EQ(level_mesh(written(ladder).json, 0, 1)["primitives"].size(), 2U);

  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(2, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 2, 3}}}};
  ladder = halved(read(b), 0);
  const Json json = written(ladder).json;
  EXPECT_EQ(json["nodes"].size(), 2U);
  EXPECT_FALSE(json["nodes"][1].contains("mesh"));
}

TEST_F(GltfLevels, a_level_in_a_file_of_its_own_may_have_lost_a_mesh) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(2, 0)}}}, {{"primitives", {b.sheet(2, 5)}}, {"weights", {0.5}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 1}}};
  Ladder level;
  level.original = read(b);
  level.levels.resize(1);
  level.original.meshes[1].triangles.clear();
  level.original.meshes[1].face_group.clear();
  const Json json = written(level).json;
  EXPECT_FALSE(json["nodes"][1].contains("mesh"));
  const auto back = read_gltf(folder_ / "out.glb");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_EQ(drawn_triangles(*back), 8U);
}

TEST_F(GltfLevels, quantized_positions_keep_their_integers_where_these_are_exact) {
  for (const bool moved : {false, true}) {
    GltfBuilder b;
    const std::size_t p = b.positions<std::int16_t>({-32767, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, -20000, 0}, true);
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", b.indices({0, 1, 2, 0, 3, 1})}}}}}};
    b.json["nodes"] = {{{"mesh", 0}, {"scale", {10, 10, 10}}}};
    Ladder ladder = halved(read(b), 1);
    if (moved) ladder.levels[1].model.meshes[0].positions[1].x = 0.123456F;
    const GlbContent out = written(ladder);
    const std::size_t at = level_mesh(out.json, 0, 1)["primitives"][0]["attributes"]["POSITION"].get<std::size_t>();
    const Json& accessor = out.json["accessors"][at];
    EXPECT_EQ(accessor["componentType"], moved ? 5126 : 5122);
    EXPECT_EQ(accessor.value("normalized", false), !moved);
    if (!moved) {
      EXPECT_EQ(accessor["max"], Json({32767, 32767, 0})) << "bounds are the stored integers";
    }
    const auto back = read_gltf(folder_ / "out.glb");
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(back->meshes[1].positions, [&] {
      auto used = ladder.levels[1].model.meshes[0].positions;
      used.resize(3);
      return used;
    }()) << "nothing is rounded";
  }
}

TEST_F(GltfLevels, eight_influences_sum_to_one_over_both_sets_as_stored) {
  GltfBuilder b;
  Json sheet = b.sheet(4, 0);
  std::vector<std::uint8_t> joints[2], weights[2];
  for (int v = 0; v < 25; ++v) {
    int left = 255;
    for (int k = 0; k < 8; ++k) {
      const int w = k == 7 ? left : 31 + (v + k) % 2;
      left -= w;
      joints[k / 4].push_back(static_cast<std::uint8_t>(k));
      weights[k / 4].push_back(static_cast<std::uint8_t>(w));
    }
  }
  for (const int set : {0, 1}) {
    sheet["attributes"]["JOINTS_" + std::to_string(set)] = b.accessor(joints[set], "VEC4", 4);
    sheet["attributes"]["WEIGHTS_" + std::to_string(set)] = b.accessor(weights[set], "VEC4", 4, true);
  }
  b.json["meshes"] = {{{"primitives", {sheet}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
  Json list = Json::array();
  for (std::size_t j = 1; j <= 8; ++j) {
    b.json["nodes"].push_back({{"name", "joint"}});
    list.push_back(j);
  }
  b.json["skins"] = {{{"joints", list}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  Ladder ladder = halved(read(b), 9);
  // As after blending: none of the weights is a multiple of 1/255.
  for (AttributeStream& s : ladder.levels[1].model.meshes[0].attributes) {
    if (s.semantic != Semantic::weights) continue;
    auto& values = std::get<std::vector<float>>(s.values);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.125F + (i % 2 == 0 ? 0.0004F : -0.0004F);
  }
  const GlbContent out = written(ladder);
  const Json& attributes = level_mesh(out.json, 0, 1)["primitives"][0]["attributes"];
  const auto w0 = test::stored_values(out, attributes["WEIGHTS_0"].get<std::size_t>(), 4);
  const auto w1 = test::stored_values(out, attributes["WEIGHTS_1"].get<std::size_t>(), 4);
  for (std::size_t i = 0; i < w0.size(); i += 4) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += w0[i + k] + w1[i + k];
    EXPECT_EQ(sum, 255) << "vertex " << i / 4;
  }
  EXPECT_EQ(out.json["nodes"][0]["skin"], 0);
  EXPECT_EQ(out.json["nodes"].back()["skin"], 0) << "levels are skinned, too";
}

// A parent with a mesh and a child; an animated node; a joint with a mesh; a plain node. All draw the same mesh.
GltfBuilder busy_nodes() {
  GltfBuilder b;
  Json sheet = b.sheet(3, 0);
  std::vector<float> delta(16 * 3, 0.5F);
  sheet["targets"] = {{{"POSITION", b.positions(delta)}}};
  b.json["meshes"] = {{{"primitives", {sheet}}, {"weights", {0.25}}}};
  b.json["nodes"] = {
      {{"mesh", 0}, {"name", "parent"}, {"children", {1}}, {"translation", {1, 0, 0}}, {"weights", {0.5}}},
      {{"mesh", 0}, {"name", "animated"}, {"translation", {2, 0, 0}}},
      {{"mesh", 0}, {"name", "joint"}},
      {{"mesh", 0}, {"name", "plain"}, {"scale", {2, 2, 2}}},
      {{"mesh", 0}, {"name", "pointed"}}};
  b.json["scenes"][0]["nodes"] = {0, 2, 3, 4};
  b.json["skins"] = {{{"joints", {2}}}};
  const std::size_t times = b.accessor<float>({0, 1}, "SCALAR", 1);
  b.json["accessors"][times]["min"] = {0};
  b.json["accessors"][times]["max"] = {1};
  const std::size_t moves = b.accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3", 3);
  const std::size_t weights = b.accessor<float>({0, 1}, "SCALAR", 1);
  const Json pointer = {{"path", "pointer"},
                        {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/4/translation"}}}}}};
  b.json["extensionsUsed"] = {"KHR_animation_pointer"};
  b.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", moves}}, {{"input", times}, {"output", weights}}}},
       {"channels",
        {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
         {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}},
         {{"sampler", 1}, {"target", {{"node", 3}, {"path", "weights"}}}},
         {{"sampler", 0}, {"target", pointer}}}}}};
  return b;
}

// Where the corners of what a level draws lie in the world.
std::vector<Vec3d> drawn_corners(const Model& model) {
  std::vector<Vec3d> out;
  for (const Instance& instance : model.instances) {
    const Mesh& mesh = model.meshes[instance.mesh];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.vertices_of(t)) out.push_back(instance.transform.point(mesh.position(v)));
    }
  }
  return out;
}

TEST_F(GltfLevels, levels_with_an_offset_of_their_own_lie_where_they_should) {
  Mesh original = lodestone::test::cube();
  original.offset = {1000, 2000, -3000};
  Mesh coarse = lodestone::test::tetrahedron();
  coarse.offset = {1000.5, 2000.25, -3000};
  Ladder ladder;
  ladder.levels.resize(2);
  ladder.original = make_model(original);
  ladder.levels[1].model = make_model(coarse);
  Mat4d shear = Mat4d::translation({5, 6, 7}) * Mat4d::scale({2, 1, 4}), flat = shear;
  shear.m[4] = 0.5;
  flat.m[10] = 0;
  const Mat4d both[][2] = {{{}, {}},
                           {Mat4d::translation({5, 6, 7}) * Mat4d::scale({2, 2, 2}), Mat4d::scale({2, 2, 2})},
                           {shear, shear},
                           {shear, Mat4d::scale({4, 4, 4})},
                           {flat, flat}};
  for (const auto& [placing, level_placing] : both) {
    ladder.original.instances[0].transform = placing;
    ladder.levels[1].model.instances[0].transform = level_placing;
    for (const char* name : {"out.glb", "out.gltf"}) {
      ASSERT_TRUE(write_gltf(ladder, folder_ / name, {}));
      for (std::size_t level = 0; level < 2; ++level) {
        ReadOptions options;
        options.draw_level = level;
        const auto back = read_gltf(folder_ / name, options);
        ASSERT_TRUE(back) << back.error().line();
        EXPECT_EQ(drawn_corners(*back), drawn_corners(ladder.model(level))) << name << " level " << level;
      }
    }
  }
  ladder.levels[1].model.instances[0].transform = shear;
  EXPECT_FALSE(write_gltf(ladder, folder_ / "out.glb", {})) << "a flattened node cannot hold what is not flat";
}

TEST_F(GltfLevels, levels_of_a_document_must_be_placed_as_the_original_is) {
  Ladder ladder = halved(read(two_kinds()), 4);
  ladder.levels[1].model.meshes[0].offset = {1, 0, 0};
  EXPECT_FALSE(write_gltf(ladder, folder_ / "out.glb", {}));
  ladder.levels[1].model.meshes[0].offset = {};
  EXPECT_TRUE(write_gltf(ladder, folder_ / "out.glb", {}));
  ladder.levels[1].model.instances.clear();
  EXPECT_FALSE(write_gltf(ladder, folder_ / "out.glb", {}));
}

TEST_F(GltfLevels, busy_nodes_hand_their_mesh_to_a_leaf) {
  const GltfBuilder b = busy_nodes();
  const Model model = read(b);
  ASSERT_EQ(model.instances.size(), 5U);
  WriteOptions options;
  options.screen_coverage.assign(5, {0.5, 0});
  const Json json = written(halved(model, 5), options).json;
  for (const std::size_t n : {0U, 1U, 2U, 4U}) {
    const Json& node = json["nodes"][n];
    EXPECT_FALSE(node.contains("mesh")) << n;
    EXPECT_FALSE(node.contains("extensions")) << n;
    EXPECT_EQ(node["name"], b.json["nodes"][n]["name"]);
    const Json& leaf = json["nodes"][node["children"].back().get<std::size_t>()];
    EXPECT_EQ(leaf["mesh"], 0) << n;
    EXPECT_EQ(leaf["extras"]["MSFT_screencoverage"], Json({0.5, 0.0}));
    for (const char* key : {"translation", "matrix", "scale", "rotation"}) EXPECT_FALSE(leaf.contains(key));
    const Json& level = json["nodes"][leaf["extensions"]["MSFT_lod"]["ids"][0].get<std::size_t>()];
    EXPECT_FALSE(level.contains("translation")) << "the leaf's transform is identity, and so is its level's";
  }
  const Json& plain = json["nodes"][3];
  EXPECT_EQ(plain["mesh"], 0);
  const Json& level = json["nodes"][plain["extensions"]["MSFT_lod"]["ids"][0].get<std::size_t>()];
  EXPECT_EQ(level["scale"], Json({2, 2, 2}));
  EXPECT_EQ(json["meshes"].size(), 2U) << "nodes that draw the same mesh share its levels";
  EXPECT_EQ(json["scenes"], b.json["scenes"]) << "coarser nodes are outside the scene";
  const auto back = read_gltf(folder_ / "out.glb");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_EQ(drawn_triangles(*back), drawn_triangles(model));
  EXPECT_EQ(bounds_of(*back).max, bounds_of(model).max);
}

TEST_F(GltfLevels, weight_animations_follow_the_mesh_and_are_repeated_for_levels) {
  const Json json = written(halved(read(busy_nodes()), 5)).json;
  std::vector<std::size_t> morphed;
  for (const Json& channel : json["animations"][0]["channels"]) {
    if (channel["target"]["path"] == "weights") morphed.push_back(channel["target"]["node"].get<std::size_t>());
  }
  ASSERT_EQ(morphed.size(), 4U);
  for (const std::size_t n : morphed) {
    const Json& mesh = json["meshes"][json["nodes"][n]["mesh"].get<std::size_t>()];
    EXPECT_EQ(mesh["primitives"][0]["targets"].size(), 1U);
  }
  const Json& leaf = json["nodes"][json["nodes"][0]["children"].back().get<std::size_t>()];
  EXPECT_EQ(leaf["weights"], Json({0.5}));
  const Json& level = json["nodes"][leaf["extensions"]["MSFT_lod"]["ids"][0].get<std::size_t>()];
  EXPECT_EQ(level["weights"], Json({0.5}));
}

TEST_F(GltfLevels, levels_of_an_earlier_run_are_replaced_and_told) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(3, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  written(halved(read(b), 4));
  const auto again = read_gltf(folder_ / "out.glb");
  ASSERT_TRUE(again);
  EXPECT_EQ(drawn_triangles(*again), 18U);
  const Json json = written(halved(*again, 2)).json;
  ASSERT_EQ(report_.warnings.size(), 1U);
  EXPECT_NE(report_.warnings[0].find("replaced"), std::string::npos);
  EXPECT_EQ(json["nodes"][0]["extensions"]["MSFT_lod"]["ids"].size(), 1U);
}

TEST_F(GltfLevels, a_rebuilt_ladder_is_the_same_file) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(3, 0)}}}, {{"primitives", {b.sheet(4, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"extras", {{"mine", 1}}}}, {{"mesh", 1}}};
  const auto bytes_of = [&] { return *read_file(folder_ / "out.glb"); };
  written(halved(read(b), 4));
  const std::string first = bytes_of();
  const auto bare = read_gltf(folder_ / "out.glb", {.levels = false});
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->meshes.size(), 2U);
  const Json json = written(halved(*bare, 4)).json;
  EXPECT_TRUE(report_.warnings.empty());
  EXPECT_EQ(json["nodes"][0]["extras"]["mine"], 1);
  EXPECT_TRUE(bytes_of() == first);
}

TEST_F(GltfLevels, bytes_of_the_levels_add_up_and_the_coarsest_comes_first) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(8, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  Ladder ladder = halved(read(b), 64);
  ladder.levels.push_back(ladder.levels[1]);
  ladder.levels[2].model.meshes[0].triangles.resize(8);
  ladder.levels[2].model.meshes[0].face_group.resize(8);
  const GlbContent out = written(ladder);
  EXPECT_EQ(report_.level_bytes[0] + report_.level_bytes[1] + report_.level_bytes[2], report_.total_bytes);
  EXPECT_EQ(report_.total_bytes, fs::file_size(folder_ / "out.glb"));
  const auto offset = [&](const Json& primitive) {
    const std::size_t a = primitive["attributes"]["POSITION"].get<std::size_t>();
    return out.json["bufferViews"][out.json["accessors"][a]["bufferView"].get<std::size_t>()]["byteOffset"]
        .get<std::size_t>();
  };
  const std::size_t two = offset(level_mesh(out.json, 0, 2)["primitives"][0]);
  const std::size_t one = offset(level_mesh(out.json, 0, 1)["primitives"][0]);
  EXPECT_LT(two, one);
  EXPECT_LT(one, offset(out.json["meshes"][0]["primitives"][0]));
}

TEST_F(GltfLevels, extensions_that_describe_the_old_geometry_do_not_reach_the_new) {
  GltfBuilder b;
  Json sheet = b.sheet(3, 0);
  sheet["extensions"] = {{"CESIUM_primitive_outline", {{"indices", sheet["indices"]}}}, {"ACME_kept", {{"x", 1}}}};
  b.json["extensionsUsed"] = {"CESIUM_primitive_outline", "ACME_kept"};
  b.json["meshes"] = {{{"primitives", {sheet}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  const Json json = written(halved(read(b), 4)).json;
  EXPECT_EQ(level_mesh(json, 0, 1)["primitives"][0]["extensions"], Json({{"ACME_kept", {{"x", 1}}}}));
  EXPECT_EQ(json["meshes"][0]["primitives"][0], sheet);
  EXPECT_EQ(report_.warnings.size(), 1U);
}

}  // namespace
}  // namespace lodestone::io
