#include "app/children/child_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>

namespace lodestone::app {

void say(std::string_view key, std::string_view value) {
  std::string line = fmt::format("{} {}", key, value);
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  line += '\n';
  for (std::string_view rest = line; !rest.empty();) {
    const ssize_t wrote = ::write(kReportDescriptor, rest.data(), rest.size());
    if (wrote <= 0) std::_Exit(1);
    rest.remove_prefix(static_cast<std::size_t>(wrote));
  }
}

void say_done() { say("done"); }

void say_failed(const Error& error) {
  say("code", fmt::format("{}", static_cast<int>(error.code)));
  say("what", error.what);
  say("where", error.where);
  say("remedy", error.remedy);
  say("failed");
}

std::string ChildReport::value(std::string_view key) const {
  for (const auto& [name, text] : lines) {
    if (name == key) return text;
  }
  return {};
}

std::vector<std::string> ChildReport::values(std::string_view key) const {
  std::vector<std::string> out;
  for (const auto& [name, text] : lines) {
    if (name == key) out.push_back(text);
  }
  return out;
}

std::vector<double> ChildReport::numbers(std::string_view key) const {
  const std::string text = value(key);
  std::vector<double> out;
  const char* end = text.data() + text.size();
  for (const char* at = text.data(); at < end; ++at) {
    double number = 0;
    const auto [stop, problem] = std::from_chars(at, end, number);
    if (problem != std::errc{}) break;
    out.push_back(number);
    at = stop;
  }
  return out;
}

double ChildReport::number(std::string_view key) const {
  const std::vector<double> all = numbers(key);
  return all.empty() ? 0 : all.front();
}

ChildReport parse_child_report(std::string_view text) {
  ChildReport report;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t space = std::min(line.find(' '), line.size());
    report.lines.emplace_back(line.substr(0, space), line.substr(std::min(space + 1, line.size())));
    report.done = report.done || line.substr(0, space) == "done";
    report.failed = report.failed || line.substr(0, space) == "failed";
  }
  report.error = Error{static_cast<ErrorCode>(static_cast<int>(report.number("code"))), report.value("what"),
                       report.value("where"), report.value("remedy")};
  return report;
}

}  // namespace lodestone::app
