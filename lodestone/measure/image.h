// How different two models look: pictures of both from all around, compared.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

struct ImageOptions {
  /// From the corners of a regular polyhedron: 4, 6, 8, 12 or 20.
  int views = 20;
  /// Pictures are squares of this many pixels; the bounding sphere of the original's box just fits (no perspective).
  std::uint32_t size_px = 512;
  Input input = Input::unchecked;  ///< of the original, and of all levels
};

/// Over all views. Shading is grey, lit, with the models' normals; colours are with textures and vertex colours.
struct ImageDeviation {
  /// Pixels that one silhouette covers and the other doesn't (parts of pixels count as such), as a share of those that
  /// the original covers: the mean over the views, and the worst view's.
  double silhouette_mean = 0, silhouette_max = 0;
  /// Largest distance of a covered pixel to the other's silhouette, both ways (their Hausdorff distance), in pixels.
  double screen_max_px = 0;
  /// Peak signal-to-noise ratio over all pixels that either covers, dB, 100 where nothing differs (or more than 100).
  double shading_psnr = 100, color_psnr = 100;
  /// Structural similarity of the luminance (Wang et al. 2004: 11 x 11 Gaussian windows, sigma 1.5), the mean over the
  /// same pixels: 1 where nothing differs.
  double shading_ssim = 1, color_ssim = 1;
  bool has_color = false;  ///< false: the original has no textures and no vertex colours; colour figures are empty
  int views = 0;
  std::uint32_t size_px = 0;

  /// Of shading and colours the figure that is worse.
  double worse_psnr() const { return std::min(shading_psnr, color_psnr); }
  double worse_ssim() const { return std::min(shading_ssim, color_ssim); }
};

/// Pictures of an original, to compare many levels with. Textures must be decoded before (io::decode_base_colors()).
class ImageReference {
 public:
  /// Errors: bad_argument (number of views, size; those of validate()), empty, cancelled. About 7 bytes a pixel and
  /// view.
  static Result<ImageReference> create(const Model& original, const ImageOptions& options = {}, Task task = {});
  ImageReference(ImageReference&&) noexcept;
  ImageReference& operator=(ImageReference&&) noexcept;
  ~ImageReference();

  /// A level without triangles differs wholly. Same figures for any thread count. Errors: bad_argument (those
  /// of validate()), cancelled.
  Result<ImageDeviation> deviation_of(const Model& level, Task task = {}) const;

 private:
  struct Data;
  explicit ImageReference(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace lodestone::measure
