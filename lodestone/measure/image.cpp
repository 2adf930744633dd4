// How different two models look: pictures of both from all around, compared.
//
// 1. corners_of_polyhedron(), camera_at(): cameras at the corners of a regular polyhedron, without perspective; the
//    sphere around the original's box just fits.
// 2. picture_of(), empty_picture(): samples covered in each pixel, shading, and colours where the original has some.
// 3. compare_colors(), decibels(): peak signal-to-noise ratio, and structural similarity (Z. Wang et al., 2004
//    [wang-2004]), over the pixels that either model covers.
// 4. farthest(), compare_silhouettes(): pixels that one silhouette covers and the other doesn't, and the largest
//    distance from one to the other, by an exact distance transform (image_figures.cpp).
// 5. ImageReference: create() takes the original's pictures once, deviation_of() compares a level's with them.
// Invariants: cameras depend on the original alone. Views are compared in order, and the renderer gives the same bytes
// for any thread count. log10 may differ in its last bit from machine to machine; nothing is decided by it here.
// Cost: views x (pixels + triangles), some 7 bytes a pixel and view.
#include "lodestone/measure/image.h"

#include <algorithm>
#include <cmath>

#include "lodestone/measure/image_figures_detail.h"
#include "lodestone/render/render.h"

namespace lodestone::measure {

namespace {

constexpr double kMostDecibels = 100;

std::vector<Vec3d> corners_of_polyhedron(int count) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3d> corners;
  const auto cyclic = [&](double a, double b, double c) {
    for (const Vec3d& v : {Vec3d{a, b, c}, Vec3d{b, c, a}, Vec3d{c, a, b}}) corners.push_back(normalized(v));
  };
  const auto cube = [&] {
    for (int i = 0; i < 8; ++i) {
      corners.push_back(
          normalized(Vec3d{(i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0}));
    }
  };
  switch (count) {
    case 4:
      for (const Vec3d& v : {Vec3d{1, 1, 1}, Vec3d{1, -1, -1}, Vec3d{-1, 1, -1}, Vec3d{-1, -1, 1}}) {
        corners.push_back(normalized(v));
      }
      break;
    case 6:
      for (const double s : {1.0, -1.0}) cyclic(s, 0, 0);
      break;
    case 8:
      cube();
      break;
    case 12:
      for (const double s : {1.0, -1.0}) {
        for (const double g : {golden, -golden}) cyclic(0, s, g);
      }
      break;
    case 20:
      cube();
      for (const double s : {1 / golden, -1 / golden}) {
        for (const double g : {golden, -golden}) cyclic(0, s, g);
      }
      break;
    default:
      break;
  }
  return corners;
}

// No perspective; the sphere fills the square.
Camera camera_at(const Box3d& bounds, Vec3d direction) {
  const double radius = std::max(bounds.diagonal() / 2, 1e-30);
  Camera camera = look_at(bounds.center() + direction * (2 * radius), bounds.center());
  camera.orthographic = true;
  camera.half_height = radius;
  camera.near_distance = radius * 1e-3;
  return camera;
}

render::SceneOptions scene_options(const ImageOptions& options) {
  render::SceneOptions out;
  out.input = options.input;
  return out;
}

struct Picture {
  std::vector<std::uint8_t> coverage;  // samples of each pixel, of kSamples
  Pixels shading, color;               // color is empty where not asked for
};

constexpr int kSamples = 4;

Result<Picture> picture_of(const render::Scene& scene, const Camera& camera, std::uint32_t size, bool color,
                           const Task& task) {
  Picture picture;
  Result<render::Frame> frame = render::rasterize(scene, camera, size, size, kSamples, task);
  LODESTONE_TRY(frame);
  picture.coverage = std::move(frame->coverage);
  render::RenderOptions options;
  options.width = options.height = size;
  options.samples = kSamples;
  Result<Pixels> shading = render::render(scene, camera, options, task);
  LODESTONE_TRY(shading);
  picture.shading = std::move(*shading);
  if (!color) return picture;
  options.shading = render::Shading::textured;
  Result<Pixels> colors = render::render(scene, camera, options, task);
  LODESTONE_TRY(colors);
  picture.color = std::move(*colors);
  return picture;
}

Picture empty_picture(std::uint32_t size, bool color) {
  const std::array<std::uint8_t, 4> background = render::RenderOptions{}.background;
  Picture picture;
  picture.coverage.assign(std::size_t{size} * size, 0);
  picture.shading.width = picture.shading.height = size;
  for (std::size_t i = 0; i < std::size_t{size} * size; ++i) {
    picture.shading.rgba.insert(picture.shading.rgba.end(), background.begin(), background.end());
  }
  if (color) picture.color = picture.shading;
  return picture;
}

// Sums over views.
struct Sums {
  double squares = 0, ssim = 0;
  double pixels = 0;
};

void compare_colors(const Pixels& a, const Pixels& b, const std::vector<std::uint8_t>& either, Sums& sums) {
  std::vector<float> luminance_a(either.size()), luminance_b(either.size());
  const auto luminance = [](const std::uint8_t* p) {
    return 0.2126F * static_cast<float>(p[0]) + 0.7152F * static_cast<float>(p[1]) + 0.0722F * static_cast<float>(p[2]);
  };
  for (std::size_t i = 0; i < either.size(); ++i) {
    const std::uint8_t *p = a.rgba.data() + 4 * i, *q = b.rgba.data() + 4 * i;
    luminance_a[i] = luminance(p);
    luminance_b[i] = luminance(q);
    if (either[i] == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) sums.squares += (p[k] - q[k]) * (p[k] - q[k]) / 3.0;
    sums.pixels += 1;
  }
  sums.ssim += detail::sum_of_ssim(luminance_a, luminance_b, either, a.width, a.height);
}

double decibels(const Sums& sums) {
  if (!(sums.squares > 0)) return kMostDecibels;
  return std::min(kMostDecibels, 10 * std::log10(255.0 * 255.0 * sums.pixels / sums.squares));
}

double farthest(const std::vector<std::uint8_t>& from, const std::vector<std::uint8_t>& to, std::uint32_t size) {
  const std::vector<float> distances = detail::distances_to(to, size, size);
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] != 0) most = std::max(most, static_cast<double>(distances[i]));
  }
  return std::min(most, std::sqrt(2.0) * size);  // an empty silhouette is as far as the picture's diagonal
}

void compare_silhouettes(const Picture& a, const Picture& b, std::uint32_t size, ImageDeviation& out) {
  double differs = 0, covered = 0;
  std::vector<std::uint8_t> half_a(a.coverage.size()), half_b(a.coverage.size());
  for (std::size_t i = 0; i < a.coverage.size(); ++i) {
    differs += std::abs(a.coverage[i] - b.coverage[i]);
    covered += a.coverage[i];
    half_a[i] = 2 * a.coverage[i] >= kSamples ? 1 : 0;
    half_b[i] = 2 * b.coverage[i] >= kSamples ? 1 : 0;
  }
  const double share = covered > 0 ? differs / covered : differs > 0 ? 1 : 0;
  out.silhouette_mean += share;
  out.silhouette_max = std::max(out.silhouette_max, share);
  out.screen_max_px = std::max({out.screen_max_px, farthest(half_a, half_b, size), farthest(half_b, half_a, size)});
}

}  // namespace

struct ImageReference::Data {
  ImageOptions options;
  std::vector<Camera> cameras;
  std::vector<Picture> pictures;
  bool has_color = false;
};

ImageReference::ImageReference(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ImageReference::ImageReference(ImageReference&&) noexcept = default;
ImageReference& ImageReference::operator=(ImageReference&&) noexcept = default;
ImageReference::~ImageReference() = default;

Result<ImageReference> ImageReference::create(const Model& original, const ImageOptions& options, Task task) {
  const std::vector<Vec3d> directions = corners_of_polyhedron(options.views);
  if (directions.empty()) {
    return fail(ErrorCode::bad_argument, "pictures can't be taken from that many sides", {},
                "use 4, 6, 8, 12 or 20 views");
  }
  if (options.size_px < 16 || options.size_px > 4096) {
    return fail(ErrorCode::bad_argument, "that is no size for pictures to compare", {}, "use 16 to 4096 pixels");
  }
  const Result<render::Scene> scene = render::Scene::create(original, scene_options(options), task.part(0.1));
  LODESTONE_TRY(scene);
  auto data = std::make_unique<Data>();
  data->options = options;
  data->has_color = scene->has_textures() || scene->has_colors();
  for (const Vec3d& direction : directions) {
    data->cameras.push_back(camera_at(scene->bounds(), direction));
    Result<Picture> picture = picture_of(*scene, data->cameras.back(), options.size_px, data->has_color,
                                         task.part(0.9 / static_cast<double>(directions.size())));
    LODESTONE_TRY(picture);
    data->pictures.push_back(std::move(*picture));
  }
  return ImageReference(std::move(data));
}

Result<ImageDeviation> ImageReference::deviation_of(const Model& level, Task task) const {
  const std::uint32_t size = data_->options.size_px;
  const Result<render::Scene> scene = render::Scene::create(level, scene_options(data_->options), task.part(0.1));
  if (!scene && scene.error().code != ErrorCode::empty) return fail(scene.error());
  ImageDeviation out;
  out.views = static_cast<int>(data_->cameras.size());
  out.size_px = size;
  out.has_color = data_->has_color;
  Sums shading, color;
  for (std::size_t i = 0; i < data_->cameras.size(); ++i) {
    const Task part = task.part(0.9 / static_cast<double>(data_->cameras.size()));
    Result<Picture> picture = scene ? picture_of(*scene, data_->cameras[i], size, data_->has_color, part)
                                    : Result<Picture>(empty_picture(size, data_->has_color));
    LODESTONE_TRY(picture);
    const Picture& original = data_->pictures[i];
    compare_silhouettes(original, *picture, size, out);
    std::vector<std::uint8_t> either(original.coverage.size());
    for (std::size_t k = 0; k < either.size(); ++k) {
      either[k] = original.coverage[k] != 0 || picture->coverage[k] != 0 ? 1 : 0;
    }
    compare_colors(original.shading, picture->shading, either, shading);
    if (data_->has_color) compare_colors(original.color, picture->color, either, color);
  }
  out.silhouette_mean /= out.views;
  out.shading_psnr = decibels(shading);
  if (shading.pixels > 0) out.shading_ssim = shading.ssim / shading.pixels;
  if (data_->has_color) {
    out.color_psnr = decibels(color);
    if (color.pixels > 0) out.color_ssim = color.ssim / color.pixels;
  }
  return out;
}

}  // namespace lodestone::measure
