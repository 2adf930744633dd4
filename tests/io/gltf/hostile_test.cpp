// glTF files that lie: every one is an error or a valid model, within a small multiple of the file's memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "io/gltf/builder.h"
#include "lodestone/base/file.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/gltf/write.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::Json;
using test::sheet_model;

void expect_refused(const std::string& bytes, const std::string& what) {
  const Result<Model> model = read_gltf_bytes(bytes, "lie.glb");
  ASSERT_FALSE(model) << what;
  const std::string line = model.error().line();
  EXPECT_EQ(line.find("lie.glb"), 0U) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

TEST(GltfHostile, cut_off_anywhere) {
  const std::string whole = sheet_model().glb();
  for (std::size_t n = 0; n < whole.size(); n += 7) expect_refused(whole.substr(0, n), std::to_string(n));
}

TEST(GltfHostile, container_lengths_that_lie) {
  const std::string whole = sheet_model().glb();
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, whole.data() + 12, 4);
  for (const std::size_t at : {std::size_t{8}, std::size_t{12}, std::size_t{20} + json_size}) {
    for (const std::uint32_t lie : {0U, 3U, 0x7fffffffU, 0xffffffffU}) {
      std::string bytes = whole;
      std::memcpy(bytes.data() + at, &lie, 4);
      expect_refused(bytes, std::to_string(at) + " " + std::to_string(lie));
    }
  }
}

TEST(GltfHostile, numbers_that_lie) {
  const struct {
    const char* pointer;
    Json value;
  } lies[] = {{"/accessors/0/count", 17},
              {"/accessors/0/count", 1099511627776},
              {"/accessors/0/count", -1},
              {"/accessors/0/count", 1.5},
              {"/accessors/0/count", "16"},
              {"/accessors/0/byteOffset", 4},
              {"/accessors/0/byteOffset", 9007199254740991},
              {"/accessors/0/componentType", 5130},
              {"/accessors/0/type", "VEC9"},
              {"/accessors/0/type", "VEC2"},
              {"/accessors/0/bufferView", 9},
              {"/accessors/1/componentType", 5126},
              {"/bufferViews/0/byteLength", 1099511627776},
              {"/bufferViews/0/byteOffset", 9007199254740991},
              {"/bufferViews/0/byteStride", 4},
              {"/bufferViews/0/byteStride", 65536},
              {"/bufferViews/0/buffer", 1},
              {"/meshes/0/primitives/0/attributes", 7},
              {"/meshes/0/primitives/0/attributes/POSITION", 2},
              {"/meshes/0/primitives/0/indices", 5},
              {"/meshes/0/primitives/0/material", 0},
              {"/meshes/0/primitives/0/mode", 1},
              {"/nodes/0/mesh", 1},
              {"/nodes/0/children", {0}},
              {"/nodes/0/children", {4}},
              {"/nodes/0/translation", {0, 0}},
              {"/nodes/0/matrix", "identity"},
              {"/scene", 3},
              {"/scenes/0/nodes", {0, 0}},
              {"/asset/version", "1.0"},
              {"/meshes", 5}};
  for (const auto& lie : lies) {
    GltfBuilder b = sheet_model();
    b.json[Json::json_pointer(lie.pointer)] = lie.value;
    expect_refused(b.glb(), std::string(lie.pointer) + " " + lie.value.dump());
  }
}

TEST(GltfHostile, positions_that_are_no_numbers_are_an_error_and_other_values_become_zero) {
  for (const bool positions : {true, false}) {
    GltfBuilder b = sheet_model();
    Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = b.accessor(std::vector<float>(32, std::numeric_limits<float>::quiet_NaN()), "VEC2", 2);
    if (positions) {
      const float infinite = std::numeric_limits<float>::infinity();
      std::memcpy(b.bin.data() + 12, &infinite, 4);
      expect_refused(b.glb(), "infinite");
      continue;
    }
    const auto model = read_gltf_bytes(b.glb(), "x.glb");
    ASSERT_TRUE(model) << model.error().line();
    ASSERT_EQ(model->warnings.size(), 1U);
    EXPECT_NE(model->warnings[0].find("not finite"), std::string::npos);
    for (const float v : std::get<std::vector<float>>(model->meshes[0].attributes.at(0).values)) EXPECT_EQ(v, 0);
  }
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Each of these would take gigabytes if the parts that share bytes were simply unfolded.
TEST(GltfHostile, small_files_take_little_memory) {
  const long before = peak_kilobytes();
  GltfBuilder shared;  // 1,000 meshes of one accessor
  std::vector<std::uint16_t> corners(30000);
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint16_t>(i);
  const std::size_t p = shared.positions(std::vector<float>(90000, 1.0F)), c = shared.indices(corners);
  for (int i = 0; i < 1000; ++i) {
    shared.json["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", p}, {"_A", p}, {"_B", p}}}, {"indices", c}}}}});
  }
  shared.json["nodes"] = {{{"mesh", 0}}};
  expect_refused(shared.glb(), "meshes that share");

  GltfBuilder zeros = sheet_model();  // 2,000 attributes without a byte in the file
  const std::string padding(100000, ' ');
  for (int i = 0; i < 2000; ++i) {
    zeros.json["accessors"].push_back({{"componentType", 5126}, {"count", 200000}, {"type", "VEC4"}});
    zeros.json["meshes"][0]["primitives"][0]["attributes"]["_A" + std::to_string(i)] =
        zeros.json["accessors"].size() - 1;
  }
  zeros.bin += padding;
  expect_refused(zeros.glb(), "accessors without bytes");

  GltfBuilder many = sheet_model();  // 3,000 nodes with 10,000 instances each
  const std::size_t t = many.accessor(std::vector<float>(30000, 0.0F), "VEC3", 3);
  Json roots = Json::array();
  many.json["nodes"].clear();
  for (std::size_t i = 0; i < 3000; ++i) {
    many.json["nodes"].push_back(
        {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", t}}}}}}}});
    roots.push_back(i);
  }
  many.json["scenes"][0]["nodes"] = roots;
  expect_refused(many.glb(), "instances");
  EXPECT_LT(peak_kilobytes() - before, 700000) << "the files have less than 2 MB";
}

TEST(GltfHostile, nesting_without_end) {
  std::string json = R"({"asset":{"version":"2.0"},"extras":)";
  expect_refused(test::make_glb(json + std::string(1000000, '['), ""), "nesting");
}

// What reading did not need to look at may still be of any type when the document is written.
TEST(GltfHostile, documents_with_wrong_types_are_an_error_of_writing_not_a_crash) {
  const fs::path folder = fs::temp_directory_path() / ("lodestone_gltf_types_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Json wrong[] = {nullptr,           true,           5,         -1, 1e300, "text", Json::array(),
                        {1, "a", nullptr}, Json::object(), {{"x", 1}}};
  const char* members[] = {"/nodes/0/children",
                           "/nodes/0/extensions",
                           "/nodes/0/extras",
                           "/nodes/0/skin",
                           "/nodes/0/weights",
                           "/nodes/0/name",
                           "/animations",
                           "/skins",
                           "/extensionsUsed",
                           "/extensionsRequired",
                           "/images",
                           "/textures",
                           "/materials",
                           "/cameras",
                           "/meshes/0/name",
                           "/meshes/0/extras",
                           "/meshes/0/extensions",
                           "/meshes/0/weights",
                           "/accessors/0/min",
                           "/accessors/0/sparse",
                           "/accessors/0/normalized",
                           "/bufferViews/0/extensions",
                           "/bufferViews/0/target",
                           "/meshes/0/primitives/0/extensions",
                           "/meshes/0/primitives/0/targets",
                           "/scenes/0/name"};
  int written = 0;
  for (const char* member : members) {
    for (const Json& value : wrong) {
      GltfBuilder b = sheet_model();
      b.json[Json::json_pointer(member)] = value;
      Result<Model> model = read_gltf_bytes(b.glb(), "x.glb");
      if (!model) continue;
      ASSERT_TRUE(validate(*model)) << member << value;
      Ladder ladder;
      ladder.levels.resize(2);
      ladder.original = *model;
      ladder.levels[1].model = std::move(*model);
      WriteOptions options;
      options.screen_coverage = {{0.5, 0}};
      for (const Compression c : {Compression::none, Compression::draco}) {
        options.compression = c;
        const auto report = write_gltf(ladder, folder / "x.glb", options);
        if (!report) {
          EXPECT_EQ(report.error().code, ErrorCode::bad_format) << report.error().line();
          continue;
        }
        ++written;
        const auto back = read_gltf(folder / "x.glb");
        EXPECT_TRUE(back) << member << ' ' << value << ": " << back.error().line();
      }
    }
  }
  EXPECT_GT(written, 100);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace lodestone::io
