// What a model's surface is as a whole: connectivity, area, volume.
#pragma once

#include <cstdint>
#include <optional>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"

namespace lodestone::measure {

struct Shape {
  Topology topology;  ///< summed over all that is drawn; closed and manifold only when every mesh is
  double area = 0;    ///< world space, model units squared
  double volume = 0;  ///< signed, model units cubed; of a surface that isn't closed it depends on where its middle is
  /// Handles of all pieces together; without a value unless closed, manifold and consistently oriented.
  std::optional<std::int64_t> genus;
};

/// Of the default scene as drawn: all instances, bind pose. O(n log n). Errors: bad_argument (those of validate()),
/// cancelled.
Result<Shape> shape_of(const Model& model, const Task& task = {});

}  // namespace lodestone::measure
