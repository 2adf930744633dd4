// Vertex classes: what may move, and along what (docs/papers/edge-collapse.md, "Vertex classes").
//
// A feature edge is a border, a seam, an edge between two face groups, or a non-manifold edge (is_feature_edge()). A
// seam counts only where a stream other than normals and tangents differs. classify_vertices() looks at each vertex:
// 1. is_plain(): one closed fan of triangles that turn the same way, without a feature edge. Most vertices are that,
//    and done: interior.
// 2. Fans::look_at() lists the triangles at each spoke; Fans::classify() joins those across spokes that are no feature
//    edges into fans (union-find). One fan and no feature edge: interior. Exactly two feature edges, and every fan
//    reaches from the one to the other (every_fan_joins_both()): feature, so that borders, seams and the spines of
//    several sheets can collapse along themselves. Everything else is no_move, with its cause.
// 3. The options come last: vertices that are no_move by request, and those of borders with keep_border.
//
// Runs once, before the first pass: collapses leave classes as they are, since features collapse only along themselves.
// Vertices don't depend on each other: the same for any number of threads. O(valence) for plain vertices, else
// O(valence log valence).
#include <algorithm>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/simplify/collapse/state_detail.h"

namespace lodestone::simplify::detail {

namespace {

// One closed fan of triangles that turn the same way, without a feature edge: what most vertices are.
bool is_plain(const State& state, std::uint32_t v, std::span<const Corner> corners) {
  const bool plain_surface = state.wedges.empty() && state.groups.empty();
  Fan fan;
  if (corners.empty() || !fan.load(corners)) return false;
  std::uint32_t at = 0;
  for (std::size_t step = 1; step <= corners.size(); ++step) {
    const std::uint32_t before = fan.before(corners[at].a);
    if (before == kNone) return false;
    const std::uint32_t both[2] = {corners[at].triangle, corners[before].triangle};
    if (!plain_surface && is_feature_edge(state, v, corners[at].a, both)) return false;
    at = before;
    if (at == 0) return step == corners.size();
  }
  return false;
}

// A vertex's triangles, cut along feature edges into fans.
class Fans {
 public:
  explicit Fans(const State& state) : state_(state) {}

  void look_at(std::uint32_t v) {
    v_ = v;
    const auto star = state_.star_of(v);
    parent_.resize(star.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    spokes_.clear();
    for (std::uint32_t i = 0; i < star.size(); ++i) {
      for (const std::uint32_t u : state_.triangles[star[i] >> 2]) {
        if (u != v) spokes_.push_back({u, i});
      }
    }
    std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) {
      return a.neighbour != b.neighbour ? a.neighbour < b.neighbour : a.triangle < b.triangle;
    });
  }

  struct Answer {
    VertexClass vertex_class = VertexClass::interior;
    LockCause cause = LockCause::none;
    bool on_border = false;
  };

  Answer classify() {
    Answer answer;
    bool non_manifold = false;
    feature_spokes_.clear();
    std::size_t features = 0;
    for (std::size_t i = 0, j = 0; i < spokes_.size(); i = j) {
      while (j < spokes_.size() && spokes_[j].neighbour == spokes_[i].neighbour) ++j;
      if (is_feature(i, j)) {
        answer.on_border = answer.on_border || j - i == 1;
        non_manifold = non_manifold || j - i > 2;
        ++features;
        feature_spokes_.insert(feature_spokes_.end(), spokes_.begin() + static_cast<std::ptrdiff_t>(i),
                               spokes_.begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        parent_[root(spokes_[i].triangle)] = root(spokes_[i + 1].triangle);
      }
    }
    std::size_t fans = 0;
    for (std::uint32_t t = 0; t < parent_.size(); ++t) fans += parent_[t] == t ? 1 : 0;
    if (features == 0 && fans <= 1) return answer;
    if (features == 2 && every_fan_joins_both(feature_spokes_, fans)) {
      answer.vertex_class = VertexClass::feature;
      return answer;
    }
    answer.vertex_class = VertexClass::no_move;
    answer.cause = non_manifold || features == 0 ? LockCause::non_manifold : LockCause::seam_corner;
    return answer;
  }

 private:
  struct Spoke {
    std::uint32_t neighbour, triangle;  // triangle: position in the star
  };

  bool is_feature(std::size_t begin, std::size_t end) const {
    if (end - begin != 2) return true;
    const auto star = state_.star_of(v_);
    const std::uint32_t both[2] = {star[spokes_[begin].triangle] >> 2, star[spokes_[begin + 1].triangle] >> 2};
    return is_feature_edge(state_, v_, spokes_[begin].neighbour, both);
  }

  std::uint32_t root(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }

  // Each fan is open, with one end on either feature edge: a page of a book whose spine runs through the vertex.
  bool every_fan_joins_both(const std::vector<Spoke>& spokes, std::size_t fans) {
    std::vector<std::uint32_t> at_first, at_second;
    for (const Spoke& s : spokes) {
      (s.neighbour == spokes.front().neighbour ? at_first : at_second).push_back(root(s.triangle));
    }
    std::sort(at_first.begin(), at_first.end());
    std::sort(at_second.begin(), at_second.end());
    const bool once = std::adjacent_find(at_first.begin(), at_first.end()) == at_first.end();
    return once && at_first == at_second && at_first.size() == fans;
  }

  const State& state_;
  std::uint32_t v_ = 0;
  std::vector<std::uint32_t> parent_;
  std::vector<Spoke> spokes_, feature_spokes_;
};

}  // namespace

bool is_feature_edge(const State& state, std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> triangles) {
  if (triangles.size() != 2) return true;
  const std::uint32_t s = triangles[0], t = triangles[1];
  if (!state.groups.empty() && state.groups[s] != state.groups[t]) return true;
  if (state.wedges.empty()) return false;
  for (const std::uint32_t v : {a, b}) {
    const std::uint32_t ws = wedge_at(state, s, v), wt = wedge_at(state, t, v);
    if (ws != wt && state.chart[ws] != state.chart[wt]) return true;
  }
  return false;
}

void classify_vertices(State& state, const EdgeCollapseOptions& options, const Task& task) {
  build_stars(state, task);
  const std::size_t n = state.positions.size();
  state.classes.assign(n, VertexClass::interior);
  state.causes.assign(n, LockCause::none);
  parallel_for(n, 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    Fans fans(state);  // their memory serves all vertices of the chunk
    std::vector<Corner> memory;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      Fans::Answer answer;
      if (!is_plain(state, v, gather(state, v, memory))) {
        fans.look_at(v);
        answer = fans.classify();
      }
      LockCause cause = answer.cause;
      if (!options.no_move.empty() && options.no_move[state.original[v]] != 0) {
        cause = LockCause::by_request;
      } else if (options.keep_border && answer.on_border) {
        cause = LockCause::border;
      }
      state.classes[v] = cause == LockCause::none ? answer.vertex_class : VertexClass::no_move;
      state.causes[state.original[v]] = cause;
    }
  });
}

}  // namespace lodestone::simplify::detail
