// Four floats or whole numbers at once, by the compilers' own vectors: operators work lane by lane, on any processor.
#pragma once

#include <cstdint>

namespace lodestone {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 fill(float f) { return Float4{f, f, f, f}; }

/// Four floats in a row, at an address that is a multiple of 16.
inline Float4 load(const float* p) { return *reinterpret_cast<const Float4*>(p); }

}  // namespace lodestone
