// Attribute streams: what a mesh carries besides positions, one tuple a wedge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace lodestone {

/// What the values mean, and so how they may be blended.
enum class Semantic {
  normal,          ///< unit vectors, 3 components
  tangent,         ///< unit vector and handedness, 4 components
  uv,              ///< texture coordinates
  color,           ///< 3 or 4 components, in the range of the component type
  joints,          ///< skin joint numbers, picked, never averaged; paired with the `weights` stream of the same set
  weights,         ///< skin weights, summing to one over all sets of a wedge
  morph_position,  ///< position delta of a morph target; the same on all wedges of a vertex
  morph_normal,
  morph_tangent,
  morph_other,  ///< any other delta of a morph target (UV, colour)
  categorical,  ///< ids and labels: picked, never averaged
  generic,      ///< any other number: averaged
};

/// The type that the values had in the file, kept for writing back.
enum class ComponentType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one component.
std::size_t size_of(ComponentType type);

/// What a normalised 1 is stored as: the largest value of an integer type of 8 or 16 bits, 1 for all others.
double largest_of(ComponentType type);

/// One named stream. `values` holds `components` numbers for each wedge of the mesh:
/// floats for float32 and all integers of 8 and 16 bits (normalised ones already divided: [0,1] or [-1,1]),
/// doubles for float64, and 32-bit patterns for joints, categorical values and all integers of 32 bits.
struct AttributeStream {
  std::string name;  ///< as the file said: "TEXCOORD_0", "red", "quality"
  Semantic semantic = Semantic::generic;
  std::uint32_t set = 0;     ///< n of TEXCOORD_n, COLOR_n, JOINTS_n, WEIGHTS_n; 0 elsewhere
  std::uint32_t target = 0;  ///< number of the morph target (morph_* only)
  std::uint32_t components = 1;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  bool is_light = false;  ///< colours that were averaged as light: formats whose colours are sRGB get them as that
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint32_t>> values;
  /// One entry a face group: 0 where the group's primitive did not have this stream. Empty = all have it.
  std::vector<std::uint8_t> present;

  bool in_group(std::size_t group) const { return present.empty() || present[group] != 0; }
  std::size_t value_count() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
};

/// True where blending two tuples makes sense (false: one of them is picked).
bool is_blendable(const AttributeStream& stream);

/// An empty stream for `wedges` wedges with the right kind of storage for its semantic and type, filled with zeros.
AttributeStream make_stream(std::string name, Semantic semantic, std::uint32_t components, ComponentType type,
                            bool normalized, std::size_t wedges);

}  // namespace lodestone
