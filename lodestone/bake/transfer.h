// Normals and colours of a source onto the vertices of another surface.
#pragma once

#include "lodestone/bake/source.h"

namespace lodestone::bake {

struct TransferOptions {
  bool normals = true;
  bool colors = true;  ///< nothing where the source is plain white
};

/// The target with a normal stream (3 floats) and a colour stream (COLOR_0, 4 normalised bytes: light as glTF takes it,
/// alpha 1), each vertex's from the place of the source that BakeSource::find() gives. Positions are in the source's
/// world space. Where the source's normal points away from the target's own smooth one by more than a right angle, that
/// one is taken. Streams of these names are replaced and tangents, which would be stale, left out; all others stay, and
/// so do wedges: all of a vertex get the same. Same bytes for any thread count. O(vertices log source).
/// Errors: bad_argument (those of validate(), of the target), empty (no triangle), cancelled.
Result<Mesh> transfer_attributes(const Mesh& target, const BakeSource& source, const TransferOptions& options = {},
                                 Task task = {});

}  // namespace lodestone::bake
