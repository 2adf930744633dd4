// CGAL 5.5: Lindstrom-Turk (the default policies) and Garland-Heckbert (plane quadrics, bounded normal change).
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "bench/peers/peer.h"

namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

// Stops at a number of faces: its own predicates count edges.
struct StopAtFaces {
  std::size_t target;
  template <class Cost, class Profile, class Count>
  bool operator()(const Cost&, const Profile& profile, Count, Count) const {
    return profile.surface_mesh().number_of_faces() <= target;
  }
};

Surface to_surface(const peers::Triangles& in) {
  std::vector<Kernel::Point_3> points;
  for (std::size_t v = 0; v < in.vertices(); ++v) {
    points.emplace_back(in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]);
  }
  std::vector<std::vector<std::size_t>> faces;
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    faces.push_back({in.indices[3 * t], in.indices[3 * t + 1], in.indices[3 * t + 2]});
  }
  namespace pmp = CGAL::Polygon_mesh_processing;
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) pmp::orient_polygon_soup(points, faces);
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
  return surface;
}

peers::Triangles from_surface(Surface& surface) {
  surface.collect_garbage();
  peers::Triangles out;
  for (const auto v : surface.vertices()) {
    const auto& p = surface.point(v);
    for (const double x : {p.x(), p.y(), p.z()}) out.positions.push_back(static_cast<float>(x));
  }
  for (const auto f : surface.faces()) {
    for (const auto v : CGAL::vertices_around_face(surface.halfedge(f), surface)) {
      out.indices.push_back(static_cast<std::uint32_t>(v));
    }
  }
  return out;
}

peers::Triangles lindstrom_turk(const peers::Triangles& in, std::size_t target, double& seconds) {
  Surface surface = to_surface(in);
  seconds = peers::seconds_of([&] { sms::edge_collapse(surface, StopAtFaces{target}); });
  return from_surface(surface);
}

peers::Triangles garland_heckbert(const peers::Triangles& in, std::size_t target, double& seconds) {
  using Policies = sms::GarlandHeckbert_plane_policies<Surface, Kernel>;
  using Placement = sms::Bounded_normal_change_placement<Policies::Get_placement>;
  Surface surface = to_surface(in);
  seconds = peers::seconds_of([&] {
    const Policies policies(surface);
    const Placement placement(policies.get_placement());
    sms::edge_collapse(surface, StopAtFaces{target},
                       CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
  });
  return from_surface(surface);
}

}  // namespace

int main(int argc, char** argv) {
  return peers::run(argc, argv, {{"lindstrom-turk", lindstrom_turk}, {"garland-heckbert", garland_heckbert}});
}
