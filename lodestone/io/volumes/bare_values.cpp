#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

#include "lodestone/io/volumes/bare_values_detail.h"
#include "lodestone/io/volumes/itk_detail.h"

namespace lodestone::io::detail {
namespace fs = std::filesystem;

std::size_t component_bytes(const std::string& component) {
  if (component == "uint8" || component == "int8") return 1;
  if (component == "uint16" || component == "int16") return 2;
  if (component == "uint32" || component == "int32" || component == "float32") return 4;
  return component == "float64" ? 8 : 0;
}

namespace {

struct Close {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzFile = std::unique_ptr<std::remove_pointer_t<gzFile>, Close>;

// Up to `into.size()` bytes; fewer at the end of the file, or of what can be unpacked.
std::size_t read_some(gzFile file, std::span<std::byte> into) {
  std::size_t done = 0;
  while (done < into.size()) {
    const auto wanted = static_cast<unsigned>(std::min<std::size_t>(into.size() - done, 1U << 24));
    const int got = gzread(file, into.data() + done, wanted);
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

void swap_bytes(std::span<std::byte> bytes, std::size_t each) {
  for (std::size_t i = 0; i + each <= bytes.size(); i += each) std::reverse(bytes.data() + i, bytes.data() + i + each);
}

template <class From, class To>
void convert(std::span<const std::byte> from, const BareValues& values, std::vector<std::byte>& to) {
  const std::size_t count = from.size() / sizeof(From);
  to.resize(count * sizeof(To));
  const bool as_is = values.slope == 1 && values.intercept == 0;
  for (std::size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, from.data() + i * sizeof(From), sizeof(From));
    const auto out =
        as_is ? static_cast<To>(value) : static_cast<To>(values.slope * static_cast<double>(value) + values.intercept);
    std::memcpy(to.data() + i * sizeof(To), &out, sizeof(To));
  }
}

// Rescaled values are float32.
VoxelType type_of(const BareValues& values) {
  return values.slope == 1 && values.intercept == 0 ? type_for(values.component) : VoxelType::float32;
}

void convert(std::span<const std::byte> from, const BareValues& values, std::vector<std::byte>& to) {
  const std::string& c = values.component;
  if (type_of(values) != VoxelType::float32) {
    if (c == "int8") return convert<std::int8_t, std::int16_t>(from, values, to);
    to.assign(from.begin(), from.end());
  } else if (c == "uint8") {
    convert<std::uint8_t, float>(from, values, to);
  } else if (c == "int8") {
    convert<std::int8_t, float>(from, values, to);
  } else if (c == "uint16") {
    convert<std::uint16_t, float>(from, values, to);
  } else if (c == "int16") {
    convert<std::int16_t, float>(from, values, to);
  } else if (c == "uint32") {
    convert<std::uint32_t, float>(from, values, to);
  } else if (c == "int32") {
    convert<std::int32_t, float>(from, values, to);
  } else if (c == "float64") {
    convert<double, float>(from, values, to);
  } else {
    convert<float, float>(from, values, to);
  }
}

}  // namespace

Result<void> send_bare_values(const fs::path& path, const VolumeHeader& header, const BareValues& values,
                              bool whole_file, const VolumeSink& sink, const Task& task) {
  const std::size_t each = component_bytes(values.component);
  if (each == 0) {
    return fail(ErrorCode::bad_argument, fmt::format("'{}' is no type of values", values.component), path.string(),
                "use uint8, int8, uint16, int16, uint32, int32, float32 or float64");
  }
  const GzFile file(gzopen(path.c_str(), "rb"));
  if (!file) return fail(ErrorCode::cannot_read, "can't be opened", path.string());
  std::vector<std::byte> skipped(std::size_t{1} << 16);
  for (std::uint64_t left = values.skip_bytes; left > 0;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(left, skipped.size()));
    if (read_some(file.get(), std::span(skipped).first(part)) < part) break;
    left -= part;
  }
  const auto& size = header.grid.size;
  const std::size_t slice_bytes = std::size_t{size[0]} * size[1] * each;
  std::vector<std::byte> raw(slice_bytes), out;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    if (task.cancelled()) return cancelled_error("reading");
    const std::size_t got = read_some(file.get(), raw);
    if (got < slice_bytes) {
      return fail(ErrorCode::bad_format,
                  fmt::format("ends in slice {} of {}: {} x {} x {} values of {} need {} bytes", z + 1, size[2],
                              size[0], size[1], size[2], values.component, header.grid.count() * each),
                  path.string(), "is it cut off?");
    }
    if (z == 0) {
      LODESTONE_TRY(sink.begin(header, type_of(values)));
    }
    const bool little = std::endian::native == std::endian::little;
    if (each > 1 && values.big_endian == little) swap_bytes(raw, each);
    convert(raw, values, out);
    LODESTONE_TRY(sink.slice(out));
    task.advance(1.0 / size[2]);
  }
  std::byte more;
  if (whole_file && gzread(file.get(), &more, 1) == 1) {
    return fail(ErrorCode::bad_format,
                fmt::format("holds more than {} x {} x {} values of {}", size[0], size[1], size[2], values.component),
                path.string(), "check the size and the type, or name the bytes before the first value");
  }
  return {};
}

namespace {

constexpr std::size_t kNifti2Bytes = 540;

std::vector<std::byte> first_bytes(const fs::path& path, std::size_t count) {
  const GzFile file(gzopen(path.c_str(), "rb"));
  std::vector<std::byte> bytes(count);
  bytes.resize(file ? read_some(file.get(), bytes) : 0);
  return bytes;
}

// Fields of the header, whatever the order of their bytes.
class Fields {
 public:
  Fields(std::span<const std::byte> bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}
  template <class T>
  T at(std::size_t offset) const {
    std::byte raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + offset, sizeof(T));
    if (swapped_) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
  bool swapped_;
};

std::string component_of(std::int16_t code) {
  switch (code) {
    case 2:
      return "uint8";
    case 4:
      return "int16";
    case 8:
      return "int32";
    case 16:
      return "float32";
    case 64:
      return "float64";
    case 256:
      return "int8";
    case 512:
      return "uint16";
    case 768:
      return "uint32";
    default:
      return {};
  }
}

// Columns of the frame with spacing, and the first voxel's place; NIfTI's axes (x right, y anterior) turned to LPS.
struct Frame {
  Vec3d x, y, z, origin;
};

Frame frame_of(const Fields& f) {
  Vec3d spacing;
  for (std::size_t k = 0; k < 3; ++k) {
    const double s = std::abs(f.at<double>(112 + 8 * k));
    spacing[k] = s > 0 && s < 1e9 ? s : 1;
  }
  Frame frame{{spacing.x, 0, 0}, {0, spacing.y, 0}, {0, 0, spacing.z}, {}};
  if (f.at<std::int32_t>(348) > 0) {  // sform
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t at = 400 + 32 * row;
      frame.x[row] = f.at<double>(at);
      frame.y[row] = f.at<double>(at + 8);
      frame.z[row] = f.at<double>(at + 16);
      frame.origin[row] = f.at<double>(at + 24);
    }
  } else if (f.at<std::int32_t>(344) > 0) {  // qform
    const double b = f.at<double>(352), c = f.at<double>(360), d = f.at<double>(368);
    const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    const Mat4d turn = Mat4d::rotation(b, c, d, a);
    const double hand = f.at<double>(104) < 0 ? -1 : 1;
    frame.x = turn.direction({spacing.x, 0, 0});
    frame.y = turn.direction({0, spacing.y, 0});
    frame.z = turn.direction({0, 0, hand * spacing.z});
    frame.origin = {f.at<double>(376), f.at<double>(384), f.at<double>(392)};
  }
  for (Vec3d* v : {&frame.x, &frame.y, &frame.z, &frame.origin}) *v = {-v->x, -v->y, v->z};
  return frame;
}

}  // namespace

bool is_nifti2(const fs::path& path) {
  const std::vector<std::byte> bytes = first_bytes(path, 12);
  return bytes.size() == 12 && std::memcmp(bytes.data() + 4, "n+2\0\r\n\x1a\n", 8) == 0;
}

Result<void> read_nifti2(const fs::path& path, const VolumeSink& sink, const Task& task) {
  const std::vector<std::byte> bytes = first_bytes(path, kNifti2Bytes);
  if (bytes.size() < kNifti2Bytes) {
    return fail(ErrorCode::bad_format, "ends within its header", path.string(), "is it cut off?");
  }
  BareValues values;
  const bool swapped = Fields(bytes, false).at<std::int32_t>(0) != static_cast<std::int32_t>(kNifti2Bytes);
  values.big_endian = swapped == (std::endian::native == std::endian::little);
  const Fields f(bytes, swapped);
  VolumeHeader header;
  std::array<std::uint32_t, 3> size{};
  std::int64_t volumes = 1;
  const std::int64_t sides = f.at<std::int64_t>(16);
  for (std::int64_t k = 1; k <= 7; ++k) {
    const std::int64_t n = k <= sides ? f.at<std::int64_t>(16 + 8 * static_cast<std::size_t>(k)) : 1;
    if (n < 1 || n > 65'535) {
      return fail(ErrorCode::bad_format, fmt::format("says that it has {} voxels along side {}", n, k), path.string());
    }
    if (k <= 3) {
      size[static_cast<std::size_t>(k - 1)] = static_cast<std::uint32_t>(n);
    } else {
      volumes = std::min<std::int64_t>(volumes * n, 1'000'000'000);
    }
  }
  if (sides < 3 || size[2] < 2) {
    return fail(ErrorCode::unsupported, "is a single slice, not a volume", path.string());
  }
  values.component = component_of(f.at<std::int16_t>(12));
  if (values.component.empty()) {
    return fail(ErrorCode::unsupported, fmt::format("has values of NIfTI type {}", f.at<std::int16_t>(12)),
                path.string(), "convert it to 16-bit or float values");
  }
  values.skip_bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(f.at<std::int64_t>(168), 544));
  const double slope = f.at<double>(176);
  if (std::isfinite(slope) && slope != 0) {
    values.slope = slope;
    values.intercept = std::isfinite(f.at<double>(184)) ? f.at<double>(184) : 0;
  }
  const Frame frame = frame_of(f);
  const Vec3d spacing{length(frame.x), length(frame.y), length(frame.z)};
  if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0) || !std::isfinite(length(frame.origin) + length(spacing))) {
    return fail(ErrorCode::bad_format, "says of its voxels that their size or place is no number", path.string());
  }
  header.grid = {size, spacing * -0.5, spacing};
  const Vec3d x = frame.x / spacing.x, y = frame.y / spacing.y, z = frame.z / spacing.z;
  header.to_world.m = {
      x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, frame.origin.x, frame.origin.y, frame.origin.z, 1};
  header.patient_axes = true;
  header.meters_per_unit = 0.001;
  header.files = {path};
  if (volumes > 1) header.warnings.push_back(fmt::format("holds {} volumes, of which the first is read", volumes));
  return send_bare_values(path, header, values, false, sink, task);
}

}  // namespace lodestone::io::detail
