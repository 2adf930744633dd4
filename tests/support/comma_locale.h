// The numbers of a German program around us, as a test: "0,5" for a half.
#pragma once

#include <locale>
#include <string>

namespace lodestone::test {

/// While it lives, streams of C++ and, where the system can make such a locale (localedef), functions of C expect and
/// write a decimal comma.
class CommaLocale {
 public:
  CommaLocale();
  ~CommaLocale();
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  /// False where functions of C keep the point.
  bool of_c() const { return of_c_; }

 private:
  std::locale before_;
  std::string c_before_;
  bool of_c_ = false;
};

}  // namespace lodestone::test
