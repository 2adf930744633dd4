// PLY, OBJ, STL and OFF: what files in the wild look like, round trips, and damage.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <span>

#include "lodestone/base/file.h"
#include "lodestone/base/random.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/plain/obj.h"
#include "lodestone/io/plain/off.h"
#include "lodestone/io/plain/ply.h"
#include "lodestone/io/plain/stl.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

Result<Model> ply(const std::string& text) { return read_ply(bytes(text), "x.ply"); }
Result<Model> obj(const std::string& text) { return read_obj(bytes(text), "x.obj"); }
Result<Model> off(const std::string& text) { return read_off(bytes(text), "x.off"); }
Result<Model> stl(const std::string& text) { return read_stl(bytes(text), "x.stl"); }

std::string ascii_ply(const std::string& faces = "4 0 1 2 3\n", int count = 1) {
  return "ply\r\nformat ascii 1.0\r\ncomment hello\r\nelement vertex 4\r\nproperty double x\r\nproperty float y\r\n"
         "property float z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nproperty int id\r\n"
         "element face " +
         std::to_string(count) +
         "\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
         "0 0 0 255 0 0 7\n1 0 0 0 255 0 8\n1 1 0 0 0 255 9\n0 1 0 9 9 9 10\n" +
         faces;
}

TEST(Ply, ascii_with_colours_ids_and_a_polygon) {
  const auto model = ply(ascii_ply());
  ASSERT_TRUE(model) << model.error().line();
  const Mesh& mesh = model->meshes[0];
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_of(mesh), 1, 1e-9);
  const AttributeStream* color = find_stream(mesh, Semantic::color);
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->type, ComponentType::uint8);
  EXPECT_EQ(std::get<std::vector<float>>(color->values)[0], 1.0F);
  const AttributeStream* id = find_stream(mesh, Semantic::categorical);
  ASSERT_NE(id, nullptr);
  EXPECT_EQ(std::get<std::vector<std::uint32_t>>(id->values)[3], 10U);
}

TEST(Ply, both_byte_orders_say_the_same) {
  for (const bool big : {false, true}) {
    std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 3\nproperty short x\nproperty short y\nproperty short z\n"
                       "element face 1\nproperty list uchar ushort vertex_index\nend_header\n";
    const auto put = [&](std::uint16_t v) {
      const char low = static_cast<char>(v & 255), high = static_cast<char>(v >> 8);
      text += big ? high : low;
      text += big ? low : high;
    };
    for (const int v : {0, 0, 0, 300, 0, 0, 0, -300, 0}) put(static_cast<std::uint16_t>(v));
    text += '\3';
    for (const int v : {0, 1, 2}) put(static_cast<std::uint16_t>(v));
    const auto model = ply(text);
    ASSERT_TRUE(model) << model.error().line();
    EXPECT_EQ(bounds_of(*model).max.x, 300);
    EXPECT_EQ(bounds_of(*model).min.y, -300);
  }
}

TEST(Ply, strips_with_restarts) {
  const auto model =
      ply("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n8 0 1 2 3 -1 1 4 3\n");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(model->meshes[0].triangles.size(), 3U);
  for (std::size_t t = 0; t < 2; ++t) {
    const Triangle v = model->meshes[0].vertices_of(t);
    const Mesh& m = model->meshes[0];
    EXPECT_GT(cross(m.position(v[1]) - m.position(v[0]), m.position(v[2]) - m.position(v[0])).z, 0) << "turned alike";
  }
}

TEST(Ply, doubles_far_away_keep_their_shape) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "4500000.001 5600000.002 0\n4500000.003 5600000.002 0\n4500000.001 5600000.005 0\n3 0 1 2\n";
  const auto model = ply(text);
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_NEAR(area_of(model->meshes[0]), 3e-6, 1e-9);
  EXPECT_NE(model->meshes[0].offset, Vec3d{});
}

TEST(Ply, lies_are_told_with_their_line) {
  const auto huge =
      ply("ply\nformat binary_little_endian 1.0\nelement vertex 1099511627776\nproperty float x\n"
          "property float y\nproperty float z\nend_header\n1234");
  ASSERT_FALSE(huge);
  EXPECT_NE(huge.error().line().find("x.ply:3"), std::string::npos) << huge.error().line();
  EXPECT_FALSE(ply(ascii_ply("3 0 1 4\n"))) << "index out of range";
  EXPECT_FALSE(ply(ascii_ply("3 0 1 2\n", 2))) << "cut off";
  EXPECT_FALSE(ply("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n")) << "no triangles";
}

TEST(Obj, groups_materials_negative_indices_and_seams) {
  const auto model =
      obj("# c\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\nvn 0 0 1\n"
          "g left\nusemtl red\nf 1/1/1 2/2/1 3/3/1\nusemtl blue\nf -4/5/1 -2/3/1 \\\n -1/4/1\n");
  ASSERT_TRUE(model) << model.error().line();
  const Mesh& mesh = model->meshes[0];
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.vertex_count(), 4U);
  EXPECT_EQ(mesh.wedge_count(), 5U) << "vertex 1 has two UVs";
  EXPECT_EQ(mesh.groups.size(), 2U);
  EXPECT_EQ(model->materials.size(), 2U);
  EXPECT_NE(find_stream(mesh, Semantic::normal), nullptr);
}

TEST(Obj, concave_polygons_are_cut_inside) {
  // An L: six corners, area 3.
  const auto model = obj("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(model->meshes[0].triangles.size(), 4U);
  EXPECT_NEAR(area_of(model->meshes[0]), 3, 1e-6);
}

TEST(Obj, bad_indices_name_the_line) {
  const auto model = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().line().find("x.obj:4"), std::string::npos) << model.error().line();
  EXPECT_FALSE(obj("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_EQ(obj("v 0 0 0\n").error().code, ErrorCode::empty);
}

TEST(Stl, ascii_and_binary_are_welded) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n";
  const std::string other =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const auto ascii = stl("solid a b\n" + facet + other + "endsolid\n");
  ASSERT_TRUE(ascii) << ascii.error().line();
  EXPECT_EQ(ascii->meshes[0].vertex_count(), 4U);
  EXPECT_EQ(ascii->meshes[0].triangles.size(), 2U);
  EXPECT_FALSE(stl("solid x\nendsolid x\n"));
}

TEST(Off, joined_words_and_comments) {
  const auto model = off("OFF4 1 0 # counts\n0 0 0\n1 0 0 # corner\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(model->meshes[0].triangles.size(), 2U);
  EXPECT_FALSE(off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"));
}

class Folder : public test::InFolder {};

using RoundTrip = Folder;

TEST_F(RoundTrip, geometry_and_attributes_survive_where_the_format_has_them) {
  for (const test::Shape& shape : test::small_shapes()) {
    if (shape.name == "far_from_the_origin" || shape.name == "soup") continue;
    const Mesh mesh = shape.make();
    for (const char* extension : {".ply", ".obj", ".stl", ".off", ".glb", ".gltf"}) {
      const fs::path file = folder_ / ("m" + std::string(extension));
      const auto report = write_model(make_model(mesh), file);
      ASSERT_TRUE(report) << shape.name << extension << report.error().line();
      const auto back = read_model(file);
      ASSERT_TRUE(back) << shape.name << extension << " " << back.error().line();
      EXPECT_NEAR(area_of(back->meshes[0]), area_of(mesh), 1e-6 * area_of(mesh)) << shape.name << extension;
      EXPECT_EQ(topology_of(back->meshes[0]).boundary_edges, topology_of(mesh).boundary_edges)
          << shape.name << extension;
      const bool holds_uvs = std::string(extension) != ".stl" && std::string(extension) != ".off";
      EXPECT_TRUE(!holds_uvs || back->meshes[0].wedge_count() == mesh.wedge_count()) << shape.name << extension;
      EXPECT_EQ(!holds_uvs && !mesh.attributes.empty(), !report->warnings.empty()) << shape.name << extension;
    }
  }
}

TEST_F(RoundTrip, uvs_are_turned_between_formats_of_either_kind) {
  const Model model = make_model(test::with_uv_seam(test::grid(2)));
  ASSERT_TRUE(write_model(model, folder_ / "a.glb"));
  const auto glb = read_model(folder_ / "a.glb");
  ASSERT_TRUE(glb);
  ASSERT_TRUE(write_model(*glb, folder_ / "b.obj"));
  const auto back = read_model(folder_ / "b.obj");
  ASSERT_TRUE(back) << back.error().line();
  double sum_before = 0, sum_glb = 0, sum_after = 0;
  const auto sum_v = [](const Mesh& m, double& sum) {
    const auto& uv = std::get<std::vector<float>>(find_stream(m, Semantic::uv)->values);
    for (std::size_t i = 1; i < uv.size(); i += 2) sum += uv[i] * uv[i];
  };
  sum_v(model.meshes[0], sum_before);
  sum_v(glb->meshes[0], sum_glb);
  sum_v(back->meshes[0], sum_after);
  EXPECT_NEAR(sum_before, sum_after, 1e-5);
}

TEST_F(RoundTrip, a_file_a_level_all_or_none) {
  Ladder ladder;
  ladder.original = make_model(test::grid(4));
  ladder.levels.resize(3);
  ladder.levels[1].model = make_model(test::grid(2));
  ladder.levels[2].model = make_model(test::grid(1));
  const auto report = write_ladder(ladder, folder_ / "m_LOD{level}.obj");
  ASSERT_TRUE(report) << report.error().line();
  EXPECT_TRUE(fs::exists(folder_ / "m_LOD2.obj"));
  EXPECT_EQ(report->files[1], folder_ / "m_LOD1.obj");
  ladder.levels[2].model = Model{};
  EXPECT_FALSE(write_ladder(ladder, folder_ / "n_LOD{level}.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "n_LOD0.ply"));
  EXPECT_FALSE(write_ladder(ladder, folder_ / "m.ply")) << "one PLY holds one level";
}

TEST_F(RoundTrip, names_decide_and_contents_are_checked) {
  const auto write_text = [&](const char* name, const std::string& text) {
    auto out = OutputFile::create(folder_ / name);
    out->write(text);
    EXPECT_TRUE(out->commit());
    return folder_ / name;
  };
  EXPECT_EQ(read_model(write_text("a.xyzzy", "x")).error().code, ErrorCode::unsupported);
  EXPECT_EQ(read_model(write_text("a.obj", ascii_ply())).error().code, ErrorCode::bad_format);
  EXPECT_EQ(read_model(write_text("a.ply", "")).error().code, ErrorCode::empty);
  EXPECT_EQ(read_model(folder_).error().code, ErrorCode::cannot_read);
  EXPECT_TRUE(read_model(write_text("A.PLY", ascii_ply())));
}

// Cut at every byte and with bits flipped: a model that validates, or an error.
TEST(Damage, any_bytes_give_a_model_or_an_error) {
  struct Case {
    Result<Model> (*read)(const std::string&);
    std::string whole;
  };
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  binary.append(36, '\0');
  binary += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  const std::vector<Case> cases{
      {ply, ascii_ply()},
      {ply, binary},
      {obj,
       "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\n"},
      {off, "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 1\n0 1 0 0 0 1 1\n3 0 1 2\n"},
      {stl,
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 "
       "0\nendloop\nendfacet\nendsolid\n"}};
  for (const Case& c : cases) {
    for (std::size_t n = 0; n <= c.whole.size(); ++n) {
      const auto model = c.read(c.whole.substr(0, n));
      EXPECT_TRUE(!model || validate(*model)) << n;
    }
    for (std::uint64_t i = 0; i < 2000; ++i) {
      std::string damaged = c.whole;
      for (int k = 0; k < 2; ++k) {
        const std::uint64_t r = random_bits(9, 2 * i + static_cast<std::uint64_t>(k));
        damaged[r % damaged.size()] = static_cast<char>(r >> 40);
      }
      const auto model = c.read(damaged);
      EXPECT_TRUE(!model || validate(*model)) << i;
    }
  }
}

}  // namespace
}  // namespace lodestone::io
