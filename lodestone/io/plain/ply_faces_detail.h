// The face and tristrips elements of a PLY file.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

/// Appends the faces' triangles to model.meshes[0], whose vertices have been read. Texture coordinates of faces make
/// wedges: the vertices' streams are then spread to these. Errors: bad_format, cancelled.
Result<void> read_ply_faces(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress);

/// The same for triangle strips. Triangles of a strip that use a vertex twice only join its parts and are not taken.
Result<void> read_ply_strips(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress);

}  // namespace lodestone::io
