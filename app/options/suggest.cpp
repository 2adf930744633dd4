#include "app/options/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace lodestone::app {
namespace {

struct Synonym {
  std::string_view word, ours;
};

// Names that Blender, MeshLab, gltfpack, glTF-Transform, Open3D, VTK and CloudCompare have for what we do.
constexpr Synonym kSynonyms[] = {
    {"decimate", "simplify"},
    {"decimation", "simplify"},
    {"reduce", "simplify"},
    {"optimize", "simplify"},
    {"optimise", "simplify"},
    {"collapse", "simplify"},
    {"coarsen", "simplify"},
    {"lod", "build"},
    {"lods", "build"},
    {"level", "build"},
    {"levels", "build"},
    {"ladder", "build"},
    {"make", "build"},
    {"generate", "build"},
    {"view", "render"},
    {"show", "render"},
    {"open", "render"},
    {"display", "render"},
    {"draw", "render"},
    {"picture", "render"},
    {"screenshot", "render"},
    {"thumbnail", "render"},
    {"compare", "measure"},
    {"diff", "measure"},
    {"distance", "measure"},
    {"hausdorff", "measure"},
    {"inspect", "info"},
    {"stats", "info"},
    {"stat", "info"},
    {"validate", "info"},
    {"check", "info"},
    {"export", "convert"},
    {"import", "convert"},
    {"copy", "convert"},
    {"transcode", "convert"},
    {"voxel", "voxelize"},
    {"voxels", "voxelize"},
    {"retopologize", "remesh"},
    {"retopo", "remesh"},
    {"shrinkwrap", "remesh"},
    {"union", "boolean"},
    {"difference", "boolean"},
    {"intersection", "boolean"},
    {"subtract", "boolean"},
    {"csg", "boolean"},
    {"example", "sample"},
    {"examples", "sample"},
    {"demo", "sample"},
    {"man", "help"},
    {"usage", "help"},
    {"--out", "--output"},
    {"--faces", "--triangles"},
    {"--tris", "--triangles"},
    {"--polygons", "--triangles"},
    {"--count", "--triangles"},
    {"--target", "--triangles"},
    {"--percent", "--ratio"},
    {"--keep", "--ratio"},
    {"--tolerance", "--error"},
    {"--deviation", "--error"},
    {"--epsilon", "--error"},
    {"--max-error", "--error"},
    {"--lods", "--levels"},
    {"--quality", "--effort"},
    {"--units", "--unit"},
    {"--jobs", "--threads"},
    {"--silent", "--quiet"},
    {"--threshold", "--iso"},
    {"--isovalue", "--iso"},
};

std::string_view without_dashes(std::string_view word) {
  word.remove_prefix(std::min(word.find_first_not_of('-'), word.size()));
  return word;
}

// Letters changed, left out, added, or swapped with their neighbour (optimal string alignment).
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = above;
    std::swap(above, row);
  }
  return above[b.size()];
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string_view typed = without_dashes(word);
  std::string best;
  std::size_t best_edits = 0;
  for (const std::string& candidate : candidates) {
    const std::string_view name = without_dashes(candidate);
    const std::size_t wrong = edits(typed, name);
    const bool cut_short = typed.size() >= 3 && name.starts_with(typed);
    if (!cut_short && 3 * wrong > std::min(typed.size(), name.size())) continue;
    if (!best.empty() && wrong >= best_edits) continue;
    best = candidate;
    best_edits = wrong;
  }
  return best;
}

std::string meant(std::string_view word, const std::vector<std::string>& candidates) {
  for (const Synonym& synonym : kSynonyms) {
    if (synonym.word != word) continue;
    const auto ours = std::find(candidates.begin(), candidates.end(), synonym.ours);
    if (ours != candidates.end()) return *ours;
  }
  return nearest(word, candidates);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string found = meant(word, candidates);
  return found.empty() ? std::string() : fmt::format(", did you mean {}?", found);
}

}  // namespace lodestone::app
