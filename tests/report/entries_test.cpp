// What reports validates what it is given.
#include <gtest/gtest.h>

#include "lodestone/report/ladder_report.h"
#include "tests/support/broken.h"

namespace lodestone::report {
namespace {

TEST(Entries, of_report_refuse_a_broken_ladder) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    chain::LadderResult result;
    test::expect_bad_argument(ladder_report(result), "no level");
    result.ladder.levels.resize(2);
    result.ladder.original = test::whole_model();
    result.ladder.levels[1].model = model;
    test::expect_refused(ladder_report(result), "level 1, " + line, name);
    test::expect_refused(draw_levels(result.ladder), "level 1, " + line, name);
    result.ladder.original = model;
    test::expect_refused(ladder_report(result), line, name);
    test::expect_refused(draw_levels(result.ladder), line, name);
  }
}

}  // namespace
}  // namespace lodestone::report
