// Our measuring beside others', on the same two meshes in one run:
//   measure_peers A B [SAMPLES [REPEATS]]
// prints one line of JSON. Surface distance: both directions, the same samples, all threads, trees built in the time;
// peer Embree 3 (rtcPointQuery, which leaves the distance to a triangle to its caller: ours is called). Hausdorff
// distance to 1e-4 of the diagonal, both ways: peer CGAL's bounded_error_symmetric_Hausdorff_distance.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
// After its kernel.
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>

#include "bench/peers/peer.h"
#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/hausdorff.h"
#include "lodestone/measure/sampling_detail.h"

namespace {

using namespace lodestone;

struct Figures {
  double max = 0, mean = 0;  // of the samples, both directions
};

double median_seconds(int repeats, const std::function<void()>& call) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) seconds.push_back(peers::seconds_of(call));
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

class EmbreeScene {
 public:
  EmbreeScene(RTCDevice device, const spatial::Surface& surface) : surface_(surface), scene_(rtcNewScene(device)) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), surface.positions.size()));
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
      const Vec3f p = to_float(surface.positions[v]);
      for (std::size_t k = 0; k < 3; ++k) vertices[3 * v + k] = p[k];
    }
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), surface.triangles.size()));
    for (const Triangle& t : surface.triangles) indices = std::copy(t.begin(), t.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  ~EmbreeScene() { rtcReleaseScene(scene_); }

  double distance(Vec3d p) const {
    struct Search {
      const spatial::Surface* surface;
      Vec3d point;
      double nearest_sq;
    } search{&surface_, p, std::numeric_limits<double>::infinity()};
    const Vec3f at = to_float(p);
    RTCPointQuery query{at.x, at.y, at.z, 0, std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        scene_, &query, &context,
        [](RTCPointQueryFunctionArguments* arguments) {
          auto& s = *static_cast<Search*>(arguments->userPtr);
          const auto [a, b, c] = s.surface->corners(arguments->primID);
          const double found = closest_point(s.point, a, b, c).distance_sq;
          if (found >= s.nearest_sq) return false;
          s.nearest_sq = found;
          arguments->query->radius = static_cast<float>(std::sqrt(found)) * 1.000001F;
          return true;
        },
        &search);
    return std::sqrt(search.nearest_sq);
  }

 private:
  const spatial::Surface& surface_;
  RTCScene scene_;
};

void measure_with_embree(const spatial::Surface& from, const EmbreeScene& to, std::uint64_t samples, Figures& figures) {
  const measure::detail::Sampler sampler(from, samples, 1);
  const Figures found = parallel_reduce(
      sampler.count(), 4096, Task{}, Figures{},
      [&](std::size_t begin, std::size_t end) {
        Figures part;
        sampler.for_each(begin, end, [&](std::size_t, const measure::detail::Sample& sample) {
          const double d = to.distance(sample.point);
          part.max = std::max(part.max, d);
          part.mean += d;
        });
        return part;
      },
      [](const Figures& a, const Figures& b) {
        return Figures{std::max(a.max, b.max), a.mean + b.mean};
      });
  figures.max = std::max(figures.max, found.max);
  figures.mean += found.mean / static_cast<double>(samples) / 2;
}

Figures by_embree(RTCDevice device, const Model& a, const Model& b, std::uint64_t samples) {
  const spatial::Surface first = *spatial::flatten(a), second = *spatial::flatten(b);
  const EmbreeScene first_scene(device, first), second_scene(device, second);
  Figures figures;
  measure_with_embree(first, second_scene, samples, figures);
  measure_with_embree(second, first_scene, samples, figures);
  return figures;
}

using CgalMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

CgalMesh cgal_mesh(const Model& model) {
  const spatial::Surface surface = *spatial::flatten(model);
  CgalMesh mesh;
  for (const Vec3d& p : surface.positions) mesh.add_vertex({p.x, p.y, p.z});
  for (const Triangle& t : surface.triangles) {
    mesh.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]), CgalMesh::Vertex_index(t[2]));
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fputs("usage: measure_peers A B [SAMPLES [REPEATS]]\n", stderr);
    return 2;
  }
  const Result<Model> a = io::read_model(argv[1]), b = io::read_model(argv[2]);
  if (!a || !b) {
    std::fprintf(stderr, "measure_peers: %s\n", (a ? b : a).error().line().c_str());
    return 1;
  }
  const std::uint64_t samples = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 5'000'000;
  const int repeats = argc > 4 ? std::atoi(argv[4]) : 3;

  measure::DistanceOptions options;
  options.samples = samples;
  options.bound = false;
  measure::Distance ours;
  const double our_seconds = median_seconds(repeats, [&] { ours = *measure::distance(*a, *b, options); });
  options.bound = true;
  measure::Distance bounded;
  const double bounded_seconds = median_seconds(repeats, [&] { bounded = *measure::distance(*a, *b, options); });
  RTCDevice device = rtcNewDevice(nullptr);
  Figures embree;
  const double embree_seconds = median_seconds(repeats, [&] { embree = by_embree(device, *a, *b, samples); });
  rtcReleaseDevice(device);

  const double tolerance = 1e-4 * ours.diagonal;
  measure::Hausdorff interval;
  const double interval_seconds = median_seconds(repeats, [&] { interval = *measure::hausdorff(*a, *b, tolerance); });
  const CgalMesh cgal_a = cgal_mesh(*a), cgal_b = cgal_mesh(*b);
  double cgal = 0;
  const double cgal_seconds = peers::seconds_of([&] {
    cgal = CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<CGAL::Parallel_if_available_tag>(
        cgal_a, cgal_b, tolerance);
  });
  std::printf(
      "{\"samples\": %llu, \"ours\": {\"seconds\": %.4g, \"mean\": %.9g, \"sampled_max\": %.9g}, \"bounded\": "
      "{\"seconds\": %.4g, \"found\": "
      "%.9g, \"bound\": %.9g, \"is_bounded\": %s}, \"embree\": {\"seconds\": %.4g, \"mean\": %.9g, \"max\": %.9g}, "
      "\"hausdorff\": "
      "{\"seconds\": %.4g, \"lower\": %.9g, \"upper\": %.9g}, \"cgal\": {\"seconds\": %.4g, \"distance\": %.9g}}\n",
      static_cast<unsigned long long>(samples), our_seconds, ours.mean, ours.sampled_max, bounded_seconds, bounded.max,
      bounded.bound, bounded.is_bounded ? "true" : "false", embree_seconds, embree.mean, embree.max, interval_seconds,
      interval.lower, interval.upper, cgal_seconds, cgal);
  return 0;
}
