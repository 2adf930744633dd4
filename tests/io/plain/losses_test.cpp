// PLY, OBJ and OFF: what they keep of colours, numbers, groups and materials, and that they tell what they don't.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/plain/obj.h"
#include "lodestone/io/plain/off.h"
#include "lodestone/io/plain/ply.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

const std::string kPng = std::string("\x89PNG\r\n\x1a\n", 8) + "no more of it";

std::shared_ptr<const Image> png(const std::string& name, const std::string& content = kPng) {
  auto image = std::make_shared<Image>();
  image->name = name;
  image->mime = "image/png";
  image->encoded.assign(bytes(content).begin(), bytes(content).end());
  return image;
}

// A number of the stream, in whatever precision it is kept.
double value(const AttributeStream& stream, std::size_t i) {
  if (const auto* doubles = std::get_if<std::vector<double>>(&stream.values)) return (*doubles)[i];
  return std::get<std::vector<float>>(stream.values)[i];
}

AttributeStream stream_of(const std::string& name, Semantic semantic, std::uint32_t components, ComponentType type,
                          bool normalized, const std::vector<float>& values) {
  AttributeStream stream =
      make_stream(name, semantic, components, type, normalized, values.size() / std::size_t{components});
  stream.values = values;
  return stream;
}

Mesh triangle() { return test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}); }

Mesh triangle_with_uvs() {
  Mesh mesh = triangle();
  mesh.attributes.push_back(
      stream_of("s t", Semantic::uv, 2, ComponentType::float32, false, {0.25F, 0, 1, 0, 0, 0.75F}));
  return mesh;
}

// Four triangles beside each other, one a group.
Model four_groups(const std::vector<FaceGroup>& groups) {
  Mesh mesh = test::grid(2);
  mesh.triangles.resize(4);
  mesh.face_group = {0, 1, 2, 3};
  mesh.groups = groups;
  return make_model(mesh);
}

std::size_t count_of(const std::vector<std::string>& warnings, const std::string& part) {
  return static_cast<std::size_t>(std::count_if(
      warnings.begin(), warnings.end(), [&](const std::string& w) { return w.find(part) != std::string::npos; }));
}

class PlainLosses : public test::InFolder {
 protected:
  fs::path put(const std::string& name, const std::string& content) {
    auto out = OutputFile::create(folder_ / name);
    out->write(content);
    EXPECT_TRUE(out->commit());
    return folder_ / name;
  }
  // What a file of this name holds after the model was written there.
  Model there_and_back(const Model& model, const std::string& name) {
    const auto report = write_model(model, folder_ / name);
    EXPECT_TRUE(report) << report.error().line();
    if (!report) return {};
    told_ = report->warnings;
    const auto back = read_model(folder_ / name);
    EXPECT_TRUE(back) << back.error().line();
    return back ? *back : Model{};
  }
  std::string text(const std::string& name) { return read_file(folder_ / name).value_or(""); }
  std::vector<std::string> told_;  // by the writer
};

// ---- numbers ----

TEST_F(PlainLosses, doubles_of_a_ply_are_written_as_obj) {
  const auto model = read_ply(
      bytes("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property double nx\nproperty double ny\nproperty double nz\nproperty double s\nproperty double t\n"
            "property double red\nproperty double green\nproperty double blue\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n"
            "0 0 0 0 0 1 0.125 0.1 1 0 0\n1 0 0 0 1 0 0.5 0.2 0 1 0\n0 1 0 1 0 0 0.75 0.3 0 0.5 1\n3 0 1 2\n"),
      "x.ply");
  ASSERT_TRUE(model) << model.error().line();
  const Model back = there_and_back(*model, "m.obj");
  EXPECT_TRUE(told_.empty()) << told_[0];
  for (const AttributeStream& before : model->meshes[0].attributes) {
    const AttributeStream* after = find_stream(back.meshes[0], before.semantic);
    ASSERT_NE(after, nullptr) << before.name;
    ASSERT_EQ(after->value_count(), before.value_count()) << before.name;
    for (std::size_t i = 0; i < before.value_count(); ++i) {
      EXPECT_FLOAT_EQ(static_cast<float>(value(*after, i)), static_cast<float>(value(before, i))) << before.name;
    }
  }
}

TEST_F(PlainLosses, what_obj_has_no_numbers_for_is_told) {
  Mesh mesh = triangle();
  AttributeStream bits =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::uint32, false, 3);  // nonsense, but a file may say so
  mesh.attributes.push_back(bits);
  const Model back = there_and_back(make_model(mesh), "m.obj");
  EXPECT_EQ(find_stream(back.meshes[0], Semantic::normal), nullptr);
  EXPECT_EQ(count_of(told_, "'NORMAL'"), 1U);
}

// ---- colours ----

TEST_F(PlainLosses, colours_keep_their_type_and_value_in_ply) {
  struct Case {
    ComponentType type;
    bool normalized;
    std::vector<float> values;
  };
  const std::vector<Case> cases{
      {ComponentType::float32, false, {1.5F, 0.1234567F, -0.25F, 0, 0, 0, 1, 1, 1}},
      {ComponentType::uint16, true, {1.0F / 65535, 257.0F / 65535, 1, 0, 0, 0, 1, 1, 1}},
      {ComponentType::uint8, true, {1.0F / 255, 128.0F / 255, 1, 0, 0, 0, 1, 1, 1}},
  };
  for (const Case& c : cases) {
    Mesh mesh = triangle();
    mesh.attributes.push_back(stream_of("COLOR_0", Semantic::color, 3, c.type, c.normalized, c.values));
    const Model back = there_and_back(make_model(mesh), "m.ply");
    const AttributeStream* color = find_stream(back.meshes[0], Semantic::color);
    ASSERT_NE(color, nullptr);
    EXPECT_EQ(color->type, c.type);
    EXPECT_EQ(std::get<std::vector<float>>(color->values), c.values);
  }
}

std::vector<float> obj_colors(const std::string& a, const std::string& b, const std::string& c) {
  const auto model = read_obj(bytes("v 0 0 0 " + a + "\nv 1 0 0 " + b + "\nv 0 1 0 " + c + "\nf 1 2 3\n"), "x.obj");
  EXPECT_TRUE(model) << model.error().line();
  return std::get<std::vector<float>>(find_stream(model->meshes[0], Semantic::color)->values);
}

std::vector<float> off_colors(const std::string& a, const std::string& b, const std::string& c) {
  const auto model =
      read_off(bytes("COFF\n3 1 0\n0 0 0 " + a + "\n1 0 0 " + b + "\n0 1 0 " + c + "\n3 0 1 2\n"), "x.off");
  EXPECT_TRUE(model) << model.error().line();
  return std::get<std::vector<float>>(find_stream(model->meshes[0], Semantic::color)->values);
}

TEST(TextColours, a_little_above_one_is_no_byte) {
  for (const auto colors : {obj_colors, off_colors}) {
    EXPECT_EQ(colors("1.0001 0.5 0", "4.5 0 0", "0 0 1"), (std::vector<float>{1.0001F, 0.5F, 0, 4.5F, 0, 0, 0, 0, 1}));
    EXPECT_EQ(colors("1 0 0", "0 1 0", "0 0 1"), (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(colors("2 0 0", "0 1 0", "0 0 255")[0], 2.0F / 255) << "whole numbers are bytes";
    EXPECT_EQ(colors("127.5 0 0", "0 1 0", "0 0 255")[0], 0.5F) << "as are others that run far beyond 1";
  }
}

TEST(TextColours, bytes_stay_bytes) {
  const auto model = read_obj(bytes("v 0 0 0 255 128 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n"), "x.obj");
  ASSERT_TRUE(model) << model.error().line();
  const AttributeStream* color = find_stream(model->meshes[0], Semantic::color);
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->type, ComponentType::uint8);
  EXPECT_TRUE(color->normalized);
  EXPECT_EQ(value(*color, 8), 1) << "a vertex without a colour is white, whatever the others' range";
}

TEST_F(PlainLosses, a_second_colour_of_a_vertex_is_told_once) {
  Mesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {4, 3, 5}});
  mesh.wedge_vertex = {0, 1, 2, 3, 1, 2};  // the two triangles share an edge, in two colours
  mesh.attributes.push_back(stream_of("COLOR_0", Semantic::color, 3, ComponentType::float32, false,
                                      {0.5F, 0, 0, 0.5F, 0, 0, 0.5F, 0, 0, 0, 0.5F, 0, 0, 0.5F, 0, 0, 0.5F, 0}));
  const Model back = there_and_back(make_model(mesh), "m.obj");
  EXPECT_EQ(count_of(told_, "one colour a vertex"), 1U);
  EXPECT_EQ(count_of(told_, "2 vertices"), 1U);
  std::get<std::vector<float>>(mesh.attributes[0].values).assign(18, 0.5F);
  there_and_back(make_model(mesh), "m.obj");
  EXPECT_TRUE(told_.empty());
}

TEST_F(PlainLosses, alpha_that_obj_does_not_hold_is_told) {
  Mesh mesh = triangle();
  mesh.attributes.push_back(stream_of("COLOR_0", Semantic::color, 4, ComponentType::float32, false,
                                      {0.5F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5F}));
  there_and_back(make_model(mesh), "m.obj");
  EXPECT_EQ(count_of(told_, "alpha"), 1U);
  std::get<std::vector<float>>(mesh.attributes[0].values)[11] = 1;
  there_and_back(make_model(mesh), "m.obj");
  EXPECT_TRUE(told_.empty());
}

// ---- groups and materials ----

// Of each triangle: the name of its group and of its material.
std::vector<std::pair<std::string, std::string>> labels(const Model& model) {
  std::vector<std::pair<std::string, std::string>> out;
  const Mesh& mesh = model.meshes[0];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const FaceGroup group = mesh.groups.empty() ? FaceGroup{} : mesh.groups[mesh.group_of(t)];
    out.emplace_back(group.name, group.material == kNone ? "" : model.materials[group.material].name);
  }
  return out;
}

TEST_F(PlainLosses, groups_of_an_obj_inherit_no_material_and_no_name) {
  Model model = four_groups({{0, "none"}, {kNone, "left"}, {1, ""}, {kNone, ""}});
  model.materials.resize(2);
  model.materials[0].name = "none";  // the word that would stand for no material
  model.materials[1].name = "blue";
  const Model back = there_and_back(model, "m.obj");
  using Labels = std::vector<std::pair<std::string, std::string>>;
  const Labels wanted{{"none", "none"}, {"left", "none_"}, {"default", "blue"}, {"default", "none_"}};
  EXPECT_EQ(labels(back), wanted);
  EXPECT_EQ(back.meshes[0].groups.size(), 4U);
  ASSERT_EQ(back.materials.size(), 3U);
  EXPECT_EQ(back.materials[1].base_color, (std::array<float, 4>{1, 1, 1, 1}));
  EXPECT_EQ(count_of(back.warnings, "defined nowhere"), 0U) << "the .mtl has an entry for it";
  EXPECT_EQ(labels(there_and_back(back, "n.obj")), wanted) << "and so it stays";
}

TEST_F(PlainLosses, names_that_need_other_letters_stay_apart) {
  const Model back =
      there_and_back(four_groups({{kNone, "a b"}, {kNone, "a_b"}, {kNone, "default"}, {kNone, ""}}), "m.obj");
  EXPECT_EQ(back.meshes[0].groups.size(), 4U);
  EXPECT_EQ(labels(back)[2].first, "default");
}

TEST_F(PlainLosses, an_obj_without_names_has_no_lines_for_them) {
  there_and_back(four_groups({{}, {}, {}, {}}), "m.obj");
  EXPECT_EQ(text("m.obj").find("usemtl"), std::string::npos);
  EXPECT_EQ(text("m.obj").find("\ng"), std::string::npos);
}

TEST_F(PlainLosses, roughness_and_metal_survive_in_mtl) {
  Model model = four_groups({{0, ""}, {0, ""}, {0, ""}, {0, ""}});
  model.materials.resize(1);
  model.materials[0].roughness = 0.25F;
  model.materials[0].metallic = 0.75F;
  const Model back = there_and_back(model, "m.obj");
  ASSERT_EQ(back.materials.size(), 1U);
  EXPECT_EQ(back.materials[0].roughness, 0.25F);
  EXPECT_EQ(back.materials[0].metallic, 0.75F);
  EXPECT_TRUE(back.warnings.empty()) << "what we write we understand: " << back.warnings[0];
}

TEST_F(PlainLosses, one_warning_names_what_an_mtl_says_beyond_a_gltf) {
  put("t.png", kPng);
  put("b.png", kPng + "2");
  put("a.mtl",
      "# Ke is not used\nnewmtl a\nKa 0 0 0\nKs 1 1 1\nKd 1 0 0\nNs 10\nillum 2\nmap_Kd -s 2 2 1 t.png\nmap_Bump "
      "b.png\n"
      "newmtl b\nks 1 1 1\nd 1\n");
  put("b.mtl", "newmtl c\nNs 20\nKe 1 1 1\nks 1 1 1\n");
  const auto model = read_model(
      put("m.obj", "mtllib a.mtl\nmtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl c\nf 1 3 2\n"));
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_TRUE(model->warnings.empty()) << model->warnings[0];
  there_and_back(*model, "n.glb");
  EXPECT_EQ(told_,
            (std::vector<std::string>{"properties of materials were left out: Ka, Ks, illum, map_Kd -s, map_Bump"}));
}

TEST_F(PlainLosses, a_damaged_mtl_does_not_fill_the_screen) {
  std::string mtl = "newmtl a\n\xff\xfe 1\n";
  for (int i = 0; i < 100; ++i) mtl += "k" + std::to_string(i) + " 1\n";
  put("a.mtl", mtl);
  const auto model = read_model(put("m.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"));
  ASSERT_TRUE(model) << model.error().line();
  there_and_back(*model, "n.glb");
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_NE(told_[0].find("k11, others"), std::string::npos) << told_[0];
  EXPECT_EQ(told_[0].find("k12"), std::string::npos);
}

// ---- textures ----

TEST_F(PlainLosses, a_ply_names_its_one_texture_and_brings_it) {
  Model model = make_model(triangle_with_uvs());
  model.materials.resize(2);  // one of them is not drawn
  model.materials[0].base_color_texture = png("textures\\a b.png");
  model.materials[1].base_color_texture = png("other.png", kPng + "2");
  model.meshes[0].groups = {{0, ""}};
  const Model back = there_and_back(model, "m.ply");
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(text("a b.png"), kPng);
  EXPECT_FALSE(fs::exists(folder_ / "other.png"));
  ASSERT_EQ(back.materials.size(), 1U);
  ASSERT_NE(back.materials[0].base_color_texture, nullptr);
  EXPECT_EQ(back.materials[0].base_color_texture->encoded, model.materials[0].base_color_texture->encoded);
  EXPECT_TRUE(back.warnings.empty());
}

TEST_F(PlainLosses, textures_that_a_ply_cannot_hold_are_told) {
  Model model = four_groups({{0, ""}, {1, ""}, {2, ""}, {0, ""}});
  model.meshes[0] = [&] {
    Mesh mesh = model.meshes[0];
    mesh.attributes.push_back(make_stream("s t", Semantic::uv, 2, ComponentType::float32, false, mesh.wedge_count()));
    return mesh;
  }();
  model.materials.resize(3);
  model.materials[0].base_color_texture = png("a.png");
  model.materials[1].base_color_texture = png("a.png");  // another object, the same picture
  there_and_back(model, "one.ply");
  EXPECT_EQ(count_of(told_, "1 group without 'a.png'"), 1U);
  EXPECT_NE(text("one.ply").find("TextureFile a.png\n"), std::string::npos);

  model.materials[1].base_color_texture = png("b.png");
  there_and_back(model, "two.ply");
  EXPECT_EQ(told_.size(), 1U);
  EXPECT_EQ(count_of(told_, "one texture"), 1U);
  EXPECT_EQ(text("two.ply").find("TextureFile"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "b.png"));

  model.materials[1].base_color_texture = nullptr;
  model.meshes[0].attributes.clear();
  there_and_back(model, "bare.ply");
  EXPECT_EQ(told_.size(), 1U);
  EXPECT_EQ(count_of(told_, "no UVs"), 1U);
}

TEST_F(PlainLosses, normal_maps_go_into_mtl_and_gltf_and_a_ply_tells_that_it_has_none) {
  Model model = make_model(triangle_with_uvs());
  model.materials.resize(1);
  model.materials[0].base_color_texture = png("color.png");
  model.materials[0].normal_texture = png("normal.png", kPng + "2");
  model.meshes[0].groups = {{0, ""}};
  const Model back = there_and_back(model, "m.obj");
  EXPECT_NE(text("m.mtl").find("map_Kd color.png\nnorm normal.png\n"), std::string::npos) << text("m.mtl");
  ASSERT_NE(back.materials[0].normal_texture, nullptr);
  EXPECT_EQ(back.materials[0].normal_texture->encoded, model.materials[0].normal_texture->encoded);
  EXPECT_TRUE(back.warnings.empty());

  there_and_back(model, "m.gltf");
  const test::Json json = test::Json::parse(text("m.gltf"));
  EXPECT_EQ(json["images"].size(), 2U);
  EXPECT_EQ(json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
  EXPECT_EQ(json["materials"][0]["normalTexture"]["index"], 1);

  there_and_back(model, "m.ply");
  EXPECT_EQ(count_of(told_, "normal maps"), 1U);
}

TEST_F(PlainLosses, a_gltf_primitive_without_uvs_gets_no_normal_map) {
  Model model = make_model(triangle());
  model.materials.resize(1);
  model.materials[0].normal_texture = png("normal.png");
  model.meshes[0].groups = {{0, ""}};
  there_and_back(model, "m.gltf");
  const test::Json json = test::Json::parse(text("m.gltf"));
  EXPECT_FALSE(
      json["materials"][json["meshes"][0]["primitives"][0]["material"].get<std::size_t>()].contains("normalTexture"));
}

TEST_F(PlainLosses, names_of_textures_cannot_write_lines_or_leave_the_folder) {
  for (const std::string name : {"x\nend_header\n", "..", "../m.ply", "m.ply", "-o 1 1 1 y.png", "  "}) {
    for (const std::string file : {"inner/m.ply", "inner/m.obj"}) {
      fs::create_directory(folder_ / "inner");
      Model model = make_model(triangle_with_uvs());
      model.materials.resize(1);
      model.materials[0].base_color_texture = png(name);
      model.meshes[0].groups = {{0, ""}};
      const Model back = there_and_back(model, file);
      ASSERT_EQ(back.materials.size(), 1U) << name;
      ASSERT_NE(back.materials[0].base_color_texture, nullptr) << name;
      EXPECT_EQ(back.materials[0].base_color_texture->encoded.size(), kPng.size()) << name;
      EXPECT_FALSE(fs::exists(folder_ / "m.ply"));
      fs::remove_all(folder_ / "inner");
    }
  }
}

// What a file says of its images may be wrong; what their bytes say counts, in glTF as in OBJ.
TEST_F(PlainLosses, images_are_told_apart_by_their_bytes) {
  Model model = make_model(triangle_with_uvs());
  model.materials.resize(1);
  model.materials[0].base_color_texture = png("picture", "GIF89a");
  model.meshes[0].groups = {{0, ""}};
  EXPECT_EQ(there_and_back(model, "m.obj").materials[0].base_color_texture->mime, "image/gif");

  test::GltfBuilder glb;
  test::Json primitive = glb.sheet(1, 0);
  primitive["material"] = 0;
  glb.json["meshes"] = {{{"primitives", {primitive}}}};
  glb.json["nodes"] = {{{"mesh", 0}}};
  glb.json["images"] = {{{"uri", "data:image/png,GIF89a"}}};
  glb.json["textures"] = {{{"source", 0}}};
  glb.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  const auto by_gltf = read_model(put("m.glb", glb.glb()));
  ASSERT_TRUE(by_gltf) << by_gltf.error().line();
  ASSERT_NE(by_gltf->materials[0].base_color_texture, nullptr);
  EXPECT_EQ(by_gltf->materials[0].base_color_texture->mime, "image/gif");
}

}  // namespace
}  // namespace lodestone::io
