#include "lodestone/base/result.h"

namespace lodestone {

std::string Error::line() const {
  std::string out = where.empty() ? what : where + ": " + what;
  if (!remedy.empty()) out += "; " + remedy;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return out;
}

}  // namespace lodestone
