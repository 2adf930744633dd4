// What a glTF file has against its specification is not repeated at every level: it is mended, so that what is written
// is valid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"
#include "support/folder.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using test::GlbContent;
using test::GltfBuilder;
using test::Json;

// What accessors tell of their smallest and largest values is so.
void expect_true_bounds(const GlbContent& glb) {
  const Json& accessors = glb.json["accessors"];
  for (std::size_t a = 0; a < accessors.size(); ++a) {
    if (!accessors[a].contains("bufferView")) continue;
    for (const char* key : {"min", "max"}) {
      if (!accessors[a].contains(key)) continue;
      const std::size_t n = accessors[a][key].size();
      const std::vector<double> values = test::stored_values(glb, a, n);
      std::vector<double> want(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n));
      for (std::size_t i = 0; i < values.size(); ++i) {
        double& w = want[i % n];
        w = std::string_view(key) == "min" ? std::min(w, values[i]) : std::max(w, values[i]);
      }
      EXPECT_EQ(accessors[a][key].get<std::vector<double>>(), want) << key << " of accessor " << a;
    }
  }
}

class GltfValid : public test::InFolder {
 protected:
  // The file that a ladder of the model and two levels of its first triangles becomes.
  GlbContent ladder_of(const GltfBuilder& b) {
    Result<Model> model = read_gltf_bytes(b.glb(), "made.glb");
    EXPECT_TRUE(model) << model.error().line();
    if (!model) return {};
    warnings_ = model->warnings;
    Ladder ladder;
    ladder.original = *model;
    ladder.levels.resize(3);
    for (std::size_t level : {1U, 2U}) {
      ladder.levels[level].model = *model;
      for (Mesh& mesh : ladder.levels[level].model.meshes) {
        mesh.triangles.resize(mesh.triangles.size() / 2 / level);
        if (!mesh.face_group.empty()) mesh.face_group.resize(mesh.triangles.size());
      }
    }
    const auto report = write_gltf(ladder, folder_ / "out.glb");
    EXPECT_TRUE(report) << report.error().line();
    if (!report) return {};
    warnings_.insert(warnings_.end(), report->warnings.begin(), report->warnings.end());
    GlbContent out = test::open_glb(*read_file(folder_ / "out.glb"));
    expect_true_bounds(out);
    return out;
  }
  bool told(const std::string& part) const {
    return std::any_of(warnings_.begin(), warnings_.end(),
                       [&](const std::string& w) { return w.find(part) != std::string::npos; });
  }
  std::vector<std::string> warnings_;
};

template <class Use>
void each_primitive(const Json& json, Use use) {
  for (const Json& mesh : json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) use(primitive);
  }
}

template <class T>
void add_skin(GltfBuilder& b, Json& primitive, std::size_t vertices, std::vector<std::uint8_t> joints,
              std::vector<T> weights) {
  for (std::size_t set = 0; 4 * set < weights.size(); ++set) {
    std::vector<std::uint8_t> j;
    std::vector<T> w;
    for (std::size_t v = 0; v < vertices; ++v) {
      for (std::size_t k = 4 * set; k < 4 * set + 4; ++k) {
        j.push_back(joints[k]);
        w.push_back(weights[k]);
      }
    }
    primitive["attributes"]["JOINTS_" + std::to_string(set)] = b.bounded(j, "VEC4", 4);
    primitive["attributes"]["WEIGHTS_" + std::to_string(set)] = b.bounded(w, "VEC4", 4, !std::is_same_v<T, float>);
  }
}

void add_joints(GltfBuilder& b, std::size_t count) {
  Json joints = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    joints.push_back(b.json["nodes"].size());
    b.json["nodes"].push_back({{"name", "joint"}});
  }
  b.json["skins"] = {{{"joints", joints}}};
}

// The sums of all vertices' weights over all sets, as stored: 1 at best.
std::vector<double> weight_sums(const GlbContent& glb, const Json& primitive) {
  std::vector<double> sums;
  for (int set = 0; primitive["attributes"].contains("WEIGHTS_" + std::to_string(set)); ++set) {
    const std::size_t index = primitive["attributes"]["WEIGHTS_" + std::to_string(set)].get<std::size_t>();
    const int type = glb.json["accessors"][index]["componentType"].get<int>();
    const double one = type == 5121 ? 255 : type == 5123 ? 65535 : 1;
    const auto values = test::stored_values(glb, index, 4);
    sums.resize(values.size() / 4);
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_GE(values[i], 0);
      sums[i / 4] += values[i] / one;
    }
  }
  return sums;
}

TEST_F(GltfValid, skin_weights_sum_to_one_in_every_primitive_of_every_level) {
  GltfBuilder b;
  b.json["nodes"] = Json::array();
  const auto add = [&](auto part, std::size_t sets) {
    std::vector<std::uint8_t> joints(4 * sets);
    for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = static_cast<std::uint8_t>(k);
    Json sheet = b.sheet(4, 0);
    Json line = {{"mode", 3}, {"attributes", {{"POSITION", b.positions<float>({0, 0, 0, 1, 1, 1})}}}};
    add_skin(b, sheet, 25, joints, std::vector(4 * sets, part));
    add_skin(b, line, 2, joints, std::vector(4 * sets, part));
    Json points = line;
    points["mode"] = 0;
    b.json["nodes"].push_back({{"mesh", b.json["meshes"].size()}, {"skin", 0}});
    b.json["meshes"].push_back({{"primitives", {sheet, line, points}}});
  };
  add(0.21875F, 1);
  add(std::uint8_t{56}, 1);
  add(std::uint16_t{14336}, 1);
  add(0.109375F, 2);
  add(0.24995F, 1);  // so near that the mesh itself stays as it is
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  add_joints(b, 8);
  const GlbContent out = ladder_of(b);
  EXPECT_TRUE(told("mesh 3: skin weights"));
  std::size_t primitives = 0;
  each_primitive(out.json, [&](const Json& primitive) {
    ++primitives;
    for (const double sum : weight_sums(out, primitive)) EXPECT_NEAR(sum, 1, 1e-7) << primitive;
  });
  EXPECT_EQ(primitives, 5U * 3 * 3);
}

TEST_F(GltfValid, impossible_influences_go_and_the_others_take_their_share) {
  const struct {
    std::vector<std::uint8_t> joints;
    std::vector<float> weights, want;
  } cases[] = {{{0, 1, 2, 3}, {1.25F, -0.25F, 0, 0}, {1, 0, 0, 0}},
               {{0, 1, 1, 0}, {0.5F, 0.25F, 0.25F, 0}, {0.5, 0.5, 0, 0}},
               {{0, 9, 1, 0}, {0.25F, 0.5F, 0.25F, 0}, {0.5, 0, 0.5, 0}},
               {{3, 2, 1, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}}};
  for (const auto& c : cases) {
    GltfBuilder b;
    Json sheet = b.sheet(4, 0);
    Json points = {{"mode", 0}, {"attributes", {{"POSITION", b.positions<float>({0, 0, 0, 1, 1, 1})}}}};
    add_skin(b, sheet, 25, c.joints, c.weights);
    add_skin(b, points, 2, c.joints, c.weights);
    b.json["meshes"] = {{{"primitives", {sheet, points}}}};
    b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
    add_joints(b, 4);
    const GlbContent out = ladder_of(b);
    EXPECT_TRUE(told("skin weights"));
    each_primitive(out.json, [&](const Json& p) {
      const auto weights = test::stored_values(out, p["attributes"]["WEIGHTS_0"].get<std::size_t>(), 4);
      const auto joints = test::stored_values(out, p["attributes"]["JOINTS_0"].get<std::size_t>(), 4);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_FLOAT_EQ(static_cast<float>(weights[i]), c.want[i % 4]);
        EXPECT_LT(joints[i], 4);
      }
    });
  }
}

TEST_F(GltfValid, a_primitive_without_skin_beside_a_skinned_one_is_no_reason_to_touch_either) {
  GltfBuilder b;
  Json skinned = b.sheet(4, 0);
  add_skin<float>(b, skinned, 25, {0, 1, 0, 0}, {0.5F, 0.5F, 0, 0});
  b.json["meshes"] = {{{"primitives", {skinned, b.sheet(4, 1)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
  add_joints(b, 2);
  const GlbContent out = ladder_of(b);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_EQ(out.json["meshes"][0], b.json["meshes"][0]) << "level 0 is as it was";
}

TEST_F(GltfValid, positions_and_times_of_animations_tell_their_bounds) {
  GltfBuilder b;
  Json sheet = b.sheet(2, 3);
  sheet["targets"] = {{{"POSITION", b.accessor(std::vector<float>(27, 0.5F), "VEC3", 3)}}};
  b.json["meshes"] = {{{"primitives", {sheet}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  Json& position = b.json["accessors"][sheet["attributes"]["POSITION"].get<std::size_t>()];
  position.erase("min");
  position["max"] = {9, 9, 9};
  const std::size_t times = b.accessor<float>({0.25F, 0.5F, 2}, "SCALAR", 1);
  const std::size_t moves = b.accessor<float>({0, 0, 0, 1, 1, 1, 2, 2, 2}, "VEC3", 3);
  b.json["animations"] = {{{"samplers", {{{"input", times}, {"output", moves}}}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  const GlbContent out = ladder_of(b);
  Json accessors = out.json["accessors"];
  EXPECT_EQ(accessors[times]["min"], Json({0.25}));
  EXPECT_EQ(accessors[times]["max"], Json({2.0}));
  EXPECT_FALSE(accessors[moves].contains("min")) << "nobody asks for these";
  const Json& first = out.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(accessors[first["attributes"]["POSITION"].get<std::size_t>()]["min"], Json({0.0, 0.0, 3.0}));
  EXPECT_EQ(accessors[first["attributes"]["POSITION"].get<std::size_t>()]["max"], Json({2.0, 2.0, 3.0}));
  EXPECT_EQ(accessors[first["targets"][0]["POSITION"].get<std::size_t>()]["max"], Json({0.5, 0.5, 0.5}));
}

TEST_F(GltfValid, normals_tangents_and_colors_that_stay_in_the_file_are_put_right) {
  GltfBuilder b;
  Json points = {{"mode", 0},
                 {"attributes",
                  {{"POSITION", b.positions<float>({0, 0, 0, 1, 1, 1})},
                   {"NORMAL", b.bounded<float>({0, 0, 2, 0, 0, 0}, "VEC3", 3)},
                   {"TANGENT", b.bounded<float>({1, 0, 0, -0.5F, 0.5F, 0, 0, 1}, "VEC4", 4)},
                   {"COLOR_0", b.bounded<float>({1.5F, 0.5F, -0.5F, 0, 0.25F, 1}, "VEC3", 3)}}}};
  b.json["meshes"] = {{{"primitives", {b.sheet(4, 0), points}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  const GlbContent out = ladder_of(b);
  EXPECT_TRUE(told("normals, tangents or colours"));
  const Json& attributes = out.json["meshes"][1]["primitives"][1]["attributes"];
  const auto values = [&](const char* name, std::size_t n) {
    return test::stored_values(out, attributes[name].get<std::size_t>(), n);
  };
  EXPECT_EQ(values("NORMAL", 3), (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(values("TANGENT", 4), (std::vector<double>{1, 0, 0, -1, 1, 0, 0, 1}));
  EXPECT_EQ(values("COLOR_0", 3), (std::vector<double>{1, 0.5, 0, 0, 0.25, 1}));
}

TEST_F(GltfValid, values_that_are_not_finite_go_and_bounds_tell_what_is_there_then) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  GltfBuilder b;
  Json points = {{"mode", 0},
                 {"attributes",
                  {{"POSITION", b.positions<float>({0, 0, 0, 1, 1, 1})},
                   {"NORMAL", b.accessor<float>({0, inf, 1, nan, 0, 0}, "VEC3", 3)},
                   {"COLOR_0", b.accessor<float>({nan, 0.5F, inf, 0, 0.25F, 1}, "VEC3", 3)}}}};
  for (const char* name : {"NORMAL", "COLOR_0"}) {
    b.tell_bounds<float>(points["attributes"][name].get<std::size_t>(), {0, 0, 0, 1, 1, 1}, 3);
  }
  add_skin<float>(b, points, 2, {0, 1, 0, 0}, {inf, 0.5F, 0, 0});
  b.tell_bounds<float>(points["attributes"]["WEIGHTS_0"].get<std::size_t>(), {1, 1, 1, 1}, 4);
  b.json["meshes"] = {{{"primitives", {b.sheet(4, 0), points}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
  add_joints(b, 2);
  const GlbContent out = ladder_of(b);
  const Json& attributes = out.json["meshes"][1]["primitives"][1]["attributes"];
  const auto values = [&](const char* name, std::size_t n) {
    return test::stored_values(out, attributes[name].get<std::size_t>(), n);
  };
  EXPECT_EQ(values("NORMAL", 3), (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(values("COLOR_0", 3), (std::vector<double>{0, 0.5, 0, 0, 0.25, 1}));
  EXPECT_EQ(values("WEIGHTS_0", 4), (std::vector<double>{0, 1, 0, 0, 0, 1, 0, 0}));
}

TEST_F(GltfValid, a_skin_that_meshes_share_is_valid_for_the_smaller_skeleton_whichever_comes_first) {
  for (const std::size_t small : {0U, 1U}) {
    GltfBuilder b;
    Json sheet = b.sheet(4, 0), points = sheet;
    points["mode"] = 0;
    points.erase("indices");
    add_skin<float>(b, points, 25, {0, 3, 1, 0}, {0.5F, 0.25F, 0.125F, 0});
    b.json["meshes"] = {{{"primitives", {sheet, points}}}, {{"primitives", {sheet, points}}}};
    b.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    b.json["scenes"][0]["nodes"] = {0, 1};
    add_joints(b, 4);
    b.json["skins"].push_back({{"joints", {2, 3}}});
    b.json["nodes"][small]["skin"] = 1;
    b.json["nodes"][1 - small]["skin"] = 0;
    const GlbContent out = ladder_of(b);
    each_primitive(out.json, [&](const Json& p) {
      if (!p["attributes"].contains("WEIGHTS_0")) return;
      const auto weights = test::stored_values(out, p["attributes"]["WEIGHTS_0"].get<std::size_t>(), 4);
      const auto joints = test::stored_values(out, p["attributes"]["JOINTS_0"].get<std::size_t>(), 4);
      EXPECT_EQ(std::vector<double>(joints.begin(), joints.begin() + 4), (std::vector<double>{0, 0, 1, 0}));
      EXPECT_EQ(weights[1], 0);
      EXPECT_FLOAT_EQ(static_cast<float>(weights[0] + weights[2]), 1);
    });
  }
}

TEST_F(GltfValid, levels_do_not_repeat_transforms_that_the_format_forbids) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(4, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"rotation", {0, 0, 0.5, 0.5}}},
                     {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
                     {{"mesh", 0}, {"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Json nodes = ladder_of(b).json["nodes"];
  EXPECT_TRUE(told("node 0 has a transform") && told("node 1 has a transform"));
  EXPECT_FALSE(told("node 2 has a transform"));
  const auto having = [&](const char* key) {
    return std::count_if(nodes.begin(), nodes.end(), [&](const Json& n) { return n.contains(key); });
  };
  EXPECT_EQ(having("rotation"), 1);
  EXPECT_EQ(having("matrix"), 1 + 3) << "a matrix that is one of moves, turns and scales is copied as ever";
}

TEST_F(GltfValid, rotations_above_one_flat_and_huge_matrices_stand_in_one_node_each) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(4, 0)}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"rotation", {0, 0, 0, 1.0000001}}},
                     {{"mesh", 0}, {"rotation", {0, -1.0003, 0, 0}}},
                     {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}},
                     {{"mesh", 0}, {"matrix", {100, 0, 0, 0, 0.005, 100, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
                     {{"mesh", 0}, {"rotation", {0, 0, 0, 1}}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  const Json nodes = ladder_of(b).json["nodes"];
  const auto having = [&](const char* key) {
    return std::count_if(nodes.begin(), nodes.end(), [&](const Json& n) { return n.contains(key); });
  };
  EXPECT_EQ(having("rotation"), 2 + 3) << "levels copy a good one";
  EXPECT_EQ(having("matrix"), 2);
  EXPECT_TRUE(told("node 0 has a transform") && told("node 1 has a transform") && told("node 2 has a transform"));
  EXPECT_FALSE(told("node 3 has a transform")) << "rounding: not worth a word";
}

TEST_F(GltfValid, of_many_forbidden_transforms_a_few_are_told_and_the_others_counted) {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(4, 0)}}}};
  Json scene = Json::array();
  for (std::size_t n = 0; n < 1000; ++n) {
    scene.push_back(n);
    b.json["nodes"].push_back({{"mesh", 0}, {"rotation", {0, 0, 0, 2}}});
  }
  b.json["scenes"][0]["nodes"] = scene;
  ladder_of(b);
  EXPECT_EQ(warnings_.size(), 4U);
  EXPECT_TRUE(told("node 2 has a transform"));
  EXPECT_TRUE(told("997 other nodes"));
}

TEST_F(GltfValid, names_lengths_and_types_against_the_format_are_mended_at_all_levels) {
  GltfBuilder b;
  Json sheet = b.sheet(4, 0);
  sheet["attributes"]["QUALITY"] = b.accessor(std::vector<float>(25, 0.5F), "SCALAR", 1);
  sheet["attributes"]["NORMAL"] = b.accessor(std::vector<std::int8_t>(75, 73), "VEC3", 3, true, 4);
  sheet["targets"] = {{{"POSITION", b.positions(std::vector<float>(75, 0.5F))}}};
  b.json["meshes"] = {{{"primitives", {sheet}}, {"weights", {0.5, 0.25}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"weights", Json::array({1.0, 1.0, 1.0})}}};
  const GlbContent out = ladder_of(b);
  EXPECT_TRUE(told("'QUALITY'"));
  each_primitive(out.json, [](const Json& p) {
    EXPECT_TRUE(p["attributes"].contains("_QUALITY"));
    EXPECT_FALSE(p["attributes"].contains("QUALITY"));
  });
  for (const Json& mesh : out.json["meshes"]) EXPECT_EQ(mesh["weights"], Json({0.5}));
  for (const Json& node : out.json["nodes"]) EXPECT_EQ(node.value("weights", Json({1.0})), Json({1.0}));
  EXPECT_EQ(out.json.value("extensionsRequired", Json()), Json({"KHR_mesh_quantization"}));
}

TEST_F(GltfValid, texture_coordinates_in_bytes_are_quantized_whether_normalized_is_absent_or_false) {
  for (const bool spelt : {false, true}) {
    GltfBuilder b;
    Json sheet = b.sheet(4, 0);
    const std::size_t uv = b.accessor(std::vector<std::uint8_t>(50, 1), "VEC2", 2, false, 4);
    if (spelt) b.json["accessors"][uv]["normalized"] = false;
    sheet["attributes"]["TEXCOORD_0"] = uv;
    b.json["meshes"] = {{{"primitives", {sheet}}}};
    b.json["nodes"] = {{{"mesh", 0}}};
    const Result<Model> model = read_gltf_bytes(b.glb(), "made.glb");
    ASSERT_TRUE(model && write_gltf(*model, folder_ / "out.glb"));
    const Json json = test::open_glb(*read_file(folder_ / "out.glb")).json;
    EXPECT_EQ(json.value("extensionsRequired", Json()), Json({"KHR_mesh_quantization"}));
  }
}

}  // namespace
}  // namespace lodestone::io
