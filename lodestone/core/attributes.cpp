#include "lodestone/core/attributes.h"

namespace lodestone {

std::size_t size_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
    case ComponentType::uint8:
      return 1;
    case ComponentType::int16:
    case ComponentType::uint16:
      return 2;
    case ComponentType::int32:
    case ComponentType::uint32:
    case ComponentType::float32:
      return 4;
    case ComponentType::float64:
      return 8;
  }
  return 0;
}

double largest_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return 127;
    case ComponentType::uint8:
      return 255;
    case ComponentType::int16:
      return 32767;
    case ComponentType::uint16:
      return 65535;
    default:
      return 1;
  }
}

bool is_blendable(const AttributeStream& stream) {
  return !std::holds_alternative<std::vector<std::uint32_t>>(stream.values);
}

AttributeStream make_stream(std::string name, Semantic semantic, std::uint32_t components, ComponentType type,
                            bool normalized, std::size_t wedges) {
  AttributeStream stream;
  stream.name = std::move(name);
  stream.semantic = semantic;
  stream.components = components;
  stream.type = type;
  stream.normalized = normalized;
  const std::size_t count = wedges * components;
  const bool picked = semantic == Semantic::joints || semantic == Semantic::categorical ||
                      type == ComponentType::int32 || type == ComponentType::uint32;
  if (picked) {
    stream.values = std::vector<std::uint32_t>(count);
  } else if (type == ComponentType::float64) {
    stream.values = std::vector<double>(count);
  } else {
    stream.values = std::vector<float>(count);
  }
  return stream;
}

}  // namespace lodestone
