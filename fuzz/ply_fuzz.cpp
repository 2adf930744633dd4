// Any bytes as PLY: a model that validates, or an error; never a crash, a hang, or much memory.
#include <cstddef>
#include <cstdint>
#include <span>

#include "lodestone/base/check.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/plain/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = lodestone::io::read_ply(std::as_bytes(std::span(data, size)), "fuzz.ply");
  if (model) LODESTONE_CHECK(lodestone::validate(*model), "what a reader gives is valid");
  return 0;
}
