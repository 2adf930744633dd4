#include "lodestone/io/volumes/plain_numbers_detail.h"

namespace lodestone::io::detail {

PlainNumbers::PlainNumbers() {
  of_c_ = ::newlocale(LC_NUMERIC_MASK, "C", ::duplocale(::uselocale(nullptr)));
  if (of_c_ != nullptr) before_ = ::uselocale(of_c_);
  const std::locale now;
  if (std::use_facet<std::numpunct<char>>(now).decimal_point() == '.') return;
  streams_before_ = now;
  std::locale::global(std::locale(now, new std::numpunct<char>));  // has no name, so that of C stays
}

PlainNumbers::~PlainNumbers() {
  if (streams_before_) {
    // A locale with a name sets that of C with it, which may be another by now.
    const std::string of_c = std::setlocale(LC_ALL, nullptr);
    std::locale::global(*streams_before_);
    std::setlocale(LC_ALL, of_c.c_str());
  }
  if (of_c_ == nullptr) return;
  ::uselocale(before_);
  ::freelocale(of_c_);
}

}  // namespace lodestone::io::detail
