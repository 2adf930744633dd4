#include "lodestone/bake/transfer.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/core/tangents.h"
#include "lodestone/core/validate.h"
#include "lodestone/spatial/smooth_normals.h"

namespace lodestone::bake {

namespace {

constexpr std::size_t kChunk = 4096;

// What one vertex gets.
struct Tuple {
  Vec3f normal;
  Vec3f color;  // light, whole 65535ths: with 255ths dark colours would lie in bands
};

float whole_65535th(double light) {
  const double cut = light > 0 ? std::min(light, 1.0) : 0.0;
  return static_cast<float>(std::floor(cut * 65535 + 0.5)) / 65535.0F;
}

std::vector<Tuple> tuples_of(const Mesh& target, const BakeSource& source, const Task& task) {
  const std::vector<Vec3d> own = spatial::vertex_normals(target);
  std::vector<Tuple> tuples(target.vertex_count());
  parallel_for(tuples.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    for (std::size_t v = begin; v < end; ++v) points.push_back(target.position(static_cast<std::uint32_t>(v)));
    std::vector<spatial::SurfacePoint> places(points.size());
    source.find(points, std::span(own).subspan(begin, end - begin), places);
    for (std::size_t v = begin; v < end; ++v) {
      const spatial::SurfacePoint& place = places[v - begin];
      const Vec3d theirs = source.normal(place), light = source.color(place);
      const bool agree = dot(theirs, own[v]) > 0 || own[v] == Vec3d{};
      const Vec3d normal = agree ? theirs : own[v];
      tuples[v].normal = to_float(normal == Vec3d{} ? Vec3d{0, 0, 1} : normal);
      for (std::size_t k = 0; k < 3; ++k) tuples[v].color[k] = whole_65535th(light[k]);
    }
    task.advance(static_cast<double>(end - begin) / static_cast<double>(tuples.size()));
  });
  return tuples;
}

void drop_streams(Mesh& mesh, Semantic semantic) {
  std::erase_if(mesh.attributes,
                [&](const AttributeStream& stream) { return stream.semantic == semantic && stream.set == 0; });
}

void set_normals(Mesh& mesh, const std::vector<Tuple>& tuples) {
  drop_streams(mesh, Semantic::normal);
  drop_tangents(mesh);
  AttributeStream stream =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, mesh.wedge_count());
  auto& values = std::get<std::vector<float>>(stream.values);
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f& n = tuples[mesh.vertex_of(w)].normal;
    for (std::size_t k = 0; k < 3; ++k) values[3 * std::size_t{w} + k] = n[k];
  }
  mesh.attributes.push_back(std::move(stream));
}

void set_colors(Mesh& mesh, const std::vector<Tuple>& tuples) {
  drop_streams(mesh, Semantic::color);
  AttributeStream stream = make_stream("COLOR_0", Semantic::color, 3, ComponentType::uint16, true, mesh.wedge_count());
  stream.is_light = true;
  auto& values = std::get<std::vector<float>>(stream.values);
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f& c = tuples[mesh.vertex_of(w)].color;
    for (std::size_t k = 0; k < 3; ++k) values[3 * std::size_t{w} + k] = c[k];
  }
  mesh.attributes.push_back(std::move(stream));
}

}  // namespace

Result<Mesh> transfer_attributes(const Mesh& target, const BakeSource& source, const TransferOptions& options,
                                 Task task) {
  if (target.triangles.empty()) return fail(ErrorCode::empty, "the target has no triangle");
  LODESTONE_TRY(validate(target, task));
  task = task.part(1, "attributes");
  const std::vector<Tuple> tuples = tuples_of(target, source, task);
  if (task.cancelled()) return cancelled_error("transfer of attributes");
  Mesh out = target;
  if (options.normals) set_normals(out, tuples);
  if (options.colors && source.has_color()) set_colors(out, tuples);
  return out;
}

}  // namespace lodestone::bake
