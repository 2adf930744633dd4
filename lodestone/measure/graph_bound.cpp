// A bound on the distance of a piece of a triangle from a surface that lies over it like a graph.
//
// Method: from a triangle of the other surface on, visit() goes across all sides that cross the piece in projection. If
// every triangle met so faces the same way, no such side is open and neighbours walk their common side in opposite
// directions, then the projection of the patch is a covering of the piece: near any point of the patch it is one to
// one, so the part of the piece that is covered is open and closed in it. Hence every point of the piece has a partner
// straight above or below. The greatest such height, which lies at a corner of the patch's triangles clipped to the
// piece, bounds the distance. Cost: O(triangles of the patch).
#include "lodestone/measure/graph_bound_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/math/triangle.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kMostTriangles = 40;
// Of the piece's size: what its outline is widened by, far more than rounding.
constexpr double kMargin = 1e-9;
constexpr double kSteepest = 0.05;  // cosine between the normals of a triangle and the piece
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

double GraphBound::operator()(const std::array<Vec3d, 3>& corners, std::span<const std::uint32_t> start,
                              double enough) {
  const auto& [a, b, c] = corners;
  origin_ = a;
  up_ = normalized(scaled_normal(a, b, c));
  x_ = normalized(b - a);
  if (up_ == Vec3d{} || x_ == Vec3d{}) return kInfinity;
  y_ = cross(up_, x_);
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d d = corners[i] - origin_;
    piece_[i] = {dot(d, x_), dot(d, y_), 0};
    size = std::max({size, std::abs(piece_[i].x), std::abs(piece_[i].y)});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Flat &p = piece_[i], &q = piece_[(i + 1) % 3];
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) return kInfinity;
    lines_[i] = {-dy / length, dx / length, (dy * p.x - dx * p.y) / length + kMargin * size};
  }
  for (const std::uint32_t first : start) {
    patch_.assign(1, first);
    facing_ = highest_ = 0;
    for (std::size_t i = 0; i < patch_.size(); ++i) {
      if (!visit(patch_[i]) || patch_.size() > kMostTriangles || highest_ > enough) return kInfinity;
    }
    if (facing_ != 0) return highest_;  // else `first` lies beside the piece
  }
  return kInfinity;
}

// Takes a triangle of the patch: its heights over the piece, and its neighbours. False: not a graph.
bool GraphBound::visit(std::uint32_t triangle) {
  const auto corners = to_.corners(triangle);
  std::array<Flat, 3> flat;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d d = corners[i] - origin_;
    flat[i] = {dot(d, x_), dot(d, y_), dot(d, up_)};
  }
  double inside[3][3];
  for (std::size_t line = 0; line < 3; ++line) {
    for (std::size_t k = 0; k < 3; ++k) {
      inside[line][k] = lines_[line].a * flat[k].x + lines_[line].b * flat[k].y + lines_[line].c;
    }
  }
  // Each side's part over the piece: the interval of its parameter, and the heights at its ends.
  bool touches = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    double low = 0, high = 1;
    for (std::size_t line = 0; line < 3; ++line) {
      const double p = inside[line][k], q = inside[line][n];
      if (p < 0 && q < 0) {
        low = 2;
        break;
      }
      if (p < 0) low = std::max(low, p / (p - q));
      if (q < 0) high = std::min(high, p / (p - q));
    }
    if (low > high) continue;
    touches = true;
    for (const double s : {low, high}) {
      highest_ = std::max(highest_, std::abs(flat[k].height + s * (flat[n].height - flat[k].height)));
    }
    const std::uint32_t next = neighbors_[triangle][k];
    if (next == kNone) return false;
    if (std::find(patch_.begin(), patch_.end(), next) == patch_.end()) patch_.push_back(next);
  }
  // Twice the projected area (of either sign), and the piece's own corners where they lie under the triangle.
  const double ux = flat[1].x - flat[0].x, uy = flat[1].y - flat[0].y, vx = flat[2].x - flat[0].x,
               vy = flat[2].y - flat[0].y;
  const double area = ux * vy - vx * uy;
  for (const Flat& corner : piece_) {
    const double px = corner.x - flat[0].x, py = corner.y - flat[0].y;
    const double s = (px * vy - vx * py) / area, t = (ux * py - px * uy) / area;
    if (!(s >= -kMargin && t >= -kMargin && s + t <= 1 + kMargin)) continue;
    touches = true;
    const double height =
        flat[0].height + s * (flat[1].height - flat[0].height) + t * (flat[2].height - flat[0].height);
    highest_ = std::max(highest_, std::abs(height));
  }
  if (!touches) return true;
  const double whole = length(scaled_normal(corners[0], corners[1], corners[2]));
  if (!(std::abs(area) > kSteepest * whole)) return false;
  if (facing_ != 0 && (area > 0) != (facing_ > 0)) return false;
  facing_ = area;
  return true;
}

}  // namespace lodestone::measure::detail
