// What no operation may work on: models, points and volumes, each broken in one way.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/core/volume.h"

namespace lodestone::test {

/// One mesh placed once, with wedges, attributes, groups and a material. Valid, closed.
Model whole_model();

struct BrokenModel {
  std::string name;
  Model model;
  std::string line;  ///< of the Error
  bool mesh;         ///< meshes[0] alone is broken already
};
std::vector<BrokenModel> broken_models();

struct BrokenCloud {
  std::string name;
  PointCloud cloud;
  std::string line;
};
/// Of a whole one of some points with normals and colours.
PointCloud whole_cloud();
std::vector<BrokenCloud> broken_clouds();

struct BrokenBits {
  std::string name;
  BitVolume volume;
};
/// Of a whole one of 8 x 8 x 8 voxels with a block inside.
BitVolume whole_bits();
std::vector<BrokenBits> broken_bits();

/// That an operation on something broken gave this very error.
template <class T>
void expect_refused(const Result<T>& result, const std::string& line, const std::string& what) {
  ASSERT_FALSE(result) << what;
  EXPECT_EQ(result.error().code, ErrorCode::bad_argument) << what;
  EXPECT_EQ(result.error().line(), line) << what;
}

/// The same where only the code matters.
template <class T>
void expect_bad_argument(const Result<T>& result, const std::string& what) {
  ASSERT_FALSE(result) << what;
  EXPECT_EQ(result.error().code, ErrorCode::bad_argument) << what << ": " << result.error().line();
}

}  // namespace lodestone::test
