// PartShape: how a part may be enlarged so that its area grows and its vertices move as little as they can.
//
// A leaf grows in its plane, a strut across: along each principal axis the part's end moves by as much as area gains
// from it. With s_i the scale along axis i, area is at least  sum_i A_i s_j s_k  (A_i = area times the squared
// component of the normal along i; exact for faces across the axes), and at s = 1 it gains A - A_i from s_i, so
// (A - A_i) / e_i from moving the ends at distance e_i. Ends move in these proportions: the steepest way up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lodestone/math/mat.h"
#include "lodestone/math/symmetric.h"
#include "lodestone/math/triangle.h"
#include "lodestone/math/vec.h"

namespace lodestone::simplify::detail {

struct PartShape {
  double area = 0;
  Vec3d center;                    // of area
  std::array<Vec3d, 3> axes;       // principal ones
  std::array<double, 3> share{};   // A_i
  std::array<double, 3> extent{};  // e_i
  std::array<double, 3> pace{};    // how far the end along axis i moves, relative to the fastest
  double reach = 0;                // how far a vertex moves at most when the fastest end moves by 1

  // The move of the fastest end that gives the part an area.
  double step_for(double wanted) const {
    if (!(reach > 0) || !(wanted > area)) return 0;
    std::array<double, 3> k{};
    for (std::size_t i = 0; i < 3; ++i) k[i] = pace[i] > 0 ? pace[i] / extent[i] : 0;
    double a = 0, b = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double p = k[(i + 1) % 3], q = k[(i + 2) % 3];
      a += share[i] * p * q;
      b += share[i] * (p + q);
    }
    const double c = wanted - area;
    return b > 0 ? 2 * c / (b + std::sqrt(b * b + 4 * a * c)) : 0;
  }
  // How far its farthest vertex moves for an area.
  double growth_for(double wanted) const { return step_for(wanted) * reach; }

  // The linear map about the centre that moves the fastest end by `step`.
  Mat4d enlarging(double step) const {
    Symmetric3d m;
    for (std::size_t i = 0; i < 3; ++i) m.add(axes[i], 1 + (pace[i] > 0 ? step * pace[i] / extent[i] : 0));
    Mat4d out;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) out.m[column * 4 + row] = m.rows[row][column];
    }
    return out;
  }
};

// Builds shapes: first all triangles of a part, then its vertices.
class PartMeasure {
 public:
  void add_triangle(Vec3d a, Vec3d b, Vec3d c) {
    if (shape_.area == 0 && !begun_) {
      origin_ = a;  // moments about a near point lose no digits far from the origin
      begun_ = true;
    }
    const Vec3d n = scaled_normal(a, b, c);
    const double twice = length(n);
    if (!(twice > 0)) return;
    shape_.area += twice / 2;
    a -= origin_;
    b -= origin_;
    c -= origin_;
    const Vec3d sum = a + b + c;
    moment_ += sum * (twice / 6);
    for (const Vec3d v : {a, b, c, sum}) second_.add(v, twice / 24);
    normals_.add(n, 0.5 / twice);
  }

  void end_triangles() {
    if (!(shape_.area > 0)) return;
    const Vec3d mean = moment_ / shape_.area;
    shape_.center = origin_ + mean;
    second_.add(mean, -shape_.area);
    shape_.axes = axes_of(second_);
    for (std::size_t i = 0; i < 3; ++i) shape_.share[i] = normals_.form(shape_.axes[i]);
  }

  void add_vertex(Vec3d v) {
    for (std::size_t i = 0; i < 3; ++i) {
      shape_.extent[i] = std::max(shape_.extent[i], std::abs(dot(v - shape_.center, shape_.axes[i])));
    }
  }

  const PartShape& end_vertices() {
    const double longest = std::max({shape_.extent[0], shape_.extent[1], shape_.extent[2]});
    double fastest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool flat = !(shape_.extent[i] > 1e-6 * longest);
      shape_.pace[i] = flat ? 0 : std::max(0.0, shape_.area - shape_.share[i]) / shape_.extent[i];
      fastest = std::max(fastest, shape_.pace[i]);
    }
    Vec3d paces;
    for (std::size_t i = 0; i < 3 && fastest > 0; ++i) paces[i] = shape_.pace[i] /= fastest;
    shape_.reach = length(paces);
    return shape_;
  }

  const PartShape& shape() const { return shape_; }

 private:
  PartShape shape_;
  Vec3d origin_, moment_;
  Symmetric3d second_, normals_;
  bool begun_ = false;
};

}  // namespace lodestone::simplify::detail
