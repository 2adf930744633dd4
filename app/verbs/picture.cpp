#include "app/verbs/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>

#include "app/input.h"
#include "lodestone/base/file.h"
#include "lodestone/io/images/decode.h"
#include "lodestone/io/images/encode.h"

namespace lodestone::app {

Result<std::string> picture_output(const Arguments& arguments) {
  const std::string& input = arguments.inputs.front();
  if (!arguments.has("--output")) {
    return fail(ErrorCode::bad_argument, "render needs an output", {},
                fmt::format("add one, such as -o {}.png", std::filesystem::path(input).stem().string()));
  }
  const std::string output = arguments.text("--output");
  const std::string extension = std::filesystem::path(output).extension().string();
  if (!io::is_picture_extension(extension)) {
    return fail(ErrorCode::bad_argument,
                extension.empty() ? "has no ending that names a format of pictures"
                                  : fmt::format("'{}' is no format of pictures that we write", extension),
                output, "end it in .png or .webp");
  }
  if (const Result<void> checked = check_place(output, {arguments.inputs.begin(), arguments.inputs.end()}); !checked)
    return fail(checked.error());
  return output;
}

Result<Model> read_drawn_level(const std::string& input, std::size_t level, std::vector<std::string>& warnings,
                               const Console& console, const Task& task, const VolumeRequest& volume) {
  LODESTONE_TRY(check_level(input, level));
  io::ReadOptions options;
  options.draw_level = level;
  Result<Model> model = read_input(input, console, task, options, volume);
  if (!model) return model;
  for (Instance& instance : model->instances) instance.transform = model->gltf_axes * instance.transform;  // Y up
  model->gltf_axes = {};
  warnings.insert(warnings.end(), model->warnings.begin(), model->warnings.end());
  std::vector<std::string> undecoded;
  if (const auto done = io::decode_base_colors(*model, undecoded, task); !done) return fail(done.error());
  for (const std::string& warning : undecoded) console.note(fmt::format("{}: {}", input, warning));
  warnings.insert(warnings.end(), undecoded.begin(), undecoded.end());
  return model;
}

// The picture must not replace a file of the input. Model::files doesn't name the textures of OBJ and PLY: these show
// by their bytes.
Result<void> check_picture_kept(const Model& model, const std::string& output) {
  LODESTONE_TRY(io::check_replaced(model, output));
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(output, ignored)) return {};
  const Result<std::string> there = read_file(output);
  LODESTONE_TRY(there);
  for (const Material& material : model.materials) {
    if (material.base_color_texture == nullptr) continue;
    const std::vector<std::byte>& texture = material.base_color_texture->encoded;
    if (std::ranges::equal(std::as_bytes(std::span(*there)), texture)) {
      return fail(ErrorCode::cannot_write, "is a texture of the input, which is never overwritten", output,
                  "choose another name for -o");
    }
  }
  return {};
}

}  // namespace lodestone::app
