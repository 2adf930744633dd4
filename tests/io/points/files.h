// Small files of points, made in memory.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace lodestone::io::test {

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}
template <class T>
void put_at(std::string& out, std::size_t at, T value) {
  std::memcpy(out.data() + at, &value, sizeof(T));
}

/// LZF with runs of plain bytes, and copies wherever the last eight bytes come again.
inline std::string pack_lzf(const std::string& plain) {
  std::string out;
  for (std::size_t i = 0; i < plain.size();) {
    std::size_t same = 0;
    while (i >= 8 && same < 264 && i + same < plain.size() && plain[i + same] == plain[i + same - 8]) ++same;
    if (same >= 3) {
      const std::size_t length = same - 2;
      if (length < 7) {
        out += static_cast<char>(length << 5);
      } else {
        out += static_cast<char>(7 << 5);
        out += static_cast<char>(length - 7);
      }
      out += static_cast<char>(7);  // 8 back
      i += same;
    } else {
      out += '\0';
      out += plain[i++];
    }
  }
  return out;
}

/// x y z normal_x normal_y normal_z rgba, four bytes each: point i lies at (i, i + 0.5, -i).
inline std::string pcd_header(std::size_t points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z rgba\nSIZE 4 4 4 4 4 4 4\n"
         "TYPE F F F F F F U\nCOUNT 1 1 1 1 1 1 1\nWIDTH " +
         n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}
inline std::array<float, 6> pcd_floats(std::size_t i) {
  const auto f = static_cast<float>(i);
  return {f, f + 0.5F, -f, 0, 0, i % 2 == 0 ? 1.0F : -1.0F};
}
inline constexpr std::uint32_t kPcdColor = 0xC8102030;  // alpha 200, red 16, green 32, blue 48

inline std::string pcd(std::size_t points, const std::string& data) {
  std::string out = pcd_header(points, data), block;
  if (data == "ascii") {
    for (std::size_t i = 0; i < points; ++i) {
      for (const float f : pcd_floats(i)) out += std::to_string(f) + " ";
      out += std::to_string(kPcdColor) + "\n";
    }
    return out;
  }
  if (data == "binary") {
    for (std::size_t i = 0; i < points; ++i) {
      for (const float f : pcd_floats(i)) put(out, f);
      put(out, kPcdColor);
    }
    return out;
  }
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t i = 0; i < points; ++i) put(block, pcd_floats(i)[c]);
  }
  for (std::size_t i = 0; i < points; ++i) put(block, kPcdColor);
  const std::string packed = pack_lzf(block);
  put(out, static_cast<std::uint32_t>(packed.size()));
  put(out, static_cast<std::uint32_t>(block.size()));
  return out + packed;
}

/// LAS 1.`minor`: point i lies at (1000 + i/100, 2000, -i/100), red i, green 2, blue 3 times `color_unit`.
inline std::string las(unsigned minor, unsigned format, std::size_t points, std::uint16_t color_unit = 1) {
  constexpr std::array<std::uint16_t, 11> kBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  constexpr std::array<std::uint16_t, 11> kColor{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  const std::size_t header = minor == 4 ? 375 : minor == 3 ? 235 : 227;
  std::string out(header, '\0');
  out.replace(0, 4, "LASF");
  out[24] = 1;
  out[25] = static_cast<char>(minor);
  put_at(out, 94, static_cast<std::uint16_t>(header));
  put_at(out, 96, static_cast<std::uint32_t>(header + 10));
  out[104] = static_cast<char>(format);
  put_at(out, 105, static_cast<std::uint16_t>(kBytes[format] + 3));  // three extra bytes a point
  if (minor == 4) {
    put_at(out, 247, std::uint64_t{points});
  } else {
    put_at(out, 107, static_cast<std::uint32_t>(points));
  }
  for (std::size_t k = 0; k < 3; ++k) put_at(out, 131 + 8 * k, 0.01);
  put_at(out, 155, 1000.0);
  put_at(out, 163, 2000.0);
  out += std::string(10, 'v');
  for (std::size_t i = 0; i < points; ++i) {
    std::string record(kBytes[format] + 3U, '\0');
    put_at(record, 0, static_cast<std::int32_t>(i));
    put_at(record, 8, -static_cast<std::int32_t>(i));
    if (kColor[format] > 0) {
      put_at(record, kColor[format], static_cast<std::uint16_t>(i * color_unit));
      put_at(record, kColor[format] + 2U, static_cast<std::uint16_t>(2 * color_unit));
      put_at(record, kColor[format] + 4U, static_cast<std::uint16_t>(3 * color_unit));
    }
    out += record;
  }
  return out;
}

}  // namespace lodestone::io::test
