#include "app/output/measure_table.h"

#include <fmt/format.h>

#include "app/output/table.h"
#include "app/output/text.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

std::string table_of(const measure::Attributes& attributes) {
  Table table;
  table.add_column("attribute", Table::Align::left);
  for (const char* title : {"mean", "rms", "median", "95 %", "max", "compared"}) table.add_column(title);
  const auto row = [&](const std::string& name, const measure::Deviation& d) {
    table.add_row({name, short_number(d.mean), short_number(d.rms), short_number(d.median),
                   short_number(d.percentile_95), short_number(d.max), percent(d.share)});
  };
  row("normals (deg)", attributes.normal.both);
  for (const measure::UvFigure& uv : attributes.uv) {
    const measure::Deviation& d = uv.distance.both;
    row(fmt::format("UV set {}", uv.set), d);
    table.add_row({"  of its diagonal", percent(uv.relative(d.mean)), percent(uv.relative(d.rms)),
                   percent(uv.relative(d.median)), percent(uv.relative(d.percentile_95)), percent(uv.relative(d.max)),
                   ""});
  }
  if (attributes.color) row("vertex colours", attributes.color->both);
  if (attributes.look) row("colours as shown", attributes.look->both);
  std::string text = "\n" + table.text();
  for (const std::string& note : attributes.notes) text += fmt::format("\n{}\n", printable(note));
  return text;
}

std::string shape_table(const MeasureReport& report) {
  Table table;
  table.add_column("shape", Table::Align::left);
  for (const char* title : {"triangles", "pieces", "closed", "manifold", "genus", "open edges"})
    table.add_column(title);
  const std::string& unit = report.unit;
  table.add_column(unit.empty() ? "area" : "area (" + unit + "^2)");
  table.add_column(unit.empty() ? "volume" : "volume (" + unit + "^3)");
  const auto row = [&](const char* name, const measure::Shape& shape) {
    const Topology& t = shape.topology;
    table.add_row({name, with_separators(t.triangles), with_separators(t.components), t.closed ? "yes" : "no",
                   t.manifold ? "yes" : "no", shape.genus ? fmt::format("{}", *shape.genus) : "-",
                   with_separators(t.boundary_edges), short_number(shape.area),
                   t.closed ? short_number(shape.volume) : "-"});
  };
  row("A", report.shape_a);
  row("B", report.shape_b);
  const auto kept = [](double a, double b) { return a != 0 ? percent(b / a) : std::string("-"); };
  const bool closed = report.shape_a.topology.closed && report.shape_b.topology.closed;
  table.add_row({"B of A",
                 kept(static_cast<double>(report.shape_a.topology.triangles),
                      static_cast<double>(report.shape_b.topology.triangles)),
                 "", "", "", "", "", kept(report.shape_a.area, report.shape_b.area),
                 closed ? kept(report.shape_a.volume, report.shape_b.volume) : "-"});
  return "\n" + table.text();
}

std::string table_of(const measure::ImageDeviation& image) {
  Table table;
  table.add_column("pictures", Table::Align::left);
  for (const char* title : {"silhouette, mean", "worst", "farthest", "PSNR", "SSIM"}) table.add_column(title);
  const auto row = [&](const char* name, bool first, double psnr, double ssim) {
    table.add_row({name, first ? percent(image.silhouette_mean) : "", first ? percent(image.silhouette_max) : "",
                   first ? fmt::format("{:.1f} px", image.screen_max_px) : "", fmt::format("{:.1f} dB", psnr),
                   fmt::format("{:.4f}", ssim)});
  };
  row("shading", true, image.shading_psnr, image.shading_ssim);
  if (image.has_color) row("colours", false, image.color_psnr, image.color_ssim);
  return fmt::format("\n{}\n{} views, {} x {} pixels\n", table.text(), image.views, image.size_px, image.size_px);
}

std::string line_of(const HeatReport& heat, const std::string& unit) {
  const std::string units = unit.empty() ? "" : " " + unit;
  return fmt::format("\n{}: A by its distance to B, colours from 0 to {}{}, farthest vertex {}{}, {} triangles\n",
                     printable(heat.file), short_number(heat.range), units, short_number(heat.largest), units,
                     with_separators(heat.triangles));
}

}  // namespace

std::string table_of(const MeasureReport& report) {
  const measure::Distance& d = report.distance;
  Table table;
  table.add_column(report.unit.empty() ? "distance" : "distance (" + report.unit + ")", Table::Align::left);
  for (const char* title : {"max", "found", "at most", "mean", "median", "95 %", "rms", "normals"})
    table.add_column(title);
  const auto degrees = [](double value) { return fmt::format("{:.2f} deg", value); };
  const auto row = [&](const char* name, const measure::DirectedDistance& one) {
    table.add_row({name, short_number(one.sampled_max), short_number(one.max), short_number(one.bound),
                   short_number(one.mean), short_number(one.median), short_number(one.percentile_95),
                   short_number(one.rms), degrees(one.normal_degrees)});
  };
  row("A to B", d.forward);
  row("B to A", d.backward);
  table.add_row({"both", short_number(d.sampled_max), short_number(d.max), short_number(d.bound), short_number(d.mean),
                 "", "", short_number(d.rms), degrees(d.normal_degrees)});
  table.add_row({"of the diagonal", percent(d.relative(d.sampled_max)), percent(d.relative(d.max)),
                 percent(d.relative(d.bound)), percent(d.relative(d.mean)), "", "", percent(d.relative(d.rms)), ""});
  const std::string attributes = report.attributes ? table_of(*report.attributes) : "";
  const std::string image = report.image ? table_of(*report.image) : "";
  const std::string heat = report.heat ? line_of(*report.heat, report.unit) : "";
  const char* legend =
      "max: the largest of samples and vertices; found: the largest of all points looked at;\n"
      "at most: a certified bound, no point is farther away\n";
  return table.text() + legend + shape_table(report) + attributes + image + heat +
         fmt::format("\n{} samples a direction, diagonal of A {}, {} s\n", with_separators(d.samples),
                     short_number(d.diagonal), seconds_text(report.seconds));
}

}  // namespace lodestone::app
