// Model: meshes placed in a scene, and the document that they came from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/core/material.h"
#include "lodestone/core/mesh.h"
#include "lodestone/math/mat.h"

namespace lodestone {

namespace io {
class Document;  // what a file held beyond meshes; immutable; known to io alone
}

/// One placing of a mesh in the default scene.
struct Instance {
  std::uint32_t mesh = 0;
  Mat4d transform;  ///< mesh space (after Mesh::offset) to world
  std::string name;
};

/// Meshes, their instances, materials. With a glTF document, meshes[i] is its mesh i (a mesh that no instance of the
/// default scene draws stays, and is not measured) and groups[g] of a mesh is one of its triangle primitives, in order.
struct Model {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;
  std::shared_ptr<const io::Document> document;
  double meters_per_unit = 0;  ///< 1 for glTF; 0 = the file doesn't say
  Mat4d gltf_axes;             ///< turns the world so that Y is up and Z forward, as glTF wants it; mostly the identity
  /// True where v = 0 is the image's top row (glTF); false where it is the bottom one (OBJ, PLY). UVs are kept as the
  /// file had them; writers of the other kind turn them: v' = 1 - v.
  bool uv_origin_top = false;
  std::uint64_t file_vertices = 0;   ///< as stored in the file, before welding
  std::uint64_t file_triangles = 0;  ///< as stored in the file, polygons cut into triangles, nothing left out
  /// What it was read from: the file that was named, then those that this one names (buffers, images, material
  /// libraries). Writers don't replace these by side files. Empty when it was made in memory.
  std::vector<std::filesystem::path> files;
  /// What a reader found and put right or left out, in plain words, for the user.
  std::vector<std::string> warnings;
};

/// A model of one mesh placed once, as is.
Model make_model(Mesh mesh);

/// The same in the unit and with the axes of another model, whose world space it lies in.
Model make_model(Mesh mesh, const Model& like);

/// Triangles drawn: every instance counts.
std::size_t drawn_triangles(const Model& model);

/// How often each mesh is drawn.
std::vector<std::uint32_t> instance_counts(const Model& model);

/// Box of everything drawn, world space.
Box3d bounds_of(const Model& model);

}  // namespace lodestone
