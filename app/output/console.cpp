#include "app/output/console.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/output/setting_names.h"
#include "app/output/text.h"

namespace lodestone::app {

Console::Console(Talk talk, int threads)
    : talk_(talk),
      progress_(talk == Talk::quiet ? Terminal::none : error_terminal()),
      task_(Task::root(progress_.callback(), threads)) {}

void Console::say(std::string_view line) const {
  progress_.clear();
  fmt::print(stderr, "{}\n", line);
}

void Console::note(std::string_view text) const {
  if (talk_ != Talk::quiet) say("lod: " + printable(with_options(text)));
}

void Console::detail(std::string_view text) const {
  if (talk_ == Talk::verbose) say("lod: " + printable(with_options(text)));
}

void Console::error(const Error& error) const { say(error_text(error)); }

Error Console::stopped() const {
  const std::string at_work = progress_.at_work();
  std::string what = at_work.empty() ? "interrupted" : fmt::format("interrupted while {}", at_work);
  return Error{ErrorCode::cancelled, std::move(what), {}, "nothing half done is left"};
}

void Console::shortfall(std::string_view text) const { say("lod: " + printable(with_options(text))); }

void Console::result(std::string_view text) const {
  progress_.clear();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void Console::table(std::string_view text) const {
  if (talk_ != Talk::quiet) result(text);
}

void Console::wrote(const std::string& file) {
  if (written_.empty() || written_.back() != file) written_.push_back(file);
}

Result<void> Console::finish() const {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
  std::string what = "the result could not be written";
  if (written_.size() == 1) what = fmt::format("{} was written; its report could not be", written_.front());
  if (written_.size() > 1) {
    what = fmt::format("{} and {} more were written; their report could not be", written_.front(), written_.size() - 1);
  }
  return fail(ErrorCode::cannot_write, what, "standard output", "is standard output closed, or its disk full?");
}

}  // namespace lodestone::app
