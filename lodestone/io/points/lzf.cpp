#include <cstring>

#include "lodestone/io/points/read_detail.h"

namespace lodestone::io {

// Runs of up to 32 plain bytes, and copies of 3 to 264 bytes from at most 8 KiB before.
bool unpack_lzf(std::span<const char> packed, std::span<char> into) {
  std::size_t from = 0, to = 0;
  const auto next = [&]() { return static_cast<std::size_t>(static_cast<unsigned char>(packed[from++])); };
  while (from < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > packed.size() - from || run > into.size() - to) return false;
      std::memcpy(into.data() + to, packed.data() + from, run);
      from += run;
      to += run;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (from == packed.size()) return false;
      length += next();
    }
    length += 2;
    if (from == packed.size()) return false;
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    if (back > to || length > into.size() - to) return false;
    for (std::size_t i = 0; i < length; ++i, ++to) into[to] = into[to - back];  // may overlap
  }
  return to == into.size();
}

}  // namespace lodestone::io
