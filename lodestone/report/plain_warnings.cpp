#include <fmt/format.h>

#include "lodestone/base/units.h"
#include "lodestone/report/html_report.h"

namespace lodestone::report {

namespace {

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", with_separators(count), count == 1 ? one : many);
}

void add_defects(const Topology& t, std::vector<std::string>& out) {
  if (t.boundary_edges > 0) {
    out.push_back(counted(t.boundary_edges, "edge is", "edges are") +
                  " open: the surface has borders or holes, so it encloses no volume.");
  }
  if (t.nonmanifold_edges > 0) {
    out.push_back(counted(t.nonmanifold_edges, "edge has", "edges have") +
                  " three triangles or more: the surface branches there, and those edges stay.");
  }
  if (t.nonmanifold_vertices > 0) {
    out.push_back(counted(t.nonmanifold_vertices, "vertex holds", "vertices hold") +
                  " parts together that share no edge; such vertices stay.");
  }
  if (t.inconsistent_edges > 0) {
    out.push_back("At " + counted(t.inconsistent_edges, "edge", "edges") + " two neighbours face opposite ways.");
  }
  if (t.duplicate_faces > 0) {
    out.push_back(counted(t.duplicate_faces, "triangle repeats", "triangles repeat") + " another.");
  }
  if (t.degenerate_triangles > 0) {
    out.push_back(counted(t.degenerate_triangles, "triangle has", "triangles have") + " no area.");
  }
}

void add_losses(const ReportData& data, std::vector<std::string>& out) {
  const Topology& original = data.levels.front().shape.topology;
  for (std::size_t i = 1; i < data.levels.size(); ++i) {
    const ReportLevel& level = data.levels[i];
    const std::uint64_t pieces = level.shape.topology.components;
    if (pieces < original.components) {
      out.push_back(fmt::format("Level {} has {} of the original's {} pieces; the others are gone or were joined.", i,
                                with_separators(pieces), with_separators(original.components)));
    }
    if (level.shape.topology.boundary_edges > 0 && original.boundary_edges == 0) {
      out.push_back(fmt::format("Level {} has open edges, the original has none.", i));
    }
    if (level.error.kind != ErrorKind::bounded) {
      out.push_back(fmt::format(
          "The error of level {} is the largest that was found; it is not certified, and the true one may be larger.",
          i));
    }
  }
}

}  // namespace

std::vector<std::string> plain_warnings(const ReportData& data) {
  std::vector<std::string> out;
  if (!data.levels.empty()) {
    add_defects(data.levels.front().shape.topology, out);
    if (data.seam_vertices > 0) {
      out.push_back(counted(data.seam_vertices, "vertex lies", "vertices lie") +
                    " on seams, where textures, normals or colours differ from side to side; seams collapse only along "
                    "themselves.");
    }
    add_losses(data, out);
  }
  out.insert(out.end(), data.warnings.begin(), data.warnings.end());
  return out;
}

}  // namespace lodestone::report
