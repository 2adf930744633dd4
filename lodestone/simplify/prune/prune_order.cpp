// The order in which small parts of a mesh vanish: greedily, always the part whose vanishing errs least
// (docs/thin-parts.md, "How parts vanish").
//
// The error of a part is how far its vertices are from the parts that remain, plus the error of what it stands for
// already (Part::inherited); with `keep_area`, also how far the part that takes over its area has to grow.
// The class Greedy does the work:
// 1. gather_triangles(), list_vertices(), measure_parts(): triangles, vertices, area and shape of each part.
// 2. fill_queue(): a lower bound for each part, from at most kBoundVertices of its vertices.
// 3. run(): the cheapest part is looked at anew (error_of()). If it is still the cheapest, it vanishes (vanish()): its
//    heir (choose_heir()) takes over its area, and the parts nearest to its vertices inherit its error. Otherwise it
//    goes back into the queue.
// Errors only grow while parts vanish, so an old error is a lower bound and few parts are looked at often. What is
// nearest to a vertex is asked again only when that part has vanished (ask()).
//
// One part always remains, and so does every part with a no_move vertex. Errors never fall along the steps; of equal
// ones the lower part goes first: the same for any number of threads. O(n log n) for parts of bounded size.
#include "lodestone/simplify/prune/prune_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <span>
#include <tuple>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/simplify/prune/part_shape_detail.h"
#include "lodestone/spatial/part_tree.h"

namespace lodestone::simplify {

namespace {

using spatial::NearestPart;

// A part gives its area to one of its own kind, so that leaves make leaves larger and not the trunk: to none that has
// more than this many times its area, if there is another.
constexpr double kKind = 16;

// A part's lower bound comes from at most so many of its vertices.
constexpr std::uint32_t kBoundVertices = 32;

constexpr std::size_t kChunk = 1024;

struct Part {
  double stands = 0;     // area of its own and of the parts that it took over
  double inherited = 0;  // error of those
  double growth = 0;     // how far its farthest vertex moves to have that area
  double factor = 1;     // importance
  detail::PartShape shape;
  std::uint32_t heir = kNone;  // who would take over its area, as last asked
  std::uint32_t farthest = 0;  // vertex
  bool alive = false;
};

class Greedy {
 public:
  Greedy(const Mesh& mesh, const PruneOptions& options, PruneOrder& out, const Task& task)
      : keep_area_(options.keep_area), out_(out), task_(task), parts_(out.parts.count) {
    place(mesh, options);
    gather_triangles(mesh, options.left_out);
    list_vertices();
    measure_parts(options);
  }

  void run() {
    if (left_ < 2) return;
    tree_.emplace(positions_, triangles_, out_.parts.of_vertex, parts_.size(), task_);
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      if (!parts_[p].alive) tree_->remove(p);
    }
    fill_queue();
    const double share = 1.0 / static_cast<double>(parts_.size());
    std::size_t told = 0;
    while (left_ > 1 && !queue_.empty()) {
      const Entry cheapest = queue_.top();
      queue_.pop();
      const Entry now{error_of(cheapest.part), cheapest.part};
      if (task_.cancelled()) return;  // near_ is incomplete then
      if (!queue_.empty() && queue_.top() < now) {
        queue_.push(now);
      } else {
        vanish(now);
      }
      if (++told % 256 != 0) continue;
      if (task_.cancelled()) return;
      task_.advance(share * 128);
    }
  }

 private:
  struct Entry {
    double error;
    std::uint32_t part;
    bool operator<(const Entry& other) const { return std::tie(error, part) < std::tie(other.error, other.part); }
    bool operator>(const Entry& other) const { return other < *this; }
  };

  std::span<const std::uint32_t> vertices_of(std::uint32_t p) const {
    return std::span(vertices_).subspan(vertex_first_[p], vertex_first_[p + 1] - vertex_first_[p]);
  }

  void place(const Mesh& mesh, const PruneOptions& options) {
    positions_.resize(mesh.vertex_count());
    parallel_for(positions_.size(), kChunk, task_, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) {
        positions_[v] = options.metric.direction(to_double(mesh.positions[v]));
      }
    });
  }

  // Triangles that are left out have no area, and no distance is measured to them.
  void gather_triangles(const Mesh& mesh, const std::vector<std::uint32_t>& left_out) {
    triangles_.reserve(mesh.triangles.size());
    std::size_t next = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (next < left_out.size() && left_out[next] == t) {
        ++next;
        continue;
      }
      const Triangle v = mesh.vertices_of(t);
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      triangles_.push_back(v);
      parts_[out_.parts.of_vertex[v[0]]].alive = true;
    }
    for (const Part& part : parts_) left_ += part.alive ? 1 : 0;
  }

  void list_vertices() {
    vertex_first_.assign(parts_.size() + 1, 0);
    for (const std::uint32_t p : out_.parts.of_vertex) {
      if (p != kNone) ++vertex_first_[p];
    }
    vertices_.resize(exclusive_scan(vertex_first_));
    std::vector<std::uint32_t> next = vertex_first_;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      if (const std::uint32_t p = out_.parts.of_vertex[v]; p != kNone) vertices_[next[p]++] = v;
    }
  }

  void measure_parts(const PruneOptions& options) {
    std::vector<detail::PartMeasure> measures(parts_.size());
    for (const Triangle& t : triangles_) {
      measures[out_.parts.of_vertex[t[0]]].add_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    }
    out_.area.resize(parts_.size());
    out_.no_prune.assign(parts_.size(), 0);
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      Part& part = parts_[p];
      measures[p].end_triangles();
      for (const std::uint32_t v : vertices_of(p)) measures[p].add_vertex(positions_[v]);
      part.shape = measures[p].end_vertices();
      if (!(part.shape.area > 0)) part.shape.center = positions_[vertices_of(p)[0]];
      out_.area[p] = part.stands = part.shape.area;
      double weight = 1;
      for (const std::uint32_t v : vertices_of(p)) {
        if (!options.no_move.empty() && options.no_move[v] != 0) out_.no_prune[p] = 1;
        if (!options.weights.empty()) weight = std::max(weight, static_cast<double>(options.weights[v]));
      }
      part.factor = std::sqrt(weight);
    }
  }

  // Errors of a few vertices each are enough to begin with: most large parts are never the cheapest.
  void fill_queue() {
    near_.resize(positions_.size());
    std::vector<double> bounds(parts_.size(), 0);
    parallel_for(parts_.size(), 16, task_, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
        if (!parts_[p].alive || out_.no_prune[p] != 0) continue;
        const auto vertices = vertices_of(p);
        const std::size_t step = (vertices.size() + kBoundVertices - 1) / kBoundVertices;
        double most = 0;
        for (std::size_t i = 0; i < vertices.size(); i += step) {
          ask(vertices[i], p);
          most = std::max(most, near_[vertices[i]].distance_sq);
        }
        bounds[p] = std::sqrt(most) * parts_[p].factor;
      }
    });
    if (task_.cancelled()) return;
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      if (parts_[p].alive && out_.no_prune[p] == 0) queue_.push({bounds[p], p});
    }
  }

  void ask(std::uint32_t v, std::uint32_t p) {
    NearestPart& near = near_[v];
    if (near.part != kNone && parts_[near.part].alive) return;
    near = tree_->nearest(positions_[v], [p](std::uint32_t q) { return q != p; });
  }

  double error_of(std::uint32_t p) {
    Part& part = parts_[p];
    const auto vertices = vertices_of(p);
    parallel_for(vertices.size(), kChunk, task_, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) ask(vertices[i], p);
    });
    if (task_.cancelled()) return 0;
    double most = -1, grown = 0;
    for (const std::uint32_t v : vertices) {
      if (near_[v].part == kNone) continue;  // cancelled
      if (near_[v].distance_sq > most) {
        most = near_[v].distance_sq;
        part.farthest = v;
      }
      grown = std::max(grown, parts_[near_[v].part].growth);
    }
    const double reach = part.inherited + std::sqrt(std::max(0.0, most));
    choose_heir(p);
    if (!keep_area_ || part.heir == kNone) return reach * part.factor;
    const Part& heir = parts_[part.heir];
    const double growth = heir.shape.growth_for(heir.stands + part.stands);
    return std::max(reach + grown, std::max(reach, heir.inherited) + growth) * part.factor;
  }

  // The nearest of its kind; else the nearest that may grow; else the nearest.
  void choose_heir(std::uint32_t p) {
    Part& part = parts_[p];
    if (!keep_area_) {
      part.heir = near_[part.farthest].part;
      return;
    }
    if (part.heir != kNone && parts_[part.heir].alive) return;
    const auto may_grow = [&](std::uint32_t q) { return q != p && out_.no_prune[q] == 0 && out_.area[q] > 0; };
    const double limit = kKind * out_.area[p];
    part.heir =
        tree_->nearest(part.shape.center, [&](std::uint32_t q) { return may_grow(q) && out_.area[q] <= limit; }).part;
    if (part.heir == kNone) part.heir = tree_->nearest(part.shape.center, may_grow).part;
    if (part.heir == kNone) part.heir = near_[part.farthest].part;
  }

  void vanish(const Entry& entry) {
    Part& part = parts_[entry.part];
    last_error_ = std::max(last_error_, entry.error);
    out_.steps.push_back({entry.part, part.heir, static_cast<float>(last_error_)});
    const double reach = part.inherited + std::sqrt(std::max(0.0, near_[part.farthest].distance_sq));
    for (const std::uint32_t v : vertices_of(entry.part)) {
      Part& near = parts_[near_[v].part];
      near.inherited = std::max(near.inherited, reach);
    }
    Part& heir = parts_[part.heir];
    heir.inherited = std::max(heir.inherited, reach);
    heir.stands += part.stands;
    if (keep_area_ && out_.no_prune[part.heir] == 0) {
      heir.growth = heir.shape.growth_for(heir.stands);
    }
    part.alive = false;
    tree_->remove(entry.part);
    --left_;
  }

  bool keep_area_;
  PruneOrder& out_;
  const Task& task_;
  std::vector<Part> parts_;
  std::vector<Vec3d> positions_;             // where errors are judged
  std::vector<Triangle> triangles_;          // vertices
  std::vector<std::uint32_t> vertex_first_;  // of each part in `vertices_`, and the end
  std::vector<std::uint32_t> vertices_;
  std::vector<NearestPart> near_;  // one a vertex; right while that part is alive
  std::optional<spatial::PartTree> tree_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t left_ = 0;
  double last_error_ = 0;
};

Result<void> check(const Mesh& mesh, const PruneOptions& options) {
  const auto wrong = [&](std::size_t size) { return size != 0 && size != mesh.vertex_count(); };
  if (wrong(options.no_move.size()) || wrong(options.weights.size())) {
    return fail(ErrorCode::bad_argument, "a list of vertices has another length than the mesh's vertices", "thin parts",
                "give one entry a vertex");
  }
  for (const std::uint32_t t : options.left_out) {
    if (t < mesh.triangles.size()) continue;
    return fail(ErrorCode::bad_argument, fmt::format("triangle {} of {} is to be left out", t, mesh.triangles.size()),
                "thin parts");
  }
  return {};
}

}  // namespace

Result<PruneOrder> prune_order(const Mesh& mesh, const PruneOptions& options, Task task) {
  LODESTONE_TRY(check(mesh, options));
  if (options.input != Input::valid) {
    LODESTONE_TRY(validate(mesh, task));
  }
  PruneOrder out;
  out.parts = parts_of(mesh);
  Greedy(mesh, options, out, task).run();
  if (task.cancelled()) return cancelled_error("thin parts");
  return out;
}

}  // namespace lodestone::simplify
