// Any bytes as STL: a model that validates, or an error; never a crash, a hang, or much memory.
#include <cstddef>
#include <cstdint>
#include <span>

#include "lodestone/base/check.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/plain/stl.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = lodestone::io::read_stl(std::as_bytes(std::span(data, size)), "fuzz.stl");
  if (model) LODESTONE_CHECK(lodestone::validate(*model), "what a reader gives is valid");
  return 0;
}
