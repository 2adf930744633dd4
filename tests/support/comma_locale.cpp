#include "support/comma_locale.h"

#include <unistd.h>

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace lodestone::test {
namespace {

namespace fs = std::filesystem;

struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

// Few systems have German installed, so one with nothing but its numbers is made. False without localedef.
bool make_c_locale() {
  const fs::path folder = fs::temp_directory_path() / ("lodestone-locale-" + std::to_string(::getpid()));
  std::error_code error;
  fs::create_directories(folder, error);
  std::ofstream(folder / "comma.src") << "comment_char %\nescape_char /\nLC_NUMERIC\ndecimal_point \",\"\n"
                                         "thousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n";
  const std::string command = "localedef -c -i '" + (folder / "comma.src").string() + "' -f UTF-8 '" +
                              (folder / "comma.utf8").string() + "' >/dev/null 2>&1";
  const int status = std::system(command.c_str());
  static_cast<void>(status);  // it warns of all that the locale lacks
  ::setenv("LOCPATH", folder.c_str(), 1);
  const bool set = std::setlocale(LC_NUMERIC, "comma.utf8") != nullptr;
  ::unsetenv("LOCPATH");
  fs::remove_all(folder, error);
  return set;
}

}  // namespace

CommaLocale::CommaLocale() : c_before_(std::setlocale(LC_NUMERIC, nullptr)) {
  before_ = std::locale::global(std::locale(std::locale::classic(), new Comma));
  of_c_ = make_c_locale() && std::localeconv()->decimal_point == std::string(",");
}

CommaLocale::~CommaLocale() {
  std::locale::global(before_);
  std::setlocale(LC_NUMERIC, c_before_.c_str());
}

}  // namespace lodestone::test
