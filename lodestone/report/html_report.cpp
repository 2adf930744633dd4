// The page about a ladder: one HTML document that needs nothing else.
//
// 1. TableMaker: a table that scrolls by itself where it is too wide, also by keyboard.
// 2. summary(), level_table(), shape_table(): what was made, its errors, and the shape of each level.
// 3. shot(), legend(), pictures(): pictures embedded as data, with the colours of the heat maps explained once.
// 4. options_table(), meaning(): options given and defaults; what each figure means.
// 5. html_report(): the sections in order. Plots come from report_plots.cpp, warnings from plain_warnings.cpp.
// Invariants: no script and no network, which the page's Content-Security-Policy enforces. Text from outside is
// escaped. Nothing about time or machine: the same data give the same page. docs/report.md shows what is on it.
#include "lodestone/report/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "lodestone/base/base64.h"
#include "lodestone/base/units.h"
#include "lodestone/render/color_map.h"
#include "lodestone/report/html_text.h"
#include "lodestone/report/page_style_detail.h"
#include "lodestone/report/report_plots_detail.h"

namespace lodestone::report {

namespace {

std::string length(const ReportData& data, double value) {
  return short_number(value) + (data.unit.empty() ? "" : " " + escaped(data.unit));
}

// A table in a box of its own that scrolls where it is too wide, also by keyboard.
class TableMaker {
 public:
  TableMaker(const std::string& label, const std::vector<std::string>& titles) {
    html_ =
        fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table><thead><tr>", label);
    for (const std::string& title : titles) html_ += "<th scope=\"col\">" + title + "</th>";
    html_ += "</tr></thead><tbody>\n";
  }
  void add_row(const std::vector<std::string>& cells) {
    html_ += "<tr><th scope=\"row\">" + cells.front() + "</th>";
    for (std::size_t i = 1; i < cells.size(); ++i) html_ += "<td>" + cells[i] + "</td>";
    html_ += "</tr>\n";
  }
  std::string html() const { return html_ + "</tbody></table></div>\n"; }

 private:
  std::string html_;
};

bool has_image_figures(const ReportData& data) {
  return std::any_of(data.levels.begin(), data.levels.end(), [](const ReportLevel& l) { return l.image.has_value(); });
}

std::string summary(const ReportData& data) {
  if (data.levels.size() < 2) {
    return fmt::format("No level could be made from its {} triangles.", with_separators(data.levels.front().triangles));
  }
  const ReportLevel &first = data.levels.front(), &last = data.levels.back();
  const bool certain = last.error.kind == ErrorKind::bounded;
  return fmt::format(
      "{} levels, from {} triangles down to {}. {} the coarsest is nowhere farther than <strong>{}</strong> from the "
      "original: {} of its diagonal.",
      data.levels.size(), with_separators(first.triangles), with_separators(last.triangles),
      certain ? "Certified:" : "As far as was found,",
      length(data, last.error.error) + (data.unit.empty() ? " model units" : ""),
      percent(last.error.relative(last.error.error)));
}

std::string level_table(const ReportData& data) {
  std::vector<std::string> titles{"level",
                                  "triangles",
                                  "share",
                                  escaped(with_unit("error", data.unit)),
                                  "relative",
                                  "kind",
                                  escaped(with_unit("mean", data.unit)),
                                  escaped(with_unit("rms", data.unit)),
                                  escaped(with_unit("1 px from", data.unit))};
  const bool pictures = has_image_figures(data);
  if (pictures) titles.insert(titles.end(), {"silhouette", "PSNR", "SSIM"});
  titles.push_back("bytes");
  const bool files = std::any_of(data.levels.begin(), data.levels.end(),
                                 [&](const auto& l) { return l.file != data.levels.front().file; });
  if (files) titles.push_back("file");
  TableMaker table("Levels", titles);
  for (std::size_t i = 0; i < data.levels.size(); ++i) {
    const ReportLevel& level = data.levels[i];
    const LevelError& e = level.error;
    const double share = static_cast<double>(level.triangles) /
                         static_cast<double>(std::max<std::size_t>(1, data.levels.front().triangles));
    std::vector<std::string> row{std::to_string(i),
                                 with_separators(level.triangles),
                                 percent(share),
                                 short_number(e.error),
                                 percent(e.relative(e.error)),
                                 i == 0                         ? "original"
                                 : e.kind == ErrorKind::bounded ? "certified"
                                                                : "found",
                                 short_number(e.mean_error),
                                 short_number(e.rms_error),
                                 short_number(measure::switch_distance(e.error, 1, data.view))};
    if (pictures) {
      const measure::ImageDeviation image = level.image.value_or(measure::ImageDeviation{});
      row.push_back(percent(image.silhouette_mean));
      row.push_back(fmt::format("{:.1f} dB", image.worse_psnr()));
      row.push_back(fmt::format("{:.4f}", image.worse_ssim()));
    }
    row.push_back(human_bytes(level.bytes));
    if (files) row.push_back(escaped(level.file));
    table.add_row(row);
  }
  return table.html();
}

std::string shape_table(const ReportData& data) {
  TableMaker table("Shape of the levels",
                   {"level", "pieces", "open edges", "closed", "manifold", "genus",
                    data.unit.empty() ? "area" : fmt::format("area ({}²)", escaped(data.unit)), "of the original",
                    data.unit.empty() ? "volume" : fmt::format("volume ({}³)", escaped(data.unit)), "of the original"});
  const measure::Shape& first = data.levels.front().shape;
  for (std::size_t i = 0; i < data.levels.size(); ++i) {
    const measure::Shape& s = data.levels[i].shape;
    const Topology& t = s.topology;
    const bool volumes = t.closed && first.topology.closed && first.volume != 0;
    table.add_row({std::to_string(i), with_separators(t.components), with_separators(t.boundary_edges),
                   t.closed ? "yes" : "no", t.manifold ? "yes" : "no", s.genus ? std::to_string(*s.genus) : "–",
                   short_number(s.area), first.area > 0 ? fmt::format("{:.5g} %", s.area / first.area * 100) : "–",
                   t.closed ? short_number(s.volume) : "–",
                   volumes ? fmt::format("{:.5g} %", s.volume / first.volume * 100) : "–"});
  }
  return table.html();
}

std::string shot(const std::string& webp, const std::string& what, const std::string& caption) {
  return fmt::format(
      "<figure><label class=\"zoom\"><input type=\"checkbox\" aria-label=\"Enlarge: {0}\">"
      "<img alt=\"{0}\" width=\"640\" height=\"480\" src=\"data:image/webp;base64,{1}\"></label>"
      "<figcaption>{2}</figcaption></figure>\n",
      what, encode_base64(webp), caption);
}

// The colours of heat; how far they go differs from level to level.
std::string legend() {
  std::string stops;
  constexpr int kStops = 10;
  for (int i = 0; i < kStops; ++i) {
    const Vec3f c = render::heat_color(static_cast<float>(i) / (kStops - 1));
    const auto byte = [](float x) { return static_cast<int>(x * 255 + 0.5F); };
    stops += fmt::format("{}rgb({},{},{})", i > 0 ? "," : "", byte(c.x), byte(c.y), byte(c.z));
  }
  return fmt::format(
      "<div class=\"legend\"><div>Distance from the original to a level</div>"
      "<div class=\"bar\" style=\"background:linear-gradient(90deg,{})\"></div>"
      "<div class=\"ends\"><span>0</span><span>as told below each picture, or more</span></div></div>\n",
      stops);
}

std::string pictures(const ReportData& data) {
  std::string html = data.pictures.size() > 1 ? legend() : "";
  for (std::size_t i = 0; i < data.pictures.size() && i < data.levels.size(); ++i) {
    const LevelPictures& shots = data.pictures[i];
    const std::string name = i == 0 ? "the original" : fmt::format("level {}", i);
    html += fmt::format("<article class=\"level\"><h3>{}: {} triangles</h3><div class=\"shots\">\n",
                        i == 0 ? "Level 0, the original" : fmt::format("Level {}", i),
                        with_separators(data.levels[i].triangles));
    html += shot(shots.shaded, name + ", shaded", "As a viewer shows it");
    html += shot(shots.wireframe, name + ", with its triangles", "Its triangles");
    if (shots.heat.empty()) {
      html += "<figure><div class=\"none\">The original: no distance to itself</div></figure>\n";
    } else {
      html += shot(shots.heat, "the original, coloured by its distance to " + name,
                   shots.heat_range > 0
                       ? fmt::format("The original by its distance to this level: dark 0, yellow {} or more",
                                     length(data, shots.heat_range))
                       : "No distance to this level but rounding");
    }
    html += "</div></article>\n";
  }
  return html;
}

std::string list(const std::vector<std::string>& items) {
  if (items.empty()) return "<p>None.</p>\n";
  std::string html = "<ul class=\"warnings\">\n";
  for (const std::string& item : items) html += "<li>" + escaped(item) + "</li>\n";
  return html + "</ul>\n";
}

std::string options_table(const std::vector<ReportOption>& options, bool given) {
  std::string rows;
  for (const ReportOption& option : options) {
    if (option.given != given) continue;
    rows += fmt::format("<tr><th scope=\"row\" class=\"text\">{}</th><td class=\"text\">{}</td></tr>\n",
                        escaped(option.name), option.value.empty() ? "yes" : escaped(option.value));
  }
  if (rows.empty()) return "<p>None.</p>\n";
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"{}\"><table><tbody>\n{}</tbody></table></div>\n",
      given ? "Options given" : "Defaults", rows);
}

// The fewest samples a direction of all levels: ladders take more where few samples would decide the mean.
std::uint64_t least_samples(const ReportData& data) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 1; i < data.levels.size(); ++i) least = std::min(least, data.levels[i].error.samples);
  return data.levels.size() > 1 ? least : 0;
}

std::string meaning(const ReportData& data) {
  const std::string image =
      has_image_figures(data)
          ? "<dt>silhouette, PSNR, SSIM</dt><dd>Pictures from 20 sides, 512 pixels square, compared with the "
            "original’s: "
            "pixels that only one of the two covers as a share of the original’s, signal-to-noise ratio, structural "
            "similarity (1: the "
            "same). Of shading and colours the worse. They bound nothing.</dd>\n"
          : "";
  return fmt::format(
      "<dl>\n"
      "<dt>error</dt><dd>The largest distance from any point of either surface to the other (Hausdorff distance), "
      "raised to "
      "that of all finer levels. “Certified”: an upper bound, searched over every triangle of both surfaces. “Found”: "
      "the "
      "largest distance that was met; the true one may be larger. It says nothing about normals, textures or "
      "colours.</dd>\n"
      "<dt>relative</dt><dd>The error divided by the diagonal of the original’s bounding box, {}.</dd>\n"
      "<dt>mean, rms</dt><dd>Over at least {} points spread evenly over each surface; both directions count alike. "
      "They bound "
      "nothing.</dd>\n"
      "<dt>1 px from</dt><dd>From this distance on (to the surface of the sphere around the model) the error covers at "
      "most "
      "one pixel on a screen of {} lines with a vertical field of view of {} degrees. Switch to the level there.</dd>\n"
      "{}"
      "<dt>heat map</dt><dd>The original’s surface, coloured by the distance to the level: one direction alone, and "
      "only as "
      "fine as the picture. 99 % of the area is nearer than what yellow stands for, but where few places are far "
      "off.</dd>\n"
      "</dl>\n",
      length(data, data.diagonal), with_separators(least_samples(data)), short_number(data.view.height_px),
      short_number(data.view.fov_degrees), image);
}

std::string section(const char* id, const char* title, const std::string& content) {
  return fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-title\"><h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n",
                     id, title, content);
}

}  // namespace

std::string html_report(const ReportData& data) {
  const std::string name = escaped(data.name);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\">\n";
  page += fmt::format("<title>{}: levels of detail</title>\n<style>{}</style>\n</head>\n<body>\n", name,
                      detail::kPageStyle);
  page += fmt::format(
      "<a class=\"skip\" href=\"#levels\">Skip to the levels</a>\n<header class=\"wide\"><p class=\"brand\">Levels of "
      "detail, measured by Lodestone {}</p>\n<h1><bdi>{}</bdi></h1>\n<p class=\"lead\">{}</p>\n",
      escaped(data.version), name, summary(data));
  page += "<nav aria-label=\"On this page\"><ul>";
  for (const auto& [id, title] : {std::pair{"levels", "Levels"},
                                  {"pictures", "Pictures"},
                                  {"curves", "Curves"},
                                  {"shape", "Shape"},
                                  {"warnings", "Warnings"},
                                  {"options", "Options"},
                                  {"meaning", "What it means"}}) {
    page += fmt::format("<li><a href=\"#{}\">{}</a></li>", id, title);
  }
  page += "</ul></nav></header>\n<main class=\"wide\">\n";
  page += section("levels", "Levels", level_table(data));
  page += section("pictures", "Pictures", pictures(data));
  page += section("curves", "Curves", detail::plots(data));
  page += section("shape", "Shape", shape_table(data));
  std::vector<std::string> warnings = data.shortfalls;
  for (std::string& warning : plain_warnings(data)) warnings.push_back(std::move(warning));
  page += section("warnings", "Warnings", list(warnings));
  page += section(
      "options", "Options",
      options_table(data.options, true) + "<h3 class=\"more\">Defaults</h3>\n" + options_table(data.options, false));
  page += section("meaning", "What it means", meaning(data));
  page +=
      "</main>\n<footer class=\"wide\">Made by lod build --report. Nothing on this page was loaded from "
      "elsewhere.</footer>\n";
  return page + "</body>\n</html>\n";
}

}  // namespace lodestone::report
