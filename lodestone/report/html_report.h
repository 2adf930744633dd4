// The report of a ladder: one page that says what was made and how far it can be trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/core/level.h"
#include "lodestone/measure/image.h"
#include "lodestone/measure/screen.h"
#include "lodestone/measure/shape.h"
#include "lodestone/report/level_pictures.h"

namespace lodestone::report {

struct ReportLevel {
  std::size_t triangles = 0;
  LevelError error;
  measure::Shape shape;
  std::optional<measure::ImageDeviation> image;
  std::uint64_t bytes = 0;
  std::string file;
};

struct ReportOption {
  std::string name, value;
  bool given = false;  ///< false: by default
};

/// All that stands on the page. Nothing about time or machine: the same ladder, the same page.
struct ReportData {
  std::string name;  ///< of the model
  std::string unit;  ///< of lengths; empty: not known
  double diagonal = 0;
  measure::View view;
  std::vector<ReportLevel> levels;      ///< [0] is the original
  std::vector<LevelPictures> pictures;  ///< one a level, or none
  std::vector<ReportOption> options;
  std::vector<std::string> warnings;    ///< about the model, in plain words
  std::vector<std::string> shortfalls;  ///< targets that were missed, with their reasons
  std::uint64_t seam_vertices = 0;      ///< of the original: with different attributes on different sides
  std::string version;
};

/// A whole HTML document that needs nothing else: no script, no network. Text from outside is escaped.
std::string html_report(const ReportData& data);

/// What a user should know about the original and its levels, in plain words: open edges, defects, seams, lost pieces,
/// errors that are not certified; then `data.warnings`.
std::vector<std::string> plain_warnings(const ReportData& data);

}  // namespace lodestone::report
