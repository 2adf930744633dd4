// What measures validates what it is given.
#include <gtest/gtest.h>

#include "lodestone/measure/attributes.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/hausdorff.h"
#include "lodestone/measure/heat.h"
#include "lodestone/measure/image.h"
#include "lodestone/measure/shape.h"
#include "tests/support/broken.h"

namespace lodestone::measure {
namespace {

TEST(Entries, of_measure_refuse_a_broken_model_on_either_side) {
  const Model whole = test::whole_model();
  ImageOptions pictures;
  pictures.views = 4;
  pictures.size_px = 16;
  const Result<Reference> reference = Reference::create(whole);
  const Result<ImageReference> images = ImageReference::create(whole, pictures);
  ASSERT_TRUE(reference && images);
  for (const auto& [name, broken, line, mesh] : test::broken_models()) {
    test::expect_refused(Reference::create(broken), line, name);
    test::expect_refused(reference->distance_to(broken), line, name);
    test::expect_refused(distance(broken, whole), line, name);
    test::expect_refused(distance(whole, broken), line, name);
    test::expect_refused(hausdorff(broken, whole, 0.01), line, name);
    test::expect_refused(hausdorff(whole, broken, 0.01), line, name);
    test::expect_refused(heat_map(broken, whole), line, name);
    test::expect_refused(heat_map(whole, broken), line, name);
    test::expect_refused(attribute_deviation(broken, whole), line, name);
    test::expect_refused(attribute_deviation(whole, broken), line, name);
    test::expect_refused(ImageReference::create(broken, pictures), line, name);
    test::expect_refused(images->deviation_of(broken), line, name);
    test::expect_refused(shape_of(broken), line, name);
  }
}

}  // namespace
}  // namespace lodestone::measure
