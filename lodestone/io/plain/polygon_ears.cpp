// Clipping ears. A corner is an ear if the triangle with its neighbours holds no other part of the polygon, which is so
// if it holds no blunt corner. Whether a corner is one changes only when a neighbour is clipped, so 3n tests do: a heap
// gives the corner with the shortest cut, and a tree of boxes tells in about log n steps whether a blunt corner is in
// its triangle. Clipped in this order, a row of near corners is halved again and again, and no corner collects a fan.
//
// Polygons that cross themselves run out of ears. Then the corner with the shortest cut goes although it is none; where
// the rest runs clockwise altogether (a figure of eight), its ears are those that turn the other way.
#include <algorithm>
#include <limits>

#include "lodestone/io/plain/polygon_ears_detail.h"

namespace lodestone::io {

namespace {

constexpr std::uint64_t kSteps = 4194304, kStepsPerCorner = 128;
constexpr std::uint32_t kMostTurns = 8;

}  // namespace

template <class Use>
void EarClipper::for_ring(Use use) const {
  std::uint32_t corner = some_;
  for (std::uint32_t i = 0; i < left_; ++i, corner = after_[corner]) use(corner);
}

void EarClipper::start() {
  const auto n = static_cast<std::uint32_t>(flat_.size());
  before_.resize(n);
  after_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    before_[i] = i == 0 ? n - 1 : i - 1;
    after_[i] = i + 1 == n ? 0 : i + 1;
  }
  owner_.assign(n, PolygonTriangles::kNoTwin);
  is_blunt_.assign(n, 0);
  stamp_.assign(n, 0);
  left_ = n;
  some_ = 0;
  turns_ = 0;
  sign_ = 1;
  budget_ = kSteps + kStepsPerCorner * n;
  mark_all();
}

double EarClipper::area_at(std::uint32_t corner) const {
  return sign_ * cross2(flat_[before_[corner]], flat_[corner], flat_[after_[corner]]);
}

double EarClipper::cut_sq(std::uint32_t corner) const {
  const Vec2d a = flat_[before_[corner]], c = flat_[after_[corner]];
  return (c.x - a.x) * (c.x - a.x) + (c.y - a.y) * (c.y - a.y);
}

void EarClipper::mark_all() {
  blunt_ = 0;
  for_ring([&](std::uint32_t corner) {
    is_blunt_[corner] = area_at(corner) > 0 ? 0 : 1;
    blunt_ += is_blunt_[corner];
  });
  has_tree_ = blunt_ > 0;
  if (has_tree_) tree_.build(flat_, is_blunt_);
}

void EarClipper::mark(std::uint32_t corner) {
  const std::uint8_t blunt = area_at(corner) > 0 ? 0 : 1;
  if (blunt == is_blunt_[corner]) return;
  is_blunt_[corner] = blunt;
  blunt_ = blunt != 0 ? blunt_ + 1 : blunt_ - 1;
  if (has_tree_) {
    blunt != 0 ? tree_.add(corner) : tree_.remove(corner);
  } else {
    has_tree_ = true;
    tree_.build(flat_, is_blunt_);
  }
}

void EarClipper::offer(std::uint32_t corner) {
  ++stamp_[corner];
  if (is_blunt_[corner] != 0) return;
  heap_.push_back({cut_sq(corner), corner, stamp_[corner]});
  std::push_heap(heap_.begin(), heap_.end());
}

// A walk around the ring counts as so many steps; without steps left any corner that is not blunt passes for an ear.
void EarClipper::charge_ring() { budget_ -= std::min<std::uint64_t>(budget_, left_); }

void EarClipper::offer_all() {
  charge_ring();
  for_ring([&](std::uint32_t corner) { offer(corner); });
}

bool EarClipper::is_ear(std::uint32_t corner) {
  if (blunt_ == 0 || budget_ == 0) return true;
  return !tree_.any_inside(flat_[before_[corner]], flat_[corner], flat_[after_[corner]], sign_, budget_);
}

// The half-edge lies on the ring's side from this corner to the next.
void EarClipper::link(std::uint32_t half_edge, std::uint32_t from, PolygonTriangles& out) {
  const std::uint32_t other = owner_[from];
  out.twin[half_edge] = other;
  if (other != PolygonTriangles::kNoTwin) out.twin[other] = half_edge;
}

void EarClipper::clip_corner(std::uint32_t corner, PolygonTriangles& out) {
  const std::uint32_t a = before_[corner], c = after_[corner];
  const auto first = static_cast<std::uint32_t>(3 * out.triples.size());
  out.triples.push_back({a, corner, c});
  out.twin.resize(out.twin.size() + 3, PolygonTriangles::kNoTwin);
  link(first, a, out);
  link(first + 1, corner, out);
  owner_[a] = first + 2;
  after_[a] = c;
  before_[c] = a;
  ++stamp_[corner];
  if (is_blunt_[corner] != 0) {
    is_blunt_[corner] = 0;
    --blunt_;
    tree_.remove(corner);
  }
  --left_;
  some_ = a;
}

// One corner that is no ear. False: there is none with an area, and the rest is done.
bool EarClipper::force(PolygonTriangles& out) {
  charge_ring();
  Candidate best{std::numeric_limits<double>::infinity(), 0, 0};
  bool found = false;
  for_ring([&](std::uint32_t corner) {
    if (is_blunt_[corner] != 0) return;
    const Candidate candidate{cut_sq(corner), corner, 0};
    if (!found || best < candidate) best = candidate;
    found = true;
  });
  if (found) {
    clip_corner(best.corner, out);
    mark(before_[best.corner]);
    mark(after_[best.corner]);
    return true;
  }
  if (turns_++ == kMostTurns) return false;
  sign_ = -sign_;
  mark_all();
  return blunt_ < left_;
}

// Every second corner, again and again.
void EarClipper::clip_rest(PolygonTriangles& out) {
  for (std::uint32_t corner = some_; left_ > 3;) {
    const std::uint32_t next = after_[corner];
    clip_corner(corner, out);
    corner = after_[next];
  }
}

void EarClipper::clip(std::span<const Vec2d> corners, PolygonTriangles out) {
  flat_ = corners;
  out.triples.reserve(corners.size() - 2);
  out.twin.reserve(3 * (corners.size() - 2));
  heap_.clear();
  start();
  offer_all();
  bool clipped = false;  // since all were offered
  while (left_ > 3) {
    if (heap_.empty()) {
      if (!clipped && !force(out)) {
        clip_rest(out);
        break;
      }
      clipped = false;
      offer_all();
      continue;
    }
    std::pop_heap(heap_.begin(), heap_.end());
    const Candidate top = heap_.back();
    heap_.pop_back();
    if (top.stamp != stamp_[top.corner] || !is_ear(top.corner)) continue;
    clip_corner(top.corner, out);
    clipped = true;
    for (const std::uint32_t neighbour : {before_[top.corner], after_[top.corner]}) {
      mark(neighbour);
      offer(neighbour);
    }
  }
  const std::uint32_t last = some_;
  const auto first = static_cast<std::uint32_t>(3 * out.triples.size());
  out.triples.push_back({before_[last], last, after_[last]});
  out.twin.resize(out.twin.size() + 3, PolygonTriangles::kNoTwin);
  link(first, before_[last], out);
  link(first + 1, last, out);
  link(first + 2, after_[last], out);
}

}  // namespace lodestone::io
