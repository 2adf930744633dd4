// The faces of an OBJ: corners to wedges, polygons to triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/io/plain/color_range_detail.h"
#include "lodestone/io/plain/obj_words_detail.h"
#include "lodestone/io/plain/polygon.h"
#include "lodestone/io/plain/wedge_table_detail.h"

namespace lodestone::io {

/// What `v`, `vt` and `vn` lines gave.
struct ObjData {
  std::vector<Vec3d> positions;
  std::vector<float> colors;              ///< four a vertex, as in the file, or empty when no vertex has one
  std::vector<std::uint8_t> color_parts;  ///< then: how many of the four the file gave (0, 3 or 4)
  ColorRange color_range;
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> normals;

  /// Takes the colour of the next vertex: 3 or 4 numbers, or none. Call before its position is appended.
  void add_color(const double* values, std::size_t parts) {
    if (parts == 0 && colors.empty()) return;
    if (colors.empty()) {  // so far none had one
      colors.resize(4 * positions.size());
      color_parts.resize(positions.size());
    }
    color_parts.push_back(static_cast<std::uint8_t>(parts));
    for (std::size_t c = 0; c < 4; ++c) colors.push_back(c < parts ? static_cast<float>(values[c]) : 0.0F);
    for (std::size_t c = 0; c < parts; ++c) color_range.add(values[c]);
  }
  void clear() { *this = {}; }
};

/// How many `v`, `vt` and `vn` lines came before the present line: what negative indices count from.
struct ObjCounts {
  std::uint64_t positions = 0, uvs = 0, normals = 0;
};

class ObjFaces {
 public:
  /// `complete`: all vertices have been read. Otherwise a face that names a later one fails, and names_later_vertex()
  /// is true: it may be a fault or not.
  void begin(bool complete) { complete_ = complete; }
  bool names_later_vertex() const { return names_later_; }
  void clear() { *this = {}; }

  /// Takes the corners of an `f` line. Errors: bad_format.
  template <class Location>
  Result<void> take(WordScanner& words, const ObjData& data, const ObjCounts& counts, std::uint32_t group,
                    Location place) {
    const Fault fault = take_corners(words, data, counts);
    if (fault.what.empty()) {
      add_polygon(data, group);
      return {};
    }
    return fail(ErrorCode::bad_format, fault.what, place(), fault.remedy);
  }

  /// Moves triangles, wedges and streams into the mesh, and tells what was left out.
  void fill(Mesh& mesh, Model& model, ObjData& data);

 private:
  struct Corner {
    std::uint32_t position = kNone, uv = kNone, normal = kNone;
  };
  struct Fault {
    std::string what, remedy;
  };
  // Of one face group: whether it has corners with and without a UV and a normal.
  struct Presence {
    bool with_uv = false, without_uv = false, with_normal = false, without_normal = false;
  };

  Fault take_corners(WordScanner& words, const ObjData& data, const ObjCounts& counts);
  Fault resolve(std::int64_t index, std::uint64_t count, std::size_t known, const char* kind, std::uint32_t& into);
  void add_polygon(const ObjData& data, std::uint32_t group);
  void name_corners(const ObjData& data);

  bool complete_ = false, names_later_ = false, has_wedges_ = false;
  std::vector<Corner> corners_;       // of the present face
  std::vector<std::uint32_t> named_;  // its wedges
  std::vector<Vec3d> points_;
  PolygonCutter cutter_;
  WedgeTable table_;  // keys: uv, normal; used once a corner has one
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> face_group_;
  std::vector<Presence> presence_;  // by group
  std::uint64_t file_triangles_ = 0, short_faces_ = 0;
};

}  // namespace lodestone::io
