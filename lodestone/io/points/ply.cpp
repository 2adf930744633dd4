#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/plain/ply_vertices_detail.h"
#include "lodestone/io/points/read_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

std::array<std::uint8_t, 4> color_of(const float* from, std::size_t components) {
  std::array<std::uint8_t, 4> color{0, 0, 0, 255};
  for (std::size_t c = 0; c < components; ++c) {
    const float value = from[c] > 0 ? std::min(from[c], 1.0F) : 0.0F;  // not a number is 0, too
    color[c] = static_cast<std::uint8_t>(std::floor(value * 255 + 0.5F));
  }
  return color;
}

// The vertices' streams that a cloud has room for; the names of others are told.
void take_streams(const Mesh& mesh, RawPoints& raw) {
  std::string left_out;
  for (const AttributeStream& s : mesh.attributes) {
    const auto* floats = std::get_if<std::vector<float>>(&s.values);
    if (s.semantic == Semantic::normal && s.components == 3 && raw.normals.empty()) {
      raw.normals.resize(raw.positions.size());
      std::visit(
          [&](const auto& v) {
            for (std::size_t i = 0; i < raw.normals.size(); ++i) {
              raw.normals[i] = {static_cast<float>(v[3 * i]), static_cast<float>(v[3 * i + 1]),
                                static_cast<float>(v[3 * i + 2])};
            }
          },
          s.values);
    } else if (s.semantic == Semantic::color && s.components >= 3 && floats != nullptr && raw.colors.empty()) {
      raw.colors.resize(raw.positions.size());
      for (std::size_t i = 0; i < raw.colors.size(); ++i) {
        raw.colors[i] = color_of(floats->data() + i * s.components, s.components);
      }
    } else {
      left_out += fmt::format("{}'{}'", left_out.empty() ? "" : ", ", s.name);
    }
  }
  if (!left_out.empty()) raw.warnings.push_back("left out: " + left_out);
}

}  // namespace

bool ply_names_only_points(std::string_view head) {
  bool vertices = false;
  for (bool first = true; !head.empty(); first = false) {
    const std::size_t end = head.find_first_of("\r\n");
    if (end == std::string_view::npos) return false;  // the last line may be cut off
    std::string_view line = head.substr(0, end);
    head.remove_prefix(end + 1);
    if (first && trimmed(line) != "ply") return false;
    const std::string_view key = next_word(line);
    if (key == "end_header") return vertices;
    if (key != "element") continue;
    const std::string_view name = next_word(line), count = next_word(line);
    std::int64_t value = 0;
    if (name == "vertex") vertices = true;
    if ((name == "face" || name == "tristrips") && (!parse_integer(count, value) || value != 0)) return false;
  }
  return false;
}

Result<PointCloud> read_ply_points(ByteReader bytes, const Task& task) {
  Result<PlyHeader> header = read_ply_header(bytes);
  LODESTONE_TRY(header);
  const PlyElement* vertices = header->find("vertex");
  if (vertices == nullptr) {
    return fail(ErrorCode::empty, "has no points: there is no 'element vertex'", bytes.name(), "is it a point cloud?");
  }
  ReadProgress progress(task, bytes.size());
  Model model = make_model(Mesh{});
  bytes.seek(header->data_begin);
  PlyValues values(bytes, *header);
  RawPoints raw;
  for (const PlyElement& element : header->elements) {
    if (&element == vertices) {
      LODESTONE_TRY(read_ply_vertices(values, element, model, progress));
      continue;
    }
    if (element.count > 0) raw.warnings.push_back(fmt::format("element '{}' was left out", element.name));
    if (!model.meshes[0].positions.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        if (!values.skip(p)) return fail(values.error(fmt::format("{} {} of {}", element.name, i, element.count)));
      }
      if (i % 4096 == 0 && !progress.go_on(bytes.position())) return cancelled_error("reading");
    }
  }
  LODESTONE_TRY(bytes.status());
  const Mesh& mesh = model.meshes[0];
  raw.warnings.insert(raw.warnings.end(), model.warnings.begin(), model.warnings.end());
  raw.positions.resize(mesh.positions.size());
  for (std::uint32_t v = 0; v < raw.positions.size(); ++v) raw.positions[v] = mesh.position(v);
  take_streams(mesh, raw);
  return finish_points(std::move(raw), bytes.name());
}

}  // namespace lodestone::io
