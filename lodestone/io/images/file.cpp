#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/near_file_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

std::string image_mime(std::span<const std::byte> encoded) {
  const std::string_view head(reinterpret_cast<const char*>(encoded.data()), std::min<std::size_t>(encoded.size(), 16));
  if (head.starts_with("\x89PNG\r\n")) return "image/png";
  if (head.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return "image/webp";
  if (head.starts_with("GIF8")) return "image/gif";
  if (head.starts_with("BM")) return "image/bmp";
  if (head.starts_with(std::string_view("II*\0", 4)) || head.starts_with(std::string_view("MM\0*", 4))) {
    return "image/tiff";
  }
  if (head.starts_with("\xabKTX 20")) return "image/ktx2";
  if (head.starts_with("DDS ")) return "image/vnd-ms.dds";
  return {};
}

std::string_view image_extension(std::string_view mime) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kExtensions{{{"image/png", ".png"},
                                                                                      {"image/jpeg", ".jpg"},
                                                                                      {"image/webp", ".webp"},
                                                                                      {"image/gif", ".gif"},
                                                                                      {"image/bmp", ".bmp"},
                                                                                      {"image/tiff", ".tif"},
                                                                                      {"image/ktx2", ".ktx2"},
                                                                                      {"image/vnd-ms.dds", ".dds"}}};
  for (const auto& [type, extension] : kExtensions) {
    if (type == mime) return extension;
  }
  return {};
}

std::shared_ptr<const Image> load_image(const std::optional<std::filesystem::path>& path, std::string_view name,
                                        std::vector<std::string>& warnings) {
  const auto image = std::make_shared<Image>();
  if (!path) {
    image->name = name.substr(name.find_last_of("/\\") + 1);
    warnings.push_back(fmt::format("the texture '{}' was not found in the model's folder", name));
    return image;
  }
  image->name = path->filename().string();  // names that differ in case alone mean one file
  Result<std::string> bytes = read_file(*path);
  if (!bytes) {
    warnings.push_back(fmt::format("the texture '{}' could not be read: {}", name, bytes.error().what));
    return image;
  }
  const auto as_bytes = std::as_bytes(std::span(*bytes));
  image->mime = image_mime(as_bytes);
  if (image->mime.empty()) {
    warnings.push_back(fmt::format("the texture '{}' is not an image of a known type", name));
    return image;
  }
  image->encoded.assign(as_bytes.begin(), as_bytes.end());
  return image;
}

std::shared_ptr<const Image> load_image_near(const std::filesystem::path& folder, std::string_view name,
                                             std::vector<std::string>& warnings) {
  return load_image(NearFiles(folder).find({}, name), name, warnings);
}

namespace {

// Without folders of either spelling, line ends, and a '-' in front, which an MTL takes for an option.
std::string plain_name(std::string_view name) {
  std::string out(name.substr(name.find_last_of("/\\") + 1));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '_');
  out = std::string(trimmed(out));
  if (out == "." || out == "..") return {};
  if (out.starts_with('-')) out.front() = '_';
  return out;
}

// A glTF gives each material an image of its own, be it the same.
bool same_image(const Image& a, const Image& b) { return a.name == b.name && a.encoded == b.encoded; }

}  // namespace

std::vector<TextureFile> texture_files(std::span<const Material> materials, const std::filesystem::path& model,
                                       bool all) {
  const std::string stem = model.stem().string();
  std::vector<TextureFile> files;
  std::set<std::string> taken{model.filename().string(), stem + ".mtl"};
  const auto add = [&](const Image* image) {
    if (image == nullptr || image->encoded.empty() || !texture_name(files, image).empty()) return;
    std::string name = plain_name(image->name);
    if (name.empty()) name = fmt::format("{}_texture{}", stem, files.size());
    if (std::filesystem::path(name).extension().empty()) name += image_extension(image->mime);
    while (!taken.insert(name).second) name.insert(0, 1, '_');
    files.push_back({image, std::move(name)});
  };
  for (const Material& m : materials) {
    add(m.base_color_texture.get());
    if (!all) continue;
    add(m.normal_texture.get());
    for (const MtlLine& line : m.mtl_lines) add(line.texture.get());
  }
  return files;
}

std::string_view texture_name(std::span<const TextureFile> files, const Image* image) {
  if (image == nullptr) return {};
  for (const TextureFile& file : files) {
    if (file.image == image || same_image(*file.image, *image)) return file.name;
  }
  return {};
}

Result<OutputFile> write_texture(const TextureFile& texture, const std::filesystem::path& model) {
  Result<OutputFile> file = OutputFile::create(std::filesystem::path(model).replace_filename(texture.name));
  if (file) file->write(std::span<const std::byte>(texture.image->encoded));
  return file;
}

}  // namespace lodestone::io
