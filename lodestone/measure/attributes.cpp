// How far normals, UVs and colours of two models are apart. attributes.h defines each distance and the corresponding
// point; the distances are those of [lod-survey], section "attribute errors".
//
// 1. make_sampled(): a model flattened to world space, its tree, and its attributes at any point.
// 2. summary(), joined(): mean, rms, maximum and percentiles of one direction, and of both.
// 3. figure(): the distances of one attribute at all pairs of points, both ways.
// 4. sets_to_compare(), note_difference(), note_textures(): what can be compared; what only one model has is told.
// 5. compare(): a figure each for normals, UV sets, vertex colours, and colours as shown.
// 6. attribute_deviation(): the pairs are found once (correspondence.cpp) and serve all attributes.
// Invariants: pairs depend on shapes, number of samples and seed, never on the attributes that they judge. Each
// distance is taken by itself and sums run in the samples' order: the same figures for any thread count.
// Cost: O((samples + triangles) log triangles), some 60 bytes a sample.
#include "lodestone/measure/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "lodestone/base/parallel.h"
#include "lodestone/measure/correspondence_detail.h"
#include "lodestone/measure/srgb_detail.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/drawn_attributes.h"

namespace lodestone::measure {

namespace {

using detail::Pair;
using detail::to_srgb;
using spatial::DrawnAttributes;
using spatial::SurfacePoint;

constexpr std::size_t kChunk = 4096;

// One model: what it draws, and how to ask it.
struct SampledModel {
  const Model& model;
  spatial::Surface surface;
  spatial::Bvh tree;
  DrawnAttributes attributes;

  SampledModel(const Model& m, spatial::Surface s, const Task& task)
      : model(m), surface(std::move(s)), tree(surface, task), attributes(model, surface) {}
};

Result<std::unique_ptr<SampledModel>> make_sampled(const Model& model, const Task& task) {
  Result<spatial::Surface> surface = spatial::flatten(model, task);
  LODESTONE_TRY(surface);
  return std::make_unique<SampledModel>(model, std::move(*surface), task);
}

// Mean, rms, maximum and percentiles of the values that are numbers. Takes a copy, 4 bytes a sample, as it reorders.
Deviation summary(std::vector<float> values) {
  Deviation out;
  const std::size_t all = values.size();
  std::erase_if(values, [](float v) { return std::isnan(v); });
  if (values.empty()) return out;
  double sum = 0, squares = 0;
  for (const float v : values) {
    sum += double(v);
    squares += double(v) * double(v);
    out.max = std::max(out.max, double(v));
  }
  const auto n = static_cast<double>(values.size());
  out.mean = sum / n;
  out.rms = std::sqrt(squares / n);
  out.share = n / static_cast<double>(all);
  const auto percentile = [&](std::size_t hundredths) {
    const std::size_t rank = (values.size() * hundredths + 99) / 100;  // the smallest that so many are not above
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
  };
  out.median = percentile(50);
  out.percentile_95 = percentile(95);
  return out;
}

// All pairs of both directions; `from` of the first is A, of the second B.
struct Pairs {
  std::vector<Pair> forward, backward;
};

// distance(A's place, B's place): a number, or nothing where one of them has no value.
template <class Distance>
std::vector<float> distances(const std::vector<Pair>& pairs, bool turned, const Task& task, const Distance& distance) {
  std::vector<float> out(pairs.size());
  parallel_for(pairs.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<double> d =
          turned ? distance(pairs[i].to, pairs[i].from) : distance(pairs[i].from, pairs[i].to);
      out[i] = d ? static_cast<float>(*d) : std::numeric_limits<float>::quiet_NaN();
    }
  });
  return out;
}

Deviation joined(const Deviation& a, const Deviation& b, const Deviation& all) {
  Deviation out = all;  // percentiles, maximum and share
  if (a.share > 0 && b.share > 0) {
    out.mean = (a.mean + b.mean) / 2;
    out.rms = std::sqrt((a.rms * a.rms + b.rms * b.rms) / 2);
  }
  return out;
}

template <class Distance>
AttributeFigure figure(const Pairs& pairs, const Task& task, const Distance& distance) {
  const std::vector<float> forward = distances(pairs.forward, false, task, distance);
  const std::vector<float> backward = distances(pairs.backward, true, task, distance);
  std::vector<float> all = forward;
  all.insert(all.end(), backward.begin(), backward.end());
  AttributeFigure out{summary(forward), summary(backward), {}};
  out.both = joined(out.forward, out.backward, summary(std::move(all)));
  return out;
}

double angle_degrees(Vec3d n, Vec3d m) {
  // atan2 is not the same on every machine in its last bit; the angle is for reading, nothing is decided by it.
  return std::atan2(length(cross(n, m)), dot(n, m)) * 180 / std::numbers::pi;
}

std::string set_names(const std::vector<std::uint32_t>& sets) {
  return sets.empty() ? "none" : fmt::format("{}", fmt::join(sets, ", "));
}

bool has_set(const SampledModel& side, std::uint32_t set) {
  const auto& sets = side.attributes.uv_sets();
  return std::find(sets.begin(), sets.end(), set) != sets.end();
}

// The UV sets to compare; what only one model has goes into `notes`.
Result<std::vector<std::uint32_t>> sets_to_compare(const SampledModel& a, const SampledModel& b,
                                                   const AttributeOptions& options, std::vector<std::string>& notes) {
  if (options.uv_set) {
    for (const SampledModel* side : {&a, &b}) {
      if (has_set(*side, *options.uv_set)) continue;
      return fail(ErrorCode::bad_argument,
                  fmt::format("{} has no UV set {}; those that it has: {}", side == &a ? "A" : "B", *options.uv_set,
                              set_names(side->attributes.uv_sets())));
    }
    return std::vector<std::uint32_t>{*options.uv_set};
  }
  std::vector<std::uint32_t> sets;
  for (const std::uint32_t set : a.attributes.uv_sets()) {
    if (has_set(b, set)) {
      sets.push_back(set);
    } else {
      notes.push_back(fmt::format("B has no UV set {}, A has", set));
    }
  }
  for (const std::uint32_t set : b.attributes.uv_sets()) {
    if (!has_set(a, set)) notes.push_back(fmt::format("A has no UV set {}, B has", set));
  }
  return sets;
}

void note_difference(bool a, bool b, const char* what, std::vector<std::string>& notes) {
  if (a != b) notes.push_back(fmt::format("{} has no {}, {} has", a ? "B" : "A", what, a ? "A" : "B"));
}

// Textures that are named but were not decoded, each once.
void note_textures(const SampledModel& side, const char* name, std::vector<std::string>& notes) {
  std::set<std::uint32_t> drawn;
  for (const Instance& instance : side.model.instances) {
    for (const FaceGroup& group : side.model.meshes[instance.mesh].groups) drawn.insert(group.material);
  }
  for (const std::uint32_t m : drawn) {
    if (m >= side.model.materials.size()) continue;
    const Material& material = side.model.materials[m];
    if (material.base_color_texture == nullptr || material.base_color_pixels != nullptr) continue;
    notes.push_back(fmt::format("{}: the texture of material '{}' is missing or cannot be decoded and counts as white",
                                name, material.name));
  }
}

std::optional<double> plane_distance(const std::optional<Vec2d>& a, const std::optional<Vec2d>& b) {
  if (!a || !b) return std::nullopt;
  return std::sqrt((a->x - b->x) * (a->x - b->x) + (a->y - b->y) * (a->y - b->y));
}

Attributes compare(const DrawnAttributes& a, const DrawnAttributes& b, const Pairs& pairs,
                   const std::vector<std::uint32_t>& sets, const Task& task) {
  Attributes out;
  out.normal = figure(pairs, task, [&](const SurfacePoint& p, const SurfacePoint& q) -> std::optional<double> {
    const std::optional<Vec3d> n = a.normal(p), m = b.normal(q);
    if (!n || !m) return std::nullopt;
    return angle_degrees(*n, *m);
  });
  for (const std::uint32_t set : sets) {
    out.uv.push_back({set,
                      figure(pairs, task,
                             [&](const SurfacePoint& p, const SurfacePoint& q) {
                               return plane_distance(a.uv(p, set), b.uv(q, set));
                             }),
                      a.uv_diagonal(set)});
  }
  if (a.has_color() && b.has_color()) {
    out.color = figure(pairs, task, [&](const SurfacePoint& p, const SurfacePoint& q) -> std::optional<double> {
      const std::optional<Vec3d> c = a.color(p), d = b.color(q);
      if (!c || !d) return std::nullopt;
      return length(*c - *d);
    });
  }
  if (a.has_appearance() || b.has_appearance()) {
    out.look = figure(pairs, task, [&](const SurfacePoint& p, const SurfacePoint& q) -> std::optional<double> {
      return length(to_srgb(a.light(p)) - to_srgb(b.light(q)));
    });
  }
  return out;
}

}  // namespace

Result<Attributes> attribute_deviation(const Model& a, const Model& b, const AttributeOptions& options, Task task) {
  const Result<std::unique_ptr<SampledModel>> original = make_sampled(a, task);
  LODESTONE_TRY(original);
  const Result<std::unique_ptr<SampledModel>> level = make_sampled(b, task);
  LODESTONE_TRY(level);
  const SampledModel &first = **original, &second = **level;
  std::vector<std::string> notes;
  const Result<std::vector<std::uint32_t>> sets = sets_to_compare(first, second, options, notes);
  LODESTONE_TRY(sets);
  note_difference(first.attributes.has_normals(), second.attributes.has_normals(), "normals (its faces' are taken)",
                  notes);
  note_difference(first.attributes.has_color(), second.attributes.has_color(), "vertex colours", notes);
  note_textures(first, "A", notes);
  note_textures(second, "B", notes);

  Pairs pairs;
  pairs.forward =
      detail::corresponding_points(first.surface, second.tree, options.samples, options.seed, task.part(0.4));
  pairs.backward =
      detail::corresponding_points(second.surface, first.tree, options.samples, options.seed, task.part(0.4));
  if (task.cancelled()) return cancelled_error("measuring");
  Attributes out = compare(first.attributes, second.attributes, pairs, *sets, task);
  if (task.cancelled()) return cancelled_error("measuring");
  out.samples = options.samples;
  out.notes = std::move(notes);
  return out;
}

}  // namespace lodestone::measure
