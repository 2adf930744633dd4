#include "lodestone/report/ladder_report.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace lodestone::report {
namespace {

ReportData report_of(Mesh mesh, int threads = 0) {
  chain::LadderOptions options;
  options.ratios = {0.5, 0.25};
  options.distance.samples = 5000;
  auto built = chain::build_ladder(make_model(std::move(mesh)), options, Task::root({}, threads));
  PictureOptions pictures;
  pictures.width = 160;
  pictures.height = 120;
  io::WriteReport written;
  for (std::size_t i = 0; i < built->ladder.levels.size(); ++i) {
    written.files.emplace_back("out/level.glb");
    written.level_bytes.push_back(1000);
  }
  ReportData data = *ladder_report(*built, pictures, Task::root({}, threads));
  add_files(data, written);
  return data;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(LadderReport, tells_levels_and_needs_nothing_from_elsewhere) {
  ReportData data = report_of(test::torus(30));
  data.name = "</title><script>alert(1)</script>";
  data.options = {{"--ratio", "<b>", true}};
  const std::string page = html_report(data);
  EXPECT_TRUE(has(page, "3 levels, from 1,800 triangles down to 450"));
  EXPECT_TRUE(has(page, "Certified:"));
  for (const char* bad : {"<script", "http:", "https:", "<link", "@import", "url(", "<b>", "level.glb", "nan"}) {
    EXPECT_FALSE(has(page, bad)) << bad;
  }
  EXPECT_TRUE(has(page, "&lt;script&gt;"));
  for (std::size_t at = page.find("src="); at != std::string::npos; at = page.find("src=", at + 1)) {
    EXPECT_EQ(page.substr(at, 15), "src=\"data:image");
  }
}

TEST(LadderReport, same_page_for_any_thread_count) {
  EXPECT_EQ(html_report(report_of(test::torus(30), 1)), html_report(report_of(test::torus(30), 7)));
}

TEST(LadderReport, warnings_in_plain_words) {
  EXPECT_TRUE(plain_warnings(report_of(test::torus(30))).empty());
  const auto open = plain_warnings(report_of(test::grid(20, 0.2F)));
  ASSERT_EQ(open.size(), 1U);
  EXPECT_TRUE(has(open[0], "80 edges are open"));
  ReportData seams = report_of(test::cube_with_seams());
  EXPECT_EQ(seams.seam_vertices, 8U);
  EXPECT_TRUE(has(plain_warnings(seams).front(), "8 vertices lie on seams"));
  ReportData uncertain = report_of(test::torus(30));
  uncertain.levels[1].error.kind = ErrorKind::measured;
  uncertain.levels[2].shape.topology.components = 0;
  const auto told = plain_warnings(uncertain);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_TRUE(has(told[0], "level 1") && has(told[0], "not certified"));
  EXPECT_TRUE(has(told[1], "Level 2 has 0 of the original's 1 pieces"));
  EXPECT_TRUE(has(html_report(uncertain), "Certified:")) << "that is about the coarsest";
  uncertain.levels[2].error.kind = ErrorKind::measured;
  EXPECT_TRUE(has(html_report(uncertain), "As far as was found,"));
}

TEST(LadderReport, only_the_original) {
  ReportData data = report_of(test::tetrahedron());
  EXPECT_EQ(data.levels.size(), 1U);
  const std::string page = html_report(data);
  EXPECT_TRUE(has(page, "No level could be made"));
  EXPECT_TRUE(has(page, "fewest"));
}

}  // namespace
}  // namespace lodestone::report
