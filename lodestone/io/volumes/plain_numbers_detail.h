// Numbers with a decimal point for libraries that follow the locale, in programs that don't have one.
#pragma once

#include <clocale>
#include <locale>
#include <optional>
#include <string>

namespace lodestone::io::detail {

/// While it lives, functions of C in this thread and new streams of C++ read and write "0.5", whatever the program that
/// we are part of has set. That setting is back afterwards; only a program whose *C++* locale has another point sees
/// a change in its other threads meanwhile, as that locale is one for all of them.
class PlainNumbers {
 public:
  PlainNumbers();
  ~PlainNumbers();
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  locale_t of_c_ = nullptr;
  locale_t before_ = nullptr;
  std::optional<std::locale> streams_before_;
};

}  // namespace lodestone::io::detail
