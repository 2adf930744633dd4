#include <fmt/format.h>

#include <algorithm>

#include "app/input.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/table.h"
#include "app/output/text.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/units.h"
#include "lodestone/io/gltf/levels.h"
#include "lodestone/measure/shape.h"

namespace lodestone::app {
namespace {

const char* name_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return "int8";
    case ComponentType::uint8:
      return "uint8";
    case ComponentType::int16:
      return "int16";
    case ComponentType::uint16:
      return "uint16";
    case ComponentType::int32:
      return "int32";
    case ComponentType::uint32:
      return "uint32";
    case ComponentType::float32:
      return "float32";
    case ComponentType::float64:
      return "float64";
  }
  return "";
}

const char* name_of(Semantic semantic) {
  switch (semantic) {
    case Semantic::normal:
      return "normal";
    case Semantic::tangent:
      return "tangent";
    case Semantic::uv:
      return "uv";
    case Semantic::color:
      return "color";
    case Semantic::joints:
      return "joints";
    case Semantic::weights:
      return "weights";
    case Semantic::morph_position:
      return "morph_position";
    case Semantic::morph_normal:
      return "morph_normal";
    case Semantic::morph_tangent:
      return "morph_tangent";
    case Semantic::morph_other:
      return "morph_other";
    case Semantic::categorical:
      return "categorical";
    case Semantic::generic:
      return "generic";
  }
  return "";
}

void add_attributes(InfoReport& report, const Mesh& mesh) {
  for (const AttributeStream& stream : mesh.attributes) {
    AttributeReport one{stream.name, name_of(stream.semantic), name_of(stream.type), stream.components,
                        stream.normalized};
    const bool known =
        std::any_of(report.attributes.begin(), report.attributes.end(), [&](const AttributeReport& other) {
          return other.name == one.name && other.semantic == one.semantic && other.type == one.type &&
                 other.components == one.components && other.normalized == one.normalized;
        });
    if (!known) report.attributes.push_back(std::move(one));
  }
}

Result<void> examine(InfoReport& report, const Model& model, const Task& task) {
  const std::vector<std::uint32_t> counts = instance_counts(model);
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    if (counts[i] == 0) continue;
    ++report.meshes;
    add_attributes(report, model.meshes[i]);
  }
  const Result<measure::Shape> shape = measure::shape_of(model, task);
  LODESTONE_TRY(shape);
  report.topology = shape->topology;
  report.area = shape->area;
  report.volume = shape->volume;
  const Box3d bounds = bounds_of(model);
  report.instances = model.instances.size();
  report.diagonal = bounds.diagonal();
  if (!bounds.empty()) {
    report.min = {bounds.min.x, bounds.min.y, bounds.min.z};
    report.max = {bounds.max.x, bounds.max.y, bounds.max.z};
  }
  for (const Material& material : model.materials) report.materials.push_back(material.name);
  return {};
}

std::string triple(const std::array<double, 3>& v) {
  return fmt::format("({}, {}, {})", short_number(v[0]), short_number(v[1]), short_number(v[2]));
}

std::string attribute_text(const AttributeReport& a) {
  return fmt::format("{} ({}, {} x {}{})", printable(a.name), a.semantic, a.components, a.type,
                     a.normalized ? ", normalized" : "");
}

std::string table_of(const InfoReport& report) {
  const Topology& t = report.topology;
  const std::string unit = report.unit.empty() ? "" : " " + report.unit;
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("", Table::Align::left);
  const auto row = [&](const char* name, std::string value) { table.add_row({name, std::move(value)}); };
  row("file", printable(report.path));
  row("triangles",
      fmt::format("{} (in the file {})", with_separators(t.triangles), with_separators(report.file_triangles)));
  row("vertices",
      fmt::format("{} (in the file {})", with_separators(t.vertices), with_separators(report.file_vertices)));
  row("wedges", with_separators(t.wedges));
  row("meshes", fmt::format("{}, drawn {} times", with_separators(report.meshes), with_separators(report.instances)));
  row("levels", with_separators(report.levels));
  row("components", with_separators(t.components));
  row("closed", t.closed                                         ? "yes"
                : t.boundary_edges == 0 && t.duplicate_faces > 0 ? "no (doubled faces hide its borders)"
                                                                 : "no");
  row("manifold", t.manifold ? "yes" : "no");
  row("boundary edges", with_separators(t.boundary_edges));
  row("non-manifold edges", with_separators(t.nonmanifold_edges));
  row("non-manifold vertices", with_separators(t.nonmanifold_vertices));
  row("inconsistent edges", with_separators(t.inconsistent_edges));
  row("duplicate faces", with_separators(t.duplicate_faces));
  row("degenerate triangles", with_separators(t.degenerate_triangles));
  row("bounds", fmt::format("{} to {}", triple(report.min), triple(report.max)));
  row("diagonal", short_number(report.diagonal) + unit);
  row("area", short_number(report.area) + (unit.empty() ? "" : unit + "^2"));
  row("volume", short_number(report.volume) + (unit.empty() ? "" : unit + "^3") + (t.closed ? "" : " (not closed)"));
  for (const AttributeReport& attribute : report.attributes) row("attribute", attribute_text(attribute));
  for (const std::string& material : report.materials)
    row("material", material.empty() ? "(no name)" : printable(material));
  return table.text();
}

}  // namespace

Result<ExitCode> run_info(const Arguments& arguments, Console& console) {
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  InfoReport report;
  report.path = arguments.inputs.front();
  const Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  Result<Model> model = read_input(report.path, console, console.task().part(0.5, "reading"), {}, *volume);
  LODESTONE_TRY(model);
  apply_unit(*model, *lengths);
  report.unit = unit_name(model->meters_per_unit);
  report.file_vertices = model->file_vertices;
  report.file_triangles = model->file_triangles;
  report.warnings = model->warnings;
  LODESTONE_TRY(examine(report, *model, console.task().part(0.5, "counting")));
  report.levels = io::levels_in_file(report.path);
  arguments.has("--json") ? console.result(to_json(report)) : console.table(table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
