#include "app/options/surface_attributes.h"

#include "lodestone/io/images/decode.h"
#include "lodestone/io/images/encode.h"

namespace lodestone::app {

OptionGroup baked_group() {
  return {"What comes over from the input",
          {{"--texture-size",
            "",
            "N",
            "",
            "texels",
            "bake the input's base colour and normals into textures of N x N (16 to 16,384; without: normals and "
            "colours at vertices)",
            {},
            Completion::none},
           {"--no-attributes",
            "",
            "",
            "",
            "",
            "write positions only: no normals, colours or textures",
            {},
            Completion::none}}};
}

Result<chain::SurfaceAttributeOptions> surface_attributes(const Arguments& arguments) {
  chain::SurfaceAttributeOptions options;
  options.encode = io::png_image;
  options.attributes = !arguments.has("--no-attributes");
  if (!arguments.has("--texture-size")) return options;
  if (!options.attributes) {
    return fail(ErrorCode::bad_argument, "--texture-size and --no-attributes can't be given together", {},
                "choose one");
  }
  const Result<std::uint64_t> size = arguments.count("--texture-size", 16, 16'384);
  LODESTONE_TRY(size);
  options.texture_size = static_cast<std::uint32_t>(*size);
  return options;
}

Result<void> decode_for(const chain::SurfaceAttributeOptions& options, Model& model, std::vector<std::string>& warnings,
                        const Task& task) {
  return options.attributes ? io::decode_base_colors(model, warnings, task) : Result<void>{};
}

}  // namespace lodestone::app
