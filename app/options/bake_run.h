// What new surfaces take over from the model that they were made from: normals, colours, textures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

/// --texture-size and --no-attributes.
OptionGroup baked_group();

struct BakePlan {
  bool attributes = true;
  std::uint32_t texture_size = 0;  ///< 0 = normals and colours of vertices alone
};
/// Errors: bad_argument.
Result<BakePlan> bake_plan(const Arguments& arguments);

/// What surfaces take from one model. The model's textures are decoded for it.
class AttributeSource {
 public:
  /// Warnings tell of textures that can't be decoded. Errors: those of decoding and of bake::BakeSource.
  static Result<AttributeSource> create(const Model& model, const BakePlan& plan, std::vector<std::string>& warnings,
                                        const Task& task);
  /// Gives normals and colours to the surface's vertices, or an atlas with textures. `level` names these apart.
  /// Errors: those of `bake`.
  Result<void> add_to(Model& surface, std::size_t level, const Task& task) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace lodestone::app
