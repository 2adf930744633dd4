#include "app/output/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/output/setting_names.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

Json unit_or_null(const std::string& unit) { return unit.empty() ? Json(nullptr) : Json(unit); }

void add_error(Json& json, const LevelError& error) {
  json["error"] = error.error;
  json["relative_error"] = error.relative(error.error);
  json["error_kind"] = to_string(error.kind);
  json["measured_error"] = error.measured_error;
  json["mean_error"] = error.mean_error;
  json["relative_mean_error"] = error.relative(error.mean_error);
  json["rms_error"] = error.rms_error;
  json["samples"] = error.samples;
}

Json image_json(const measure::ImageDeviation& image) {
  Json json{{"views", image.views},
            {"size_px", image.size_px},
            {"silhouette_mean", image.silhouette_mean},
            {"silhouette_max", image.silhouette_max},
            {"screen_max_px", image.screen_max_px},
            {"shading_psnr", image.shading_psnr},
            {"shading_ssim", image.shading_ssim},
            {"color_psnr", nullptr},
            {"color_ssim", nullptr}};
  if (image.has_color) {
    json["color_psnr"] = image.color_psnr;
    json["color_ssim"] = image.color_ssim;
  }
  return json;
}

Json level_json(const LevelReport& level) {
  Json json;
  json["level"] = level.level;
  json["triangles"] = level.triangles;
  if (level.vanished_parts) json["vanished_parts"] = *level.vanished_parts;
  add_error(json, level.error);
  if (level.image) json["image"] = image_json(*level.image);
  json["method"] = level.method;
  json["switch_distance"] = level.switch_distance;
  json["bytes"] = level.bytes;
  json["file"] = level.file;
  json["seconds"] = level.seconds;
  return json;
}

Json build_json(const BuildReport& report) {
  Json json;
  if (!report.failure.empty()) {
    json["input"] = {{"path", report.input}};
    json["failure"] = report.failure;
    return json;
  }
  json["input"] = {{"path", report.input}, {"triangles", report.triangles}, {"diagonal", report.diagonal}};
  json["unit"] = unit_or_null(report.unit);
  json["levels"] = Json::array();
  for (const LevelReport& level : report.levels) json["levels"].push_back(level_json(level));
  json["seconds"] = {{"read", report.read_seconds},
                     {"levels", report.levels_seconds},
                     {"measure", report.measure_seconds},
                     {"write", report.write_seconds},
                     {"total", report.total_seconds}};
  json["peak_memory_bytes"] = report.peak_memory_bytes;
  if (!report.report.empty()) json["report"] = report.report;
  if (report.verified) {
    json["verified"] = {{"levels", report.verified->levels},
                        {"largest_difference", report.verified->largest_difference}};
  }
  json["warnings"] = with_options(report.warnings);
  json["shortfalls"] = Json::array();
  for (const chain::Shortfall& shortfall : report.shortfalls) {
    json["shortfalls"].push_back({{"level", shortfall.level}, {"reason", with_options(shortfall.reason)}});
  }
  return json;
}

Json directed_json(const measure::DirectedDistance& d) {
  return {{"max", d.sampled_max},
          {"found_max", d.max},
          {"bound", d.bound},
          {"mean", d.mean},
          {"rms", d.rms},
          {"median", d.median},
          {"percentile_95", d.percentile_95},
          {"percentile_99", d.percentile_99},
          {"histogram", d.histogram},
          {"histogram_step", d.histogram_step},
          {"max_at", {d.max_at.x, d.max_at.y, d.max_at.z}},
          {"normal_degrees", d.normal_degrees}};
}

}  // namespace

std::string to_json(const BuildReport& report) { return text_of(build_json(report)); }

std::string to_json(const std::vector<BuildReport>& runs) {
  Json json;
  json["runs"] = Json::array();
  for (const BuildReport& run : runs) json["runs"].push_back(build_json(run));
  return text_of(json);
}

std::string to_json(const SimplifyReport& report) {
  Json json;
  json["input"] = {{"path", report.input}};
  json["triangles_in"] = report.triangles_in;
  json["triangles"] = report.triangles;
  if (report.vanished_parts) json["vanished_parts"] = *report.vanished_parts;
  add_error(json, report.error);
  json["diagonal"] = report.error.diagonal;
  json["unit"] = unit_or_null(report.unit);
  json["method"] = report.method;
  json["stop_reason"] = report.stop_reason;
  json["shortfall"] = report.shortfall.empty() ? Json(nullptr) : Json(with_options(report.shortfall));
  json["locked"] = {{"border", report.locked.border},
                    {"seam_corner", report.locked.seam_corner},
                    {"non_manifold", report.locked.non_manifold},
                    {"by_request", report.locked.by_request}};
  json["file"] = report.output;
  json["bytes"] = report.bytes;
  json["seconds"] = {{"read", report.read_seconds},
                     {"simplify", report.simplify_seconds},
                     {"measure", report.measure_seconds},
                     {"write", report.write_seconds}};
  json["peak_memory_bytes"] = report.peak_memory_bytes;
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

Json deviation_json(const measure::Deviation& d) {
  return {{"mean", d.mean},  {"rms", d.rms}, {"max", d.max}, {"median", d.median}, {"percentile_95", d.percentile_95},
          {"share", d.share}};
}

Json figure_json(const measure::AttributeFigure& figure) {
  Json json = deviation_json(figure.both);
  json["forward"] = deviation_json(figure.forward);
  json["backward"] = deviation_json(figure.backward);
  return json;
}

Json attributes_json(const measure::Attributes& attributes) {
  Json json;
  json["normal_degrees"] = figure_json(attributes.normal);
  json["uv"] = Json::array();
  for (const measure::UvFigure& uv : attributes.uv) {
    Json one = figure_json(uv.distance);
    one["set"] = uv.set;
    one["diagonal"] = uv.diagonal;
    one["relative_mean"] = uv.relative(uv.distance.both.mean);
    one["relative_rms"] = uv.relative(uv.distance.both.rms);
    one["relative_max"] = uv.relative(uv.distance.both.max);
    json["uv"].push_back(std::move(one));
  }
  json["color"] = attributes.color ? figure_json(*attributes.color) : Json(nullptr);
  json["look"] = attributes.look ? figure_json(*attributes.look) : Json(nullptr);
  json["samples"] = attributes.samples;
  json["notes"] = attributes.notes;
  return json;
}

Json shape_json(const measure::Shape& shape) {
  const Topology& t = shape.topology;
  Json json{{"triangles", t.triangles},
            {"vertices", t.vertices},
            {"components", t.components},
            {"closed", t.closed},
            {"manifold", t.manifold},
            {"boundary_edges", t.boundary_edges},
            {"nonmanifold_edges", t.nonmanifold_edges},
            {"area", shape.area},
            {"volume", shape.volume},
            {"genus", nullptr}};
  if (shape.genus) json["genus"] = *shape.genus;
  return json;
}

std::string to_json(const MeasureReport& report) {
  const measure::Distance& d = report.distance;
  Json json;
  json["samples"] = d.samples;
  json["max"] = d.sampled_max;
  json["mean"] = d.mean;
  json["rms"] = d.rms;
  json["relative_max"] = d.relative(d.sampled_max);
  json["found_max"] = d.max;
  json["relative_found_max"] = d.relative(d.max);
  json["bound"] = d.bound;
  json["relative_bound"] = d.relative(d.bound);
  json["is_bounded"] = d.is_bounded;
  json["relative_mean"] = d.relative(d.mean);
  json["relative_rms"] = d.relative(d.rms);
  json["forward"] = directed_json(d.forward);
  json["backward"] = directed_json(d.backward);
  json["normal_degrees"] = d.normal_degrees;
  json["diagonal"] = d.diagonal;
  json["unit"] = unit_or_null(report.unit);
  json["shape"] = {{"a", shape_json(report.shape_a)}, {"b", shape_json(report.shape_b)}};
  if (report.image) json["image"] = image_json(*report.image);
  if (report.attributes) json["attributes"] = attributes_json(*report.attributes);
  if (report.heat) {
    json["heat"] = {{"file", report.heat->file},
                    {"range", report.heat->range},
                    {"largest", report.heat->largest},
                    {"triangles", report.heat->triangles}};
  }
  json["seconds"] = report.seconds;
  return text_of(json);
}

std::string to_json(const InfoReport& report) {
  const Topology& t = report.topology;
  Json json;
  json["path"] = report.path;
  json["vertices"] = t.vertices;
  json["wedges"] = t.wedges;
  json["triangles"] = t.triangles;
  json["file_vertices"] = report.file_vertices;
  json["file_triangles"] = report.file_triangles;
  json["components"] = t.components;
  json["edges"] = t.edges;
  json["boundary_edges"] = t.boundary_edges;
  json["nonmanifold_edges"] = t.nonmanifold_edges;
  json["nonmanifold_vertices"] = t.nonmanifold_vertices;
  json["inconsistent_edges"] = t.inconsistent_edges;
  json["duplicate_faces"] = t.duplicate_faces;
  json["degenerate_triangles"] = t.degenerate_triangles;
  json["closed"] = t.closed;
  json["manifold"] = t.manifold;
  json["diagonal"] = report.diagonal;
  json["area"] = report.area;
  json["volume"] = report.volume;
  json["bounds"] = {{"min", report.min}, {"max", report.max}};
  json["unit"] = unit_or_null(report.unit);
  json["meshes"] = report.meshes;
  json["instances"] = report.instances;
  json["levels"] = report.levels;
  json["attributes"] = Json::array();
  for (const AttributeReport& a : report.attributes) {
    json["attributes"].push_back({{"name", a.name},
                                  {"semantic", a.semantic},
                                  {"type", a.type},
                                  {"components", a.components},
                                  {"normalized", a.normalized}});
  }
  json["materials"] = report.materials;
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

std::string to_json(const RenderReport& report) {
  Json json;
  json["input"] = {{"path", report.input}, {"triangles", report.triangles}};
  json["level"] = report.level;
  json["file"] = report.file;
  json["bytes"] = report.bytes;
  json["width"] = report.width;
  json["height"] = report.height;
  json["shading"] = report.shading;
  json["camera"] = {{"eye", report.eye}, {"forward", report.forward}, {"up", report.up}};
  json["heat_range"] = report.heat_range ? Json(*report.heat_range) : Json(nullptr);
  json["seconds"] = {{"read", report.read_seconds},
                     {"prepare", report.prepare_seconds},
                     {"draw", report.draw_seconds},
                     {"write", report.write_seconds}};
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

std::string to_json(const SheetReport& report) {
  Json json;
  json["levels"] = Json::array();
  for (const SheetReport::Level& level : report.levels) {
    json["levels"].push_back({{"input", level.input},
                              {"level", level.level},
                              {"triangles", level.triangles},
                              {"error", level.error},
                              {"switch_distance", level.switch_distance}});
  }
  json["unit"] = unit_or_null(report.unit);
  json["file"] = report.file;
  json["bytes"] = report.bytes;
  json["width"] = report.width;
  json["height"] = report.height;
  json["shading"] = report.shading;
  json["seconds"] = report.seconds;
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

std::string to_json(const VoxelReport& report) {
  Json json;
  json["input"] = {{"path", report.input}, {"triangles", report.triangles_in}};
  json["resolution"] = report.resolution;
  json["voxels_inside"] = report.voxels_inside;
  if (report.level_resolution > 0) {
    json["method"] = report.method;
    json["surface_resolution"] = report.level_resolution;
  }
  json["fill"] = report.fill;
  json["fill_reason"] = report.fill_reason;
  json["triangles"] = report.triangles;
  json["relative_error"] = nullptr;
  if (report.error) {
    add_error(json, *report.error);
    json["diagonal"] = report.error->diagonal;
  }
  json["unit"] = unit_or_null(report.unit);
  json["file"] = report.output;
  json["bytes"] = report.bytes;
  json["seconds"] = {{"read", report.read_seconds},
                     {"prepare", report.prepare_seconds},
                     {"voxelize", report.voxelize_seconds},
                     {"resample", report.resample_seconds},
                     {"isosurface", report.isosurface_seconds},
                     {"collapse", report.collapse_seconds},
                     {"measure", report.measure_seconds},
                     {"write", report.write_seconds},
                     {"total", report.total_seconds}};
  json["peak_memory_bytes"] = report.peak_memory_bytes;
  json["shortfall"] = report.shortfall.empty() ? Json(nullptr) : Json(with_options(report.shortfall));
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

std::string to_json(const ConvertReport& report) {
  Json json;
  json["input"] = {{"path", report.input}, {"triangles", report.triangles}};
  json["files"] = report.files;
  if (!report.file_triangles.empty()) json["file_triangles"] = report.file_triangles;
  json["bytes"] = report.bytes;
  json["seconds"] = {{"read", report.read_seconds}, {"write", report.write_seconds}};
  json["warnings"] = with_options(report.warnings);
  return text_of(json);
}

std::string to_json(const SampleReport& report) {
  Json json;
  json["sample"] = report.sample;
  json["triangles"] = report.triangles;
  json["vertices"] = report.vertices;
  json["instances"] = report.instances;
  if (report.voxels > 0) json["voxels"] = report.voxels;
  if (report.points > 0) json["points"] = report.points;
  json["file"] = report.file;
  json["bytes"] = report.bytes;
  json["seconds"] = report.seconds;
  return text_of(json);
}

}  // namespace lodestone::app
