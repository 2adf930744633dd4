// Any bytes as glTF or GLB: a model that validates, or an error; never a crash, a hang, or much memory.
#include <cstddef>
#include <cstdint>
#include <string>

#include "lodestone/base/check.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/gltf/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = lodestone::io::read_gltf_bytes(std::string(reinterpret_cast<const char*>(data), size), "fuzz.glb");
  if (model) LODESTONE_CHECK(lodestone::validate(*model), "what a reader gives is valid");
  return 0;
}
