// Sources and targets for tests of baking.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "lodestone/base/random.h"
#include "lodestone/core/model.h"
#include "support/shapes.h"

namespace lodestone::bake::test {

using namespace lodestone::test;

/// A sphere whose vertices are moved in and out at random by up to `most`.
inline Mesh blob(int rings, double most) {
  Mesh mesh = sphere(rings);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.positions[v] *= static_cast<float>(1 + most * (2 * random_unit(1, v) - 1));
  }
  return mesh;
}

/// A sphere with soft bumps.
inline Mesh bumpy_sphere(int rings, double height) {
  Mesh mesh = sphere(rings);
  for (Vec3f& p : mesh.positions) {
    const Vec3d q = to_double(p);
    p *= static_cast<float>(1 + height * std::sin(9 * q.x) * std::sin(9 * q.y) * std::sin(9 * q.z));
  }
  return mesh;
}

/// UVs = (x, y) of the box [-1.05, 1.05] onto [0, 1], and a texture whose red grows with u, its green with v.
inline Model with_gradient(Mesh mesh, std::uint32_t size = 256) {
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, mesh.wedge_count());
  auto& values = std::get<std::vector<float>>(uv.values);
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f& p = mesh.positions[mesh.vertex_of(w)];
    values[2 * w] = (p.x / 1.05F + 1) / 2;
    values[2 * w + 1] = (p.y / 1.05F + 1) / 2;
  }
  mesh.attributes.push_back(std::move(uv));
  mesh.groups = {{0, ""}};
  auto pixels = std::make_shared<Pixels>();
  pixels->width = pixels->height = size;
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      const auto byte = [&](std::uint32_t i) { return static_cast<std::uint8_t>(255 * i / (size - 1)); };
      pixels->rgba.insert(pixels->rgba.end(), {byte(x), byte(y), 60, 255});
    }
  }
  Model model = make_model(std::move(mesh));
  model.uv_origin_top = true;
  model.materials.resize(1);
  model.materials[0].base_color_pixels = std::move(pixels);
  model.materials[0].base_color_texture = std::make_shared<Image>();
  return model;
}

inline const std::vector<float>& floats(const Mesh& mesh, Semantic semantic) {
  return std::get<std::vector<float>>(find_stream(mesh, semantic)->values);
}

/// A random point of the i-th kind on the mesh: a triangle and weights of its corners.
struct SurfacePoint {
  std::size_t triangle;
  std::array<double, 3> weights;
};
inline SurfacePoint random_point(const Mesh& mesh, std::uint64_t i) {
  const double root = std::sqrt(random_unit(7, 3 * i)), part = random_unit(7, 3 * i + 1);
  return {random_bits(7, 3 * i + 2) % mesh.triangles.size(), {1 - root, root * (1 - part), root * part}};
}

/// The mean of a stream's first components over a triangle's corners.
template <std::size_t N>
std::array<double, N> value_at(const Mesh& mesh, Semantic semantic, const SurfacePoint& spot) {
  const AttributeStream& stream = *find_stream(mesh, semantic);
  const auto& values = std::get<std::vector<float>>(stream.values);
  std::array<double, N> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t w = mesh.triangles[spot.triangle][k];
    for (std::size_t n = 0; n < N; ++n) out[n] += spot.weights[k] * double(values[w * stream.components + n]);
  }
  return out;
}

inline Vec3d point_at(const Mesh& mesh, const SurfacePoint& spot) {
  Vec3d out;
  const Triangle v = mesh.vertices_of(spot.triangle);
  for (std::size_t k = 0; k < 3; ++k) out += mesh.position(v[k]) * spot.weights[k];
  return out;
}

}  // namespace lodestone::bake::test
