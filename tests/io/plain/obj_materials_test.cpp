// Materials and parts of OBJ: what is found, what comes out of an OBJ as it went in, and what glTF gets of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lodestone/base/file.h"
#include "lodestone/io/images/encode.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"
#include "support/folder.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;

const std::string kPng = std::string("\x89PNG\r\n\x1a\n", 8) + "no more of it";

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";

void put_file(const fs::path& path, const std::string& content) {
  auto out = OutputFile::create(path);
  ASSERT_TRUE(out);
  out->write(content);
  EXPECT_TRUE(out->commit());
}

class ObjMaterialsTest : public test::InFolder {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "in");
    fs::create_directories(folder_ / "out");
  }
  fs::path put(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / "in" / name;
    fs::create_directories(path.parent_path());
    put_file(path, text);
    return path;
  }
  std::string text(const std::string& name) {
    const auto text = read_file(folder_ / "out" / name);
    return text ? *text : std::string();
  }
  Model read() {
    auto model = read_model(folder_ / "in" / "m.obj");
    EXPECT_TRUE(model) << model.error().line();
    return model ? std::move(*model) : Model();
  }
  std::vector<std::string> write(const Model& model, const std::string& name) {
    const auto report = write_model(model, folder_ / "out" / name);
    EXPECT_TRUE(report) << report.error().line();
    return report ? report->warnings : std::vector<std::string>();
  }
  // All pixels of one colour.
  std::string picture(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t alpha = 255) {
    Pixels pixels{8, 8, {}};
    for (int i = 0; i < 64; ++i) pixels.rgba.insert(pixels.rgba.end(), {r, g, b, alpha});
    const auto image = png_image(pixels, "p");
    EXPECT_TRUE(image);
    const auto* bytes = reinterpret_cast<const char*>((*image)->encoded.data());
    return std::string(bytes, (*image)->encoded.size());
  }
};

TEST_F(ObjMaterialsTest, textures_are_found_where_they_are_today) {
  const struct {
    const char *named, *lies;
  } cases[] = {
      {"tex.png", "materials/tex.png"},             // beside an MTL in a subfolder
      {"tex.png", "tex.png"},                       // beside the OBJ
      {"../textures/tex.png", "textures/tex.png"},  // as the MTL sees it
      {"C:\\art\\shed\\textures\\tex.png", "textures/tex.png"},
      {"D:/art/tex.png", "materials/tex.png"},
      {"/home/somebody/textures/tex.png", "textures/tex.png"},
      {"Textures\\TEX.PNG", "textures/tex.png"},  // letters of the other case
  };
  for (const auto& c : cases) {
    fs::remove_all(folder_ / "in");
    put("m.obj", "mtllib Materials\\M.mtl\n" + kTriangle);
    put("materials/m.mtl", std::string("newmtl a\nmap_Kd ") + c.named + "\n");
    put(c.lies, kPng);
    const Model model = read();
    ASSERT_EQ(model.materials.size(), 1U);
    ASSERT_NE(model.materials[0].base_color_texture, nullptr) << c.named;
    EXPECT_EQ(model.materials[0].base_color_texture->encoded.size(), kPng.size()) << c.named << " in " << c.lies;
    EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
  }
}

TEST_F(ObjMaterialsTest, nothing_outside_the_folder_is_opened) {
  put_file(folder_ / "secret.png", kPng);
  put("m.obj", "mtllib materials/m.mtl\n" + kTriangle);
  for (const std::string& name : {std::string("../../secret.png"), (folder_ / "secret.png").string()}) {
    put("materials/m.mtl", "newmtl a\nmap_Kd " + name + "\n");
    const Model model = read();
    EXPECT_TRUE(model.materials[0].base_color_texture->encoded.empty()) << name;
    EXPECT_EQ(model.warnings.size(), 1U);
  }
}

TEST_F(ObjMaterialsTest, an_mtl_keeps_its_lines_and_textures_from_obj_to_obj) {
  const std::string lines[] = {"Ka 0.1 0.2 0.3",
                               "Ks 0.5 0.5 0.5",
                               "Ns 96.078431",
                               "Ni 1.45",
                               "illum 2",
                               "Ke 0 0.25 0",
                               "map_d -imfchan m mask.png",
                               "map_Bump -bm 0.5 bump.png",
                               "map_Ks gone.png",
                               "map_Kd -s 2 2 1 color.png",
                               "disp height map.png"};
  std::string mtl = "newmtl a\nKd 0.5 0.25 1\n";
  for (const std::string& line : lines) mtl += line + "\n";
  put("m.mtl", mtl);
  for (const char* name : {"mask.png", "bump.png", "color.png", "height map.png"}) put(name, kPng + name);
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  write(read(), "n.obj");
  const std::string out = text("n.mtl");
  for (const std::string& line : lines)
    EXPECT_NE(out.find("\n" + line + "\n"), std::string::npos) << line << "\n" << out;
  EXPECT_NE(out.find("\nKd 0.5 0.25 1\n"), std::string::npos);
  EXPECT_EQ(out.find("Pr"), std::string::npos) << "Ns says it";
  for (const char* name : {"mask.png", "bump.png", "color.png", "height map.png"}) EXPECT_EQ(text(name), kPng + name);
  EXPECT_EQ(out.find("map_Kd"), out.rfind("map_Kd")) << out;
}

TEST_F(ObjMaterialsTest, a_file_named_in_two_ways_is_written_once) {
  put("tex.png", kPng);
  put("m.mtl", "newmtl a\nmap_Kd TEX.png\nmap_d C:\\art\\tex.png\n");
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  write(read(), "n.obj");
  EXPECT_NE(text("n.mtl").find("map_Kd tex.png\nmap_d tex.png\n"), std::string::npos) << text("n.mtl");
  EXPECT_FALSE(fs::exists(folder_ / "out" / "TEX.png"));
}

TEST_F(ObjMaterialsTest, gltf_gets_what_it_holds_and_the_rest_is_told) {
  put("color.png", picture(200, 100, 50, 128));
  put("normal.png", picture(128, 128, 255));
  put("glow.png", picture(0, 80, 0));
  put("m.mtl",
      "newmtl a\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 30\nKe 0.5 0.25 0\nillum 2\nmap_Kd color.png\nmap_d color.png\n"
      "map_Bump -bm 0.5 normal.png\nmap_Ke glow.png\n");
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  const auto warnings = write(read(), "m.gltf");
  std::string json = text("m.gltf");
  std::erase_if(json, [](char c) { return c == ' ' || c == '\n'; });
  for (const char* part : {"\"emissiveFactor\":[0.5,0.25,0.0]", "\"emissiveTexture\"", "\"normalTexture\"",
                           "\"scale\":0.5", "\"alphaMode\":\"BLEND\"", "\"baseColorTexture\""}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << "\n" << json;
  }
  EXPECT_EQ(warnings, (std::vector<std::string>{"properties of materials were left out: Ks, illum"}));
  const auto back = read_model(folder_ / "out" / "m.gltf");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_NEAR(back->materials[0].roughness, 0.5, 1e-6) << "the fourth root of 2 / (30 + 2)";
}

TEST_F(ObjMaterialsTest, a_map_without_alpha_makes_nothing_transparent) {
  put("color.png", picture(200, 100, 50));
  put("m.mtl", "newmtl a\nmap_Kd color.png\nmap_d color.png\n");
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  EXPECT_EQ(write(read(), "m.gltf"), (std::vector<std::string>{"properties of materials were left out: map_d"}));
  EXPECT_EQ(text("m.gltf").find("BLEND"), std::string::npos);
  write(read(), "n.obj");
  EXPECT_NE(text("n.mtl").find("map_d color.png"), std::string::npos) << "the OBJ keeps its line";
}

TEST_F(ObjMaterialsTest, a_damaged_library_is_read_in_bounded_time) {
  std::string mtl = "newmtl a\n";
  for (int i = 0; i < 20'000; ++i) mtl += "Ns 10\n";
  for (int i = 0; i < 20'000; ++i) mtl += "newmtl m" + std::to_string(i) + "\nmap_Kd no" + std::to_string(i) + ".png\n";
  put("m.mtl", mtl);
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  const Model model = read();
  ASSERT_EQ(model.materials.size(), 1U);
  EXPECT_EQ(model.materials[0].mtl_lines.size(), 256U);
  const auto told = [&](const std::string& part) {
    return std::any_of(model.warnings.begin(), model.warnings.end(),
                       [&](const std::string& w) { return w.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(told("19,744 lines of the material library were left out"));
  EXPECT_TRUE(told("15,904 lines of the material libraries would name more than 4,096 textures"));
  write(model, "m.gltf");
}

TEST_F(ObjMaterialsTest, a_height_map_is_no_normal_map) {
  put("height.png", picture(200, 200, 200));
  put("m.mtl", "newmtl a\nbump height.png\n");
  put("m.obj", "mtllib m.mtl\n" + kTriangle);
  EXPECT_EQ(write(read(), "m.gltf"), (std::vector<std::string>{"properties of materials were left out: bump"}));
  EXPECT_EQ(text("m.gltf").find("normalTexture"), std::string::npos);
}

TEST_F(ObjMaterialsTest, without_a_highlight_a_material_is_rough) {
  const std::pair<const char*, double> cases[] = {{"Ns 30\n", 0.5},
                                                  {"Ns 30\nKs 0 0 0\n", 1},
                                                  {"Ns 30\nKs 1 1 1\nillum 1\n", 1},
                                                  {"Ns 30\nPr 0.75\n", 0.75},
                                                  {"illum 2\n", 1}};
  for (const auto& [lines, roughness] : cases) {
    put("m.mtl", std::string("newmtl a\n") + lines);
    put("m.obj", "mtllib m.mtl\n" + kTriangle);
    EXPECT_NEAR(read().materials[0].roughness, roughness, 1e-6) << lines;
  }
}

// ---- parts ----

TEST_F(ObjMaterialsTest, parts_and_their_groups_keep_their_names) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  put("m.obj", corners + "o body\nf 1 2 3\ng lid\nf 2 4 3\no wheel\nf 1 3 4\no body\nf 4 2 1\n");
  const Model model = read();
  write(model, "n.obj");
  const std::string out = text("n.obj");
  EXPECT_NE(out.find("o body\nf 1 2 3\ng lid\nf 2 4 3\no wheel\nf 1 3 4\no body\nf 4 2 1\n"), std::string::npos) << out;
  const auto back = read_model(folder_ / "out" / "n.obj");
  ASSERT_TRUE(back);
  ASSERT_EQ(back->meshes[0].groups.size(), 3U);
  for (std::size_t g = 0; g < 3; ++g) {
    EXPECT_EQ(back->meshes[0].groups[g].name, model.meshes[0].groups[g].name);
    EXPECT_EQ(back->meshes[0].groups[g].object, model.meshes[0].groups[g].object);
  }
}

TEST_F(ObjMaterialsTest, faces_before_the_first_part_are_in_no_part) {
  put("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\no body\nf 2 4 3\n");
  write(read(), "n.obj");
  EXPECT_NE(text("n.obj").find("o default\nf 1 2 3\no body\nf 2 4 3\n"), std::string::npos) << text("n.obj");
}

}  // namespace
}  // namespace lodestone::io
