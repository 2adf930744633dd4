#include <algorithm>
#include <cmath>
#include <utility>

#include "app/samples/noise.h"
#include "app/samples/samples.h"
#include "app/samples/surface_of_revolution.h"
#include "lodestone/math/angle.h"

namespace lodestone::app {
namespace {

constexpr double kSpan = 140;             // metres between towers
constexpr double kWaist = 26, kTop = 40;  // where the body narrows no more, and where it ends
constexpr double kArmHeights[] = {27, 32, 37};
constexpr double kArmReach[] = {6.5, 5.2, 4.0};
constexpr std::size_t kDiscs = 14;  // in a string
constexpr double kDiscPitch = 0.17, kStringTop = 0.25;
constexpr double kSag = 5;
constexpr std::size_t kLines = 2 * std::size(kArmHeights) + 1;  // six conductors and the earth wire

enum MeshIndex : std::uint32_t { kStrut, kDisc, kCable };

// How the line is made of parts.
struct TowerPlan {
  std::size_t towers = 2;
  std::size_t bays = 6;          // of the body below the waist
  std::uint32_t disc_sides = 8;  // vertices around an insulator disc
  std::size_t cable_parts = 16;  // straight pieces of a conductor
};

// An L profile from the origin to (0, 1, 0), one unit wide: scaled to length and width by each instance.
Mesh strut_mesh() {
  constexpr double kThick = 0.18;
  const Vec2d outline[] = {{0, 0},           {0, 1},      {kThick, 1},
                           {kThick, kThick}, {1, kThick}, {1, 0}};  // x, z; counter-clockwise from above
  Mesh mesh;
  mesh.name = "strut";
  for (const double y : {0.0, 1.0}) {
    for (const Vec2d p : outline) mesh.positions.push_back(to_float(Vec3d{p.x, y, p.y}));
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back(Triangle{i, j, j + 6});
    mesh.triangles.push_back(Triangle{i, j + 6, i + 6});
  }
  for (const Triangle t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 4, 5}}) {
    mesh.triangles.push_back(Triangle{t[2], t[1], t[0]});
    mesh.triangles.push_back(Triangle{t[0] + 6, t[1] + 6, t[2] + 6});
  }
  return mesh;
}

// A cap-and-pin insulator disc, 0.25 m wide; its axis is y.
Mesh disc_mesh(std::uint32_t sides) {
  constexpr Vec2d kRings[] = {
      {0.020, -0.080}, {0.070, -0.030}, {0.125, -0.020}, {0.050, 0.030}, {0.045, 0.075}};  // radius, y
  RevolutionPlan plan;
  for (std::size_t i = 0; i < std::size(kRings); ++i) {
    plan.counts.push_back(sides);
    plan.places.push_back(static_cast<double>(i + 1) / static_cast<double>(std::size(kRings) + 1));
  }
  Mesh mesh = stack_rings(plan, [&](double place, double turns) {
    const double ring = place * static_cast<double>(std::size(kRings) + 1) - 1;
    if (ring < -0.5) return Vec3d{0, -0.080, 0};
    if (ring > static_cast<double>(std::size(kRings)) - 0.5) return Vec3d{0, 0.078, 0};
    const Vec2d r = kRings[static_cast<std::size_t>(ring + 0.5)];
    const SinCos a = sin_cos_degrees(360 * turns);
    return Vec3d{r.x * a.sin, r.y, r.x * a.cos};
  });
  mesh.name = "insulator disc";
  return mesh;
}

// A cable from the origin to (0, 0, kSpan), sagging as a parabola.
Mesh cable_mesh(std::size_t parts) {
  constexpr std::uint32_t kSides = 6;
  constexpr double kRadius = 0.03;
  Mesh mesh;
  mesh.name = "cable";
  for (std::size_t i = 0; i <= parts; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(parts);
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const SinCos a = sin_cos_degrees(360 * static_cast<double>(k) / kSides);
      mesh.positions.push_back(to_float(Vec3d{kRadius * a.cos, kRadius * a.sin - 4 * kSag * t * (1 - t), t * kSpan}));
    }
  }
  for (std::size_t i = 0; i < parts; ++i) {
    const auto low = static_cast<std::uint32_t>(i * kSides);
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = low + k, b = low + (k + 1) % kSides;
      mesh.triangles.push_back(Triangle{a, b, b + kSides});
      mesh.triangles.push_back(Triangle{a, b + kSides, a + kSides});
    }
  }
  const auto last = static_cast<std::uint32_t>(parts * kSides);
  for (std::uint32_t k = 1; k + 1 < kSides; ++k) {
    mesh.triangles.push_back(Triangle{0, k + 1, k});
    mesh.triangles.push_back(Triangle{last, last + k, last + k + 1});
  }
  return mesh;
}

double half_width(double y) {
  if (y >= kTop) return 0.45;
  return y < kWaist ? 3.4 + (0.9 - 3.4) * (y / kWaist) : 0.9 + (0.45 - 0.9) * ((y - kWaist) / (kTop - kWaist));
}

Vec3d corner_at(double y, int k) {
  const double w = half_width(y);
  return {k == 0 || k == 3 ? -w : w, y, k < 2 ? -w : w};
}

// Collects the struts and discs of one tower, then of all.
class TowerBuilder {
 public:
  explicit TowerBuilder(std::vector<Instance>& instances) : instances_(instances) {}

  void strut(Vec3d from, Vec3d to, double width) {
    const Vec3d along = to - from, direction = normalized(along);
    const Vec3d aside = direction.y > 0.9 || direction.y < -0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d z = normalized(cross(aside, direction));
    const Vec3d x = cross(direction, z);
    Mat4d m;
    m.m = {x.x * width, x.y * width, x.z * width, 0, along.x, along.y, along.z, 0,
           z.x * width, z.y * width, z.z * width, 0, from.x,  from.y,  from.z,  1};
    instances_.push_back(Instance{kStrut, m, "strut"});
  }

  void body(const TowerPlan& plan, Vec3d foot) {
    const std::size_t upper = std::max<std::size_t>(2, plan.bays * 2 / 3);
    for (std::size_t i = 0; i < plan.bays; ++i)
      bay(foot, level(0, kWaist, i, plan.bays), level(0, kWaist, i + 1, plan.bays), 0.16);
    for (std::size_t i = 0; i < upper; ++i)
      bay(foot, level(kWaist, kTop, i, upper), level(kWaist, kTop, i + 1, upper), 0.11);
    for (int k = 0; k < 4; ++k) strut(foot + corner_at(kTop, k), foot + Vec3d{0, kTop + 2, 0}, 0.10);
  }

  // Two lower chords, two upper ones, and a zigzag between the lower ones.
  Vec3d arm(Vec3d foot, double y, double reach, double side) {
    const double w = half_width(y), upper = half_width(y + 1.5);
    const Vec3d tip = foot + Vec3d{side * reach, y, 0};
    const Vec3d left = foot + Vec3d{side * w, y, -w}, right = foot + Vec3d{side * w, y, w};
    for (const Vec3d end : {left, right}) strut(end, tip, 0.10);
    for (const double z : {-upper, upper}) strut(foot + Vec3d{side * upper, y + 1.5, z}, tip, 0.08);
    for (int i = 1; i <= 3; ++i) {
      const double t = i / 4.0, before = (i - 1) / 4.0;
      strut(lerp(left, tip, t), lerp(right, tip, t), 0.05);
      strut(lerp(i % 2 != 0 ? left : right, tip, before), lerp(i % 2 != 0 ? right : left, tip, t), 0.05);
    }
    return tip;
  }

  // Hangs from a tip; returns where the conductor is clamped.
  Vec3d insulators(Vec3d tip) {
    const Vec3d end = tip - Vec3d{0, kStringTop + kDiscPitch * (kDiscs + 1), 0};
    strut(tip, end, 0.02);
    for (std::size_t i = 0; i < kDiscs; ++i) {
      const Vec3d at = tip - Vec3d{0, kStringTop + kDiscPitch * (static_cast<double>(i) + 0.5), 0};
      instances_.push_back(Instance{kDisc, Mat4d::translation(at), "insulator disc"});
    }
    return end;
  }

  void cable(Vec3d from) { instances_.push_back(Instance{kCable, Mat4d::translation(from), "cable"}); }

 private:
  static double level(double from, double to, std::size_t i, std::size_t n) {
    return from + (to - from) * (static_cast<double>(i) / static_cast<double>(n));
  }
  void bay(Vec3d foot, double low, double high, double width) {
    for (int k = 0; k < 4; ++k) {
      const int next = (k + 1) % 4;
      strut(foot + corner_at(low, k), foot + corner_at(high, k), width);
      strut(foot + corner_at(low, k), foot + corner_at(high, next), width * 0.6);
      strut(foot + corner_at(low, next), foot + corner_at(high, k), width * 0.6);
      strut(foot + corner_at(high, k), foot + corner_at(high, next), width * 0.6);
    }
  }
  std::vector<Instance>& instances_;
};

std::vector<Instance> place_parts(const TowerPlan& plan, const Task& task) {
  std::vector<Instance> instances;
  TowerBuilder builder(instances);
  for (std::size_t i = 0; i < plan.towers && !task.cancelled(); ++i) {
    const Vec3d foot{0, 0, kSpan * static_cast<double>(i)};
    const bool more = i + 1 < plan.towers;
    builder.body(plan, foot);
    for (std::size_t a = 0; a < std::size(kArmHeights); ++a) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3d clamp = builder.insulators(builder.arm(foot, kArmHeights[a], kArmReach[a], side));
        if (more) builder.cable(clamp);
      }
    }
    if (more) builder.cable(foot + Vec3d{0, kTop + 2, 0});
  }
  return instances;
}

constexpr std::size_t kStrutTriangles = 20;
std::size_t disc_triangles(const TowerPlan& plan) { return 10 * std::size_t{plan.disc_sides}; }
std::size_t cable_triangles(const TowerPlan& plan) { return 12 * plan.cable_parts + 8; }

std::size_t count_struts(const TowerPlan& plan) {
  const std::size_t bays = plan.bays + std::max<std::size_t>(2, plan.bays * 2 / 3);
  return plan.towers * (16 * bays + 4 + 2 * std::size(kArmHeights) * (4 + 6 + 1));
}

std::size_t total(const TowerPlan& plan) {
  return count_struts(plan) * kStrutTriangles +
         plan.towers * 2 * std::size(kArmHeights) * kDiscs * disc_triangles(plan) +
         (plan.towers - 1) * kLines * cable_triangles(plan);
}

// As many towers as the count feeds, then bays, discs and cables that come within a thousandth of it; among those, the
// ones that look most like a real line.
TowerPlan plan_for(std::size_t triangles) {
  constexpr std::size_t kGoodBays = 7, kGoodSides = 10;
  const auto gap_of = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  TowerPlan plan, best;
  std::pair<std::size_t, std::size_t> best_score{static_cast<std::size_t>(-1), 0};
  plan.towers = std::clamp<std::size_t>(triangles / 16'000, 2, 50'000);
  for (plan.bays = 3; plan.bays <= 12; ++plan.bays) {
    for (plan.disc_sides = 3; plan.disc_sides <= 24; ++plan.disc_sides) {
      plan.cable_parts = 0;
      const std::size_t base = total(plan), step = (plan.towers - 1) * kLines * 12;
      const std::size_t parts = triangles > base ? (triangles - base + step / 2) / step : 0;
      plan.cable_parts = std::clamp<std::size_t>(parts, 8, 200);
      const std::size_t gap = std::max(gap_of(total(plan), triangles), triangles / 1000);
      const std::pair score{gap, 2 * gap_of(plan.bays, kGoodBays) + gap_of(plan.disc_sides, kGoodSides)};
      if (score < best_score) {
        best = plan;
        best_score = score;
      }
    }
  }
  return best;
}

}  // namespace

Model make_tower(std::size_t triangles, const Task& task) {
  const TowerPlan plan = plan_for(triangles);
  Model model;
  model.meshes = {strut_mesh(), disc_mesh(plan.disc_sides), cable_mesh(plan.cable_parts)};
  model.instances = place_parts(plan, task);
  model.meters_per_unit = 1;
  const auto paint = [&](MeshIndex mesh, const char* name, std::array<float, 4> color, float metallic) {
    Material material;
    material.name = name;
    material.base_color = color;
    material.metallic = metallic;
    material.roughness = 0.6f;
    model.materials.push_back(material);
    model.meshes[mesh].groups = {FaceGroup{static_cast<std::uint32_t>(model.materials.size() - 1), ""}};
  };
  paint(kStrut, "steel", {0.45f, 0.47f, 0.48f, 1}, 0.8f);
  paint(kDisc, "porcelain", {0.35f, 0.18f, 0.12f, 1}, 0);
  paint(kCable, "aluminium", {0.60f, 0.60f, 0.62f, 1}, 0.9f);
  return model;
}

}  // namespace lodestone::app
