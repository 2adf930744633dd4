// Any bytes as points: a cloud that is sound, or an error; never a crash, a hang, or much memory. The first byte says
// the format.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lodestone/base/check.h"
#include "lodestone/io/points/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr const char* kNames[] = {"fuzz.pcd", "fuzz.las", "fuzz.xyz", "fuzz.ply"};
  const auto cloud = lodestone::io::read_points(std::as_bytes(std::span(data + 1, size - 1)), kNames[data[0] % 4]);
  if (!cloud) return 0;
  LODESTONE_CHECK(cloud->size() > 0 && cloud->size() <= cloud->file_points, "there are points");
  LODESTONE_CHECK(cloud->normals.empty() || cloud->normals.size() == cloud->size(), "one normal a point");
  LODESTONE_CHECK(cloud->colors.empty() || cloud->colors.size() == cloud->size(), "one colour a point");
  for (const lodestone::Vec3f& p : cloud->positions) LODESTONE_CHECK(lodestone::is_finite(p), "positions are finite");
  return 0;
}
