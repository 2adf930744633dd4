// The models that `lod sample` makes: pure functions, the same bits on every machine. What comes back from a cancelled
// task is not complete.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

inline constexpr std::size_t kMostSampleTriangles = 500'000'000;
inline constexpr int kMostSphereLevel = 12;

/// Icosphere of radius 1: 20 * 4^level triangles. level <= kMostSphereLevel.
Model make_icosphere(int level, const Task& task);
/// Sphere of radius 1 with the nearest even count of at least 6.
Model make_sphere(std::size_t triangles, const Task& task);

/// A bust on a plinth, 0.67 m high, rough like a scan: closed, genus 0, the nearest even count of at least 6.
Model make_statue(std::size_t triangles, std::uint64_t seed, const Task& task);

/// A power line: lattice towers of one strut mesh placed many times, insulator strings of one disc mesh, conductors of
/// one cable mesh. Metres. As near to the count as whole parts allow; more triangles mean more towers.
Model make_tower(std::size_t triangles, const Task& task);

/// Mountains on 2 x 2 km with texture coordinates and an open border; the nearest count that rows and columns allow.
Model make_terrain(std::size_t triangles, std::uint64_t seed, const Task& task);

}  // namespace lodestone::app
