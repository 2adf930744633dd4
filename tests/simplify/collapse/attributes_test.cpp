// What users rely on for attributes in edge collapse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/math/triangle.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

EdgeCollapseResult collapse(const Mesh& mesh, std::size_t target, const AttributeWeights& weights = {}) {
  EdgeCollapseOptions options;
  options.target_triangles = target;
  options.attribute_weights = weights;
  Result<EdgeCollapseResult> r = collapse_edges(mesh, options);
  EXPECT_TRUE(r);
  return std::move(*r);
}

template <class Value>
Mesh with_stream(Mesh mesh, const char* name, Semantic semantic, std::uint32_t components, Value value) {
  AttributeStream stream =
      make_stream(name, semantic, components, ComponentType::float32, false, mesh.positions.size());
  auto& values = std::get<std::vector<float>>(stream.values);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) value(mesh.positions[v], values.data() + v * components);
  mesh.attributes.push_back(std::move(stream));
  return mesh;
}

const std::vector<float>& floats(const Mesh& mesh, std::size_t stream = 0) {
  return std::get<std::vector<float>>(mesh.attributes[stream].values);
}

// Mean deviation of the first component from value(x, y) over the triangles, areas counted in the plane.
template <class Value>
double mean_error(const Mesh& mesh, Value value) {
  const std::uint32_t n = mesh.attributes[0].components;
  double sum = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& w = mesh.triangles[t];
    const Triangle v = mesh.vertices_of(t);
    const double a = length(scaled_normal(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])));
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; i + j < kSteps; ++j) {
        const double s = (i + 1.0 / 3) / kSteps, r = (j + 1.0 / 3) / kSteps, q = 1 - s - r;
        const Vec3d p = mesh.position(v[0]) * q + mesh.position(v[1]) * s + mesh.position(v[2]) * r;
        const auto& f = floats(mesh);
        const double is = q * double{f[n * w[0]]} + s * double{f[n * w[1]]} + r * double{f[n * w[2]]};
        sum += a * std::abs(is - value(p.x, p.y));
        area += a;
      }
    }
  }
  return sum / area;
}

// A painted line on a flat sheet costs no shape at all, and must not be lost for that.
TEST(CollapseAttributes, a_painted_line_on_a_flat_sheet_stays) {
  const auto stripe = [](double x, double) { return std::abs(x - 0.52) < 0.06 ? 1.0 : 0.0; };
  const Mesh in = with_stream(test::grid(40), "COLOR_0", Semantic::color, 3, [&](Vec3f p, float* c) {
    c[0] = static_cast<float>(stripe(p.x, p.y));
    c[1] = c[2] = 0.5F;
  });
  const double before = mean_error(in, stripe);
  EXPECT_LT(mean_error(collapse(in, 320).mesh, stripe), before + 0.005);
  AttributeWeights none;
  none.color = 0;
  EXPECT_GT(mean_error(collapse(in, 320, none).mesh, stripe), before + 0.01);
}

TEST(CollapseAttributes, what_is_linear_over_the_surface_stays_so) {
  const auto ramp = [](double x, double y) { return 3 * x - 2 * y + 0.25; };
  for (const float bend : {0.0F, 0.05F}) {
    const Mesh in = with_stream(test::grid(24, bend), "TEXCOORD_0", Semantic::uv, 2, [&](Vec3f p, float* uv) {
      uv[0] = static_cast<float>(ramp(p.x, p.y));
      uv[1] = p.y;
    });
    EXPECT_LT(mean_error(collapse(in, 100).mesh, ramp), bend > 0 ? 5e-3 : 1e-3);
  }
}

TEST(CollapseAttributes, no_triangle_turns_over_in_its_texture) {
  for (int wave = 1; wave < 8; ++wave) {
    const Mesh in = with_stream(test::grid(30, 0.1F), "TEXCOORD_0", Semantic::uv, 2, [&](Vec3f p, float* uv) {
      uv[0] = p.x + 0.02F * static_cast<float>(std::sin(wave * 6.0 * double{p.y}));
      uv[1] = p.y;
    });
    const Mesh out = collapse(in, 40).mesh;
    const auto& uv = floats(out);
    for (const Triangle& w : out.triangles) {
      const auto at = [&](std::size_t corner, std::size_t k) { return uv[2 * w[corner] + k]; };
      const float area = (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
      EXPECT_GE(area, 0) << wave;
    }
  }
}

TEST(CollapseAttributes, values_never_leave_the_range_of_the_input) {
  const Mesh in = with_stream(test::torus(40), "COLOR_0", Semantic::color, 4, [](Vec3f p, float* c) {
    for (std::size_t k = 0; k < 4; ++k) c[k] = std::sin(9.0 * double{p.x} + static_cast<double>(k)) > 0 ? 1.0F : 0.0F;
  });
  for (const std::size_t target : {1000U, 200U, 40U}) {
    const Mesh out = collapse(in, target).mesh;
    for (const float value : floats(out)) {
      EXPECT_GE(value, 0);
      EXPECT_LE(value, 1);
    }
  }
}

TEST(CollapseAttributes, without_a_say_they_follow_and_change_nothing) {
  const Mesh plain = test::torus(24);
  const Mesh in = with_stream(plain, "_HEAT", Semantic::generic, 1,
                              [](Vec3f p, float* h) { *h = static_cast<float>(std::sin(20 * double{p.x})); });
  AttributeWeights none;
  none.by_name = {{"_HEAT", 0.0F}};
  const Mesh a = collapse(plain, 100).mesh, b = collapse(in, 100, none).mesh, c = collapse(in, 100).mesh;
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_NE(a.positions, c.positions);
}

// Every triangle with its own normals: what agreed across the edges must agree afterwards, or textures and skins tear.
TEST(CollapseAttributes, wedges_that_differ_in_normals_alone_keep_the_rest_in_common) {
  const Mesh smooth = test::grid(20, 0.1F);
  for (const float length : {1.0F, 100.0F}) {  // normals of any length are legal in OBJ
    Mesh in;
    in.positions = smooth.positions;
    std::vector<float> normals, uv, delta;
    for (const Triangle& t : smooth.triangles) {
      const Vec3d n = normalized(scaled_normal(smooth.position(t[0]), smooth.position(t[1]), smooth.position(t[2])));
      Triangle w{};
      for (std::size_t k = 0; k < 3; ++k) {
        w[k] = static_cast<std::uint32_t>(in.wedge_vertex.size());
        in.wedge_vertex.push_back(t[k]);
        const Vec3f p = smooth.positions[t[k]], m = to_float(n) * length;
        normals.insert(normals.end(), {m.x, m.y, m.z});
        uv.insert(uv.end(), {p.x + 0.1F * static_cast<float>(std::sin(9.0 * double{p.y})), p.y});
        delta.insert(delta.end(), {0, 0, p.x * p.y});
      }
      in.triangles.push_back(w);
    }
    const auto add = [&](const char* name, Semantic semantic, std::uint32_t components, std::vector<float> values) {
      in.attributes.push_back(make_stream(name, semantic, components, ComponentType::float32, false, 0));
      in.attributes.back().values = std::move(values);
    };
    add("NORMAL", Semantic::normal, 3, normals);
    add("TEXCOORD_0", Semantic::uv, 2, uv);
    add("POSITION_0", Semantic::morph_position, 3, delta);
    const Mesh out = collapse(in, 120).mesh;
    std::vector<std::uint32_t> first(out.positions.size(), kNone);
    for (std::uint32_t w = 0; w < out.wedge_count(); ++w) {
      std::uint32_t& known = first[out.vertex_of(w)];
      if (known == kNone) known = w;
      for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(floats(out, 1)[2 * w + k], floats(out, 1)[2 * known + k]);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(floats(out, 2)[3 * w + k], floats(out, 2)[3 * known + k]);
    }
  }
}

TEST(CollapseAttributes, not_a_number_and_infinities_do_no_harm) {
  const Mesh in = with_stream(test::torus(24), "TEXCOORD_0", Semantic::uv, 2, [](Vec3f p, float* uv) {
    uv[0] = p.x > 0.5F ? std::numeric_limits<float>::quiet_NaN() : p.x;
    uv[1] = p.y > 0.5F ? std::numeric_limits<float>::infinity() : 1e30F;
  });
  const EdgeCollapseResult out = collapse(in, 100);
  EXPECT_EQ(out.stop, StopReason::reached_target);
}

}  // namespace
}  // namespace lodestone::simplify
