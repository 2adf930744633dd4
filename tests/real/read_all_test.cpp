// Reading the shared meshes: counts as their table tells them.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "lodestone/core/topology.h"
#include "lodestone/io/read.h"

namespace lodestone {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* file;
  std::size_t vertices, triangles;  // as the file stores them

  friend std::ostream& operator<<(std::ostream& out, const Known& known) { return out << known.file; }
};

class SharedMeshes : public ::testing::TestWithParam<Known> {};

TEST_P(SharedMeshes, has_the_counts_of_its_table) {
  const auto model = io::read_model(fs::path(LODESTONE_SHARED_DATA) / "meshes" / GetParam().file);
  ASSERT_TRUE(model) << model.error().line();
  EXPECT_EQ(model->file_vertices, GetParam().vertices);
  EXPECT_EQ(drawn_triangles(*model), GetParam().triangles);
}

INSTANTIATE_TEST_SUITE_P(Table, SharedMeshes,
                         ::testing::Values(Known{"igea.ply", 134345, 268686}, Known{"igea_strips.ply", 134345, 268686},
                                           Known{"dragon_vrip_res2.ply", 100250, 202520},
                                           Known{"tree.ply", 74117, 111374}, Known{"buddha_100k.ply", 49950, 100000},
                                           Known{"bun_zipper.ply", 35947, 69451}, Known{"cycloidal.ply", 21384, 43368},
                                           Known{"fandisk.obj", 6475, 12946}, Known{"camelhead.off", 11381, 22704},
                                           Known{"robie_house.ply", 49531, 25261}, Known{"city.obj", 12845, 24086},
                                           Known{"airboat.obj", 5797, 11566}, Known{"homer.obj", 6002, 12000}),
                         [](const auto& param) {
                           std::string name = param.param.file;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

TEST(SharedMeshes, strips_and_triangles_of_igea_are_the_same_mesh) {
  const auto strips = io::read_model(fs::path(LODESTONE_SHARED_DATA) / "meshes/igea_strips.ply");
  ASSERT_TRUE(strips);
  const Topology t = topology_of(strips->meshes[0]);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.inconsistent_edges, 0U);
}

TEST(SharedBroken, every_file_gives_a_model_or_one_line) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(LODESTONE_SHARED_DATA) / "broken")) {
    if (!entry.is_regular_file() || !io::is_model_extension(entry.path().extension().string())) continue;
    const auto model = io::read_model(entry.path());
    if (model) continue;
    EXPECT_NE(model.error().line().find(entry.path().filename().string()), std::string::npos) << model.error().line();
    EXPECT_EQ(model.error().line().find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace lodestone
