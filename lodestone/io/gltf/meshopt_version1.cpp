// What KHR_meshopt_compression added to EXT_meshopt_compression, by its specification: version 1 of the attribute codec
// and the filter COLOR. And the rules that hold for both.
//
// A stream is a header byte, blocks of up to 256 elements, and a tail. A block holds, for each byte of an element, the
// deltas of all its elements in groups of 16. Each group says how many bits a delta takes; the largest value of that
// many bits says that the delta follows as a whole byte. The tail holds the element before the first one, and for each
// four bytes of an element how deltas become values: byte by byte, as 16 bits, or as 32 bits XORed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "lodestone/io/gltf/meshopt_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kBlockBytes = 8192, kBlockElements = 256, kGroup = 16, kLeastTail = 24;

// A block of 256 elements takes at least a byte for four of its byte columns (version 1), a triangle at least one byte
// for its 12: nothing unfolds to more than this many times its size.
constexpr std::size_t kMaxRatio = 4 * kBlockElements;

using Bytes = std::span<const unsigned char>;

// The first `n` bytes, taken off the front; empty and `good` false if they are not there.
Bytes take(Bytes& from, std::size_t n, bool& good) {
  if (n > from.size()) {
    good = false;
    return {};
  }
  const Bytes out = from.first(n);
  from = from.subspan(n);
  return out;
}

// Sixteen deltas of `bits` bits each.
void read_group(Bytes& from, unsigned bits, unsigned char* out, bool& good) {
  if (bits == 0) {
    std::fill_n(out, kGroup, static_cast<unsigned char>(0));
    return;
  }
  const Bytes packed = take(from, kGroup * bits / 8, good);
  if (!good) return;
  if (bits == 8) {
    std::copy(packed.begin(), packed.end(), out);
    return;
  }
  const unsigned whole = (1U << bits) - 1;  // the delta is a byte of its own
  const std::size_t each = 8 / bits;
  for (std::size_t i = 0; i < kGroup && good; ++i) {
    const auto place = static_cast<unsigned>(i % each);
    const unsigned shift = bits == 1 ? place : 8 - bits * (place + 1);  // single bits run upwards, others downwards
    const unsigned code = packed[i / each] >> shift & whole;
    if (code != whole) {
      out[i] = static_cast<unsigned char>(code);
      continue;
    }
    const Bytes byte = take(from, 1, good);
    if (good) out[i] = byte[0];
  }
}

// The deltas of one byte of all `count` elements of a block; `out` has room for whole groups.
void read_column(Bytes& from, unsigned control, std::size_t count, unsigned char* out, bool& good) {
  const std::size_t groups = (count + kGroup - 1) / kGroup;
  if (control == 2) {
    std::fill_n(out, count, static_cast<unsigned char>(0));
    return;
  }
  if (control == 3) {
    const Bytes plain = take(from, count, good);
    std::copy(plain.begin(), plain.end(), out);
    return;
  }
  constexpr std::array<std::array<unsigned, 4>, 2> kBits{{{0, 1, 2, 4}, {1, 2, 4, 8}}};
  const Bytes header = take(from, (groups + 3) / 4, good);
  for (std::size_t g = 0; g < groups && good; ++g) {
    read_group(from, kBits[control][header[g / 4] >> g % 4 * 2 & 3], out + g * kGroup, good);
  }
}

template <class T>
T unfold_sign(T v) {
  return static_cast<T>((v & 1) != 0 ? ~(v >> 1) : v >> 1);
}

// Four bytes of an element from their deltas and the element before.
std::uint32_t next_value(std::uint32_t before, std::uint32_t delta, unsigned mode) {
  if ((mode & 15) == 2) return before ^ std::rotr(delta, static_cast<int>(mode >> 4));
  std::uint32_t out = 0;
  const unsigned step = mode == 0 ? 8 : 16;
  for (unsigned at = 0; at < 32; at += step) {
    if (step == 8) {
      const auto sum = static_cast<std::uint8_t>((before >> at) + unfold_sign(static_cast<std::uint8_t>(delta >> at)));
      out |= static_cast<std::uint32_t>(sum) << at;
    } else {
      const auto sum =
          static_cast<std::uint16_t>((before >> at) + unfold_sign(static_cast<std::uint16_t>(delta >> at)));
      out |= static_cast<std::uint32_t>(sum) << at;
    }
  }
  return out;
}

std::uint32_t load_little(const unsigned char* at) {
  return at[0] | static_cast<std::uint32_t>(at[1]) << 8 | static_cast<std::uint32_t>(at[2]) << 16 |
         static_cast<std::uint32_t>(at[3]) << 24;
}

// A block's elements to `out`; `last` is the element before, four bytes a word.
void read_block(Bytes& from, Bytes modes, std::size_t count, std::vector<std::uint32_t>& last, unsigned char* out,
                bool& good) {
  const std::size_t words = modes.size(), stride = 4 * words;
  const Bytes controls = take(from, words, good);
  std::array<std::array<unsigned char, kBlockElements>, 4> columns{};
  for (std::size_t w = 0; w < words && good; ++w) {
    for (std::size_t k = 0; k < 4 && good; ++k) {
      read_column(from, controls[w] >> 2 * k & 3, count, columns[k].data(), good);
    }
    for (std::size_t i = 0; i < count && good; ++i) {
      const unsigned char delta[4] = {columns[0][i], columns[1][i], columns[2][i], columns[3][i]};
      last[w] = next_value(last[w], load_little(delta), modes[w]);
      for (unsigned k = 0; k < 4; ++k) out[i * stride + 4 * w + k] = static_cast<unsigned char>(last[w] >> 8 * k);
    }
  }
}

template <class T>
void decode_colors(char* elements, std::size_t count) {
  using Signed = std::make_signed_t<T>;
  constexpr int kMost = std::numeric_limits<T>::max();
  for (std::size_t i = 0; i < count; ++i) {
    std::array<T, 4> c;
    std::memcpy(c.data(), elements + i * sizeof c, sizeof c);
    // The highest bit of alpha tells how many bits the channels have.
    const int scale = std::max(1, (1 << std::bit_width(c[3])) - 1);
    const int y = c[0], orange = static_cast<Signed>(c[1]), green = static_cast<Signed>(c[2]);
    const int alpha = c[3] & scale >> 1;
    const int rgba[4] = {y + orange - green, y + green, y - orange - green, alpha << 1 | (alpha & 1)};
    for (std::size_t k = 0; k < 4; ++k) {
      const float value = static_cast<float>(rgba[k]) * (static_cast<float>(kMost) / static_cast<float>(scale));
      c[k] = static_cast<T>(std::clamp(value + 0.5F, 0.0F, static_cast<float>(kMost)));
    }
    std::memcpy(elements + i * sizeof c, c.data(), sizeof c);
  }
}

}  // namespace

bool decode_meshopt_version_1(std::span<const std::byte> compressed, std::size_t count, std::size_t stride, char* out) {
  const std::size_t words = stride / 4, tail = stride + words, padded = std::max(tail, kLeastTail);
  if (compressed.size() < 1 + padded) return false;
  const Bytes all{reinterpret_cast<const unsigned char*>(compressed.data()), compressed.size()};
  const Bytes first = all.last(tail).first(stride), modes = all.last(words);
  for (const unsigned char mode : modes) {
    if ((mode & 15) > 2 || ((mode & 15) < 2 && mode > 15)) return false;
  }
  std::vector<std::uint32_t> last(words);
  for (std::size_t w = 0; w < words; ++w) last[w] = load_little(first.data() + 4 * w);
  Bytes from = all.subspan(1, all.size() - 1 - padded);
  const std::size_t most = std::min(kBlockBytes / stride / kGroup * kGroup, kBlockElements);
  bool good = true;
  for (std::size_t at = 0; at < count && good; at += most) {
    read_block(from, modes, std::min(most, count - at), last, reinterpret_cast<unsigned char*>(out) + at * stride,
               good);
  }
  return good && from.empty();
}

void decode_meshopt_colors(char* elements, std::size_t count, std::size_t stride) {
  if (stride == 4) {
    decode_colors<std::uint8_t>(elements, count);
  } else {
    decode_colors<std::uint16_t>(elements, count);
  }
}

Result<void> check_meshopt(const MeshoptCoding& coding, std::size_t compressed, const std::string& where) {
  const auto [mode, filter, count, stride] = coding;
  const auto bad = [&](std::string what) { return fail(ErrorCode::bad_format, std::move(what), where); };
  const bool attributes = mode == MeshoptMode::attributes;
  if (attributes ? stride == 0 || stride % 4 != 0 || stride > 256 : stride != 2 && stride != 4) {
    return bad(fmt::format("byteStride {} is not possible for {}", stride, attributes ? "ATTRIBUTES" : "indices"));
  }
  if (mode == MeshoptMode::triangles && count % 3 != 0) {
    return bad(fmt::format("count {} is no multiple of 3", count));
  }
  if (count > compressed * kMaxRatio || count * stride > compressed * kMaxRatio) {
    return bad(fmt::format("{} elements of {} bytes cannot be in {} compressed bytes", count, stride, compressed));
  }
  const bool fits = filter == MeshoptFilter::quaternion   ? stride == 8
                    : filter == MeshoptFilter::octahedral ? stride == 4 || stride == 8
                    : filter == MeshoptFilter::color      ? stride == 4 || stride == 8
                                                          : true;
  if (filter != MeshoptFilter::none && (!attributes || !fits)) {
    return bad(fmt::format("the filter is not possible for byteStride {}", stride));
  }
  return {};
}

}  // namespace lodestone::io
