// From a Mesh's streams to the bytes of glTF accessors: a column is one attribute of one primitive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

/// How a stream is named and stored, decided once for a mesh.
struct AttributePlan {
  std::size_t stream = 0;      ///< index in Mesh::attributes
  std::string name;            ///< "TEXCOORD_0", "_QUALITY"
  std::size_t target = kNone;  ///< morph target, kNone for a plain attribute
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  bool flip_v = false;  ///< v' = 1 - v
};

/// The wedges that a group's triangles use, ascending, and their corners as places in that list.
struct GroupIndex {
  std::size_t group = 0;
  std::vector<std::uint32_t> wedges, corners;
};

/// Finds the triangles and wedges of one group after the other; all groups together cost O(mesh).
class GroupIndexer {
 public:
  explicit GroupIndexer(const Mesh& mesh);
  GroupIndex of(std::size_t group);

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t> first_;  // by group: its start in order_
  std::vector<std::uint32_t> order_;  // triangles by group; empty: all are in group 0
  std::vector<std::uint32_t> place_;  // by wedge: kNone between calls
};

/// An attribute's elements, each padded to a multiple of four bytes.
struct Column {
  std::string bytes;
  std::size_t components = 3, stride = 12;
  ComponentType type = ComponentType::float32;
  bool normalized = false;

  std::size_t count() const { return bytes.size() / stride; }
};

/// Positions as floats; as normalised or plain integers of `type` where these hold all of them without loss (an error
/// that was measured must stay true in the file).
Column position_column(const Mesh& mesh, const GroupIndex& index, ComponentType type, bool normalized);

/// A stream's values, made valid: normals and tangents of unit length (`face_normals`, one a wedge or empty, stand in
/// where they vanished), colours in [0, 1], skin weights of a wedge summing to one over all its sets as stored.
Column stream_column(const Mesh& mesh, const GroupIndex& index, const AttributePlan& plan,
                     const std::vector<Vec3d>& face_normals);

/// A vertex's skin weights over all its sets, scaled so that they sum to exactly one when they are stored as `type`:
/// the largest takes the rest. Where there are none the first becomes one. `weights` is not empty, none is negative.
void sum_to_one(std::span<double> weights, ComponentType type);

/// `value` as an accessor's element of `type`, rounded and clamped to what it holds.
void store_number(char* at, double value, ComponentType type, bool normalized);

/// The normal of the first triangle at each wedge.
std::vector<Vec3d> face_normals_of(const Mesh& mesh, const GroupIndex& index);

/// The accessor's JSON without a view. `bounds`: with smallest and largest values, as stored.
Json describe_column(const Column& column, std::size_t count, bool bounds);

}  // namespace lodestone::io
