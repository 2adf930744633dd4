// Meshopt compression in glTF under both its names: every form that the specification allows is read, and what is
// written says nothing of it any more.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/io/gltf/meshopt_detail.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"
#include "support/folder.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::Json;
using test::sheet_model;

class GltfMeshopt : public test::InFolder {
 protected:
  void SetUp() override {
    if (!has_meshopt()) GTEST_SKIP() << "built without meshopt";
  }
  void put(const std::string& name, const std::string& bytes) const {
    auto out = OutputFile::create(folder_ / name);
    out->write(bytes);
    ASSERT_TRUE(out->commit());
  }
};

// What stands for the uncompressed bytes: a file, a tagged buffer without bytes, a buffer that says nothing, a file
// that is not there.
enum class Fallback { whole, tagged, bare, missing };

// The sheet with all its views compressed under `name`: sheet.gltf, coded.bin, and plain.bin if there is a fallback.
struct Compressed {
  std::string json, coded, plain;
};
Compressed compressed(const char* name, Fallback fallback) {
  GltfBuilder b = sheet_model();
  Compressed out;
  out.plain = b.bin;
  for (std::size_t v = 0; v < 2; ++v) {
    Json& view = b.json["bufferViews"][v];
    const std::size_t at = view["byteOffset"].get<std::size_t>(), size = view["byteLength"].get<std::size_t>();
    std::string coded;
    if (v == 0) {
      coded = encode_meshopt_vertices(std::as_bytes(std::span(b.bin)).subspan(at, size), 12);
    } else {
      std::vector<std::uint32_t> corners;
      for (std::size_t i = at; i < at + size; i += 2) {
        std::uint16_t c = 0;
        std::memcpy(&c, b.bin.data() + i, 2);
        corners.push_back(c);
      }
      coded = encode_meshopt_triangles(corners, 16);
    }
    view["buffer"] = 1;
    view["extensions"][name] = {{"buffer", 0},
                                {"byteOffset", out.coded.size()},
                                {"byteLength", coded.size()},
                                {"byteStride", v == 0 ? 12 : 2},
                                {"mode", v == 0 ? "ATTRIBUTES" : "TRIANGLES"},
                                {"count", v == 0 ? size / 12 : size / 2}};
    out.coded += coded;
  }
  Json stand_in = {{"byteLength", out.plain.size()}};
  if (fallback == Fallback::whole) stand_in["uri"] = "plain.bin";
  if (fallback == Fallback::missing) stand_in["uri"] = "nowhere.bin";
  if (fallback == Fallback::tagged) stand_in["extensions"][name]["fallback"] = true;
  b.json["buffers"] = {{{"byteLength", out.coded.size()}, {"uri", "coded.bin"}}, stand_in};
  b.json["extensionsUsed"] = {"ACME_thing", name};
  if (fallback != Fallback::whole) b.json["extensionsRequired"] = {name};
  out.json = b.json.dump();
  return out;
}

TEST_F(GltfMeshopt, all_forms_are_read_and_leave_no_trace_in_what_is_written) {
  const auto plain = read_gltf_bytes(sheet_model().glb(), "plain.glb");
  ASSERT_TRUE(plain);
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    for (const Fallback form : {Fallback::whole, Fallback::tagged, Fallback::bare, Fallback::missing}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(static_cast<int>(form)));
      const Compressed made = compressed(name, form);
      put("sheet.gltf", made.json);
      put("coded.bin", made.coded);
      put("plain.bin", std::string(made.plain.size(), '\x7f'));  // must not be what is read
      const auto model = read_gltf(folder_ / "sheet.gltf");
      ASSERT_TRUE(model) << model.error().line();
      EXPECT_EQ(model->meshes[0].positions, plain->meshes[0].positions);
      EXPECT_EQ(model->meshes[0].triangles.size(), 18U);
      EXPECT_TRUE(model->warnings.empty()) << model->warnings[0];

      ASSERT_TRUE(write_gltf(*model, folder_ / "out.glb"));
      const std::string bytes = *read_file(folder_ / "out.glb");
      EXPECT_EQ(bytes.find("meshopt"), std::string::npos) << bytes;
      const Json json = test::open_glb(bytes).json;
      EXPECT_EQ(json["extensionsUsed"], Json({"ACME_thing"}));
      EXPECT_FALSE(json.contains("extensionsRequired"));
      const auto back = read_gltf(folder_ / "out.glb");
      ASSERT_TRUE(back) << back.error().line();
      EXPECT_EQ(back->meshes[0].positions, plain->meshes[0].positions);
    }
  }
}

TEST_F(GltfMeshopt, another_extension_that_says_where_a_view_lies_goes_and_is_told) {
  GltfBuilder b = sheet_model();
  b.json["bufferViews"][0]["extensions"] = {{"ACME_packed", {{"buffer", 0}, {"byteOffset", 7}}}, {"ACME_note", 5}};
  b.json["extensionsUsed"] = {"ACME_packed", "ACME_note"};
  const auto model = read_gltf_bytes(b.glb(), "x.glb");
  ASSERT_TRUE(model) << model.error().line();
  const auto report = write_gltf(*model, folder_ / "out.glb");
  ASSERT_TRUE(report) << report.error().line();
  const Json json = test::open_glb(*read_file(folder_ / "out.glb")).json;
  EXPECT_EQ(json["bufferViews"][0]["extensions"], Json({{"ACME_note", 5}}));
  EXPECT_EQ(json["extensionsUsed"], Json({"ACME_note"}));
  ASSERT_EQ(report->warnings.size(), 1U);
  EXPECT_NE(report->warnings[0].find("ACME_packed"), std::string::npos);
}

TEST_F(GltfMeshopt, a_fallback_is_not_read_but_belongs_to_the_model) {
  const Compressed made = compressed("KHR_meshopt_compression", Fallback::whole);
  put("sheet.gltf", made.json);
  put("coded.bin", made.coded);
  put("plain.bin", "cut off");
  const auto model = read_gltf(folder_ / "sheet.gltf");
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(model->files.size(), 2U) << "so that no output takes its place";
}

TEST_F(GltfMeshopt, a_buffer_without_bytes_that_something_needs_is_an_error) {
  const char* name = "KHR_meshopt_compression";
  for (const bool coded : {true, false}) {
    const Compressed made = compressed(name, Fallback::bare);
    Json json = Json::parse(made.json);
    if (coded) {
      json["bufferViews"][1]["extensions"][name]["buffer"] = 1;
    } else {
      json["bufferViews"][1].erase("extensions");
    }
    put("sheet.gltf", json.dump());
    put("coded.bin", made.coded);
    const auto model = read_gltf(folder_ / "sheet.gltf");
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().line().find("buffer 1: has no uri"), std::string::npos) << model.error().line();
  }
}

std::string from_hex(std::string_view text) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string out;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    out += static_cast<char>(digit(text[i]) << 4 | digit(text[i + 1]));
  }
  return out;
}

Result<std::string> decode(const std::string& coded, const MeshoptCoding& coding) {
  if (const auto ok = check_meshopt(coding, coded.size(), "x"); !ok) return fail(ok.error());
  return decode_meshopt(std::as_bytes(std::span(coded)), coding, "x");
}

// 37 elements as meshoptimizer 1.3 (npm) packs them at level 3: a column of each control mode and each kind of delta.
// Four words: 7, two 16-bit curves, a float that grows, noise that becomes the number of the element.
constexpr std::string_view kVersion1 =
    "a1aa736801004e3a2612feead6c2ae9a86725e4a36220efae6d2beaa96826e5a46321e0a091d3145596d0a2a95555550000000008f8f8f8f"
    "8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f8f151555555555555555554000000110001f0a08f8f4c4f4c4"
    "f26218f81c3ce262f262e262f1311e7e1f00070103010f1700deb98ec941a66e699e064e0981992effeaaaaa565ec60e81aa80000005feff"
    "58f87266a838fbf18b1fc6f361b16d1f00c0081db19805fcffe3bafaaf831853daf0062e1427291f009696229c1905feff444666b0a4d06f"
    "ecc1c558567ecc811f003deeb64bf00000000007000000000000000000803f6c59883c00016200";

TEST_F(GltfMeshopt, version_1_of_the_attribute_codec_is_decoded_and_broken_streams_are_errors) {
  const std::string coded = from_hex(kVersion1);
  const MeshoptCoding coding{MeshoptMode::attributes, MeshoptFilter::none, 37, 16};
  const Result<std::string> got = decode(coded, coding);
  ASSERT_TRUE(got) << got.error().line();
  std::uint32_t noise = 1;
  for (std::uint32_t i = 0; i < 37; ++i) {
    std::array<std::uint32_t, 4> words;
    std::memcpy(words.data(), got->data() + 16 * i, 16);
    const int n = static_cast<int>(i);
    noise = noise * 1664525 + 1013904223;
    EXPECT_EQ(words[0], 7U);
    EXPECT_EQ(words[1] & 0xffff, static_cast<std::uint16_t>(300 * n - 5 * n * n));
    EXPECT_EQ(words[1] >> 16, static_cast<std::uint16_t>(-200 * n));
    EXPECT_EQ(std::bit_cast<float>(words[2]), 1 + 0.25F * static_cast<float>(i));
    EXPECT_EQ(words[3], i < 20 ? noise : i);
  }
  for (std::size_t n = 0; n < coded.size(); ++n) EXPECT_FALSE(decode(coded.substr(0, n), coding)) << n;
  EXPECT_FALSE(decode(coded + '\0', coding));
  EXPECT_FALSE(decode(coded, {coding.mode, coding.filter, 38, 16}));
  std::string mode = coded;
  mode.back() = 3;
  EXPECT_FALSE(decode(mode, coding)) << "deltas of an unknown kind";
  EXPECT_FALSE(decode(coded, {coding.mode, coding.filter, std::size_t{1} << 40, 16}));
  EXPECT_FALSE(decode(coded, {coding.mode, coding.filter, 37, 260}));
}

TEST_F(GltfMeshopt, the_color_filter_gives_back_red_green_blue_and_alpha) {
  // Luma, orange and green of (167, 97, 87, 255), and of a white with four bits and about half alpha.
  const std::string stored = from_hex(
      "7028f1ff"
      "0f00000c");
  const std::string coded = encode_meshopt_vertices(std::as_bytes(std::span(stored)), 4);
  const auto got = decode(coded, {MeshoptMode::attributes, MeshoptFilter::color, 2, 4});
  ASSERT_TRUE(got) << got.error().line();
  const int want[] = {167, 97, 87, 255, 255, 255, 255, 136};
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(static_cast<unsigned char>((*got)[k]), want[k], 1) << k;
  }
  EXPECT_FALSE(decode(coded, {MeshoptMode::attributes, MeshoptFilter::color, 1, 12}));
}

}  // namespace
}  // namespace lodestone::io
