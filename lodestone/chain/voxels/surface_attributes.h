// What new surfaces take over from the model that they were made from: normals, colours, textures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/material.h"
#include "lodestone/core/model.h"

namespace lodestone::chain {

/// Makes an image file of pixels, as io::png_image() does: `chain` knows no file formats. `name` has no ending.
using ImageEncoder = std::function<Result<std::shared_ptr<const Image>>(const Pixels& pixels, std::string name)>;

struct SurfaceAttributeOptions {
  bool attributes = true;          ///< false: positions alone
  std::uint32_t texture_size = 0;  ///< texels a side of an atlas; 0 = normals and colours of vertices alone
  ImageEncoder encode;             ///< needed with a texture size
};

/// What surfaces take from one model.
class AttributeSource {
 public:
  /// The model's textures must be decoded (io::decode_base_colors()); it is copied. Errors: bad_argument (a texture
  /// size without an encoder), those of bake::BakeSource::create().
  static Result<AttributeSource> create(const Model& model, const SurfaceAttributeOptions& options, Task task = {});

  /// Gives normals and colours to the vertices of the surface's one mesh, or an atlas with textures, whose names tell
  /// the level. Errors: those of bake::make_atlas(), bake_textures() and transfer_attributes(), and of the encoder.
  Result<void> add_to(Model& surface, std::size_t level, Task task = {}) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace lodestone::chain
