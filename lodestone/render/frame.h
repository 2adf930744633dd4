// Frame: what a picture shows where, without colours. For comparing pictures; whatever draws (triangles here, splats
// elsewhere) can fill one.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/math/camera.h"
#include "lodestone/render/scene.h"

namespace lodestone::render {

/// Rows from the top, one entry a pixel in each list.
struct Frame {
  std::uint32_t width = 0, height = 0;
  int samples = 0;                     ///< of each pixel
  std::vector<std::uint8_t> coverage;  ///< samples that see something: 0 to `samples`
  std::vector<float> depth;  ///< of the nearest sample, along the view direction, model units; infinity where none
  std::vector<std::uint32_t> triangle;  ///< that this sample sees, by number over all instances; kNone where none
};

/// Sides of a picture, pixels.
inline constexpr std::uint32_t kMostSide = 16384;

/// Draws what render() draws, samples at the same places. `samples`: 1 (the pixel's middle) or 4. Alpha masks have
/// their holes. The same for any number of threads. O(triangles + pixels); some 40 bytes a triangle
/// and 10 a pixel. Errors: bad_argument (a camera that can't be, a side of 0 or above kMostSide, samples), cancelled.
Result<Frame> rasterize(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                        int samples = 4, Task task = {});

}  // namespace lodestone::render
