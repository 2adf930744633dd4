// Giving memory back before an object's end.
#pragma once

namespace lodestone {

/// Empties vectors and gives back their memory. `v = {}` would keep it: it assigns an empty list of elements.
template <class... Vectors>
void free_memory(Vectors&... vectors) {
  (Vectors().swap(vectors), ...);
}

}  // namespace lodestone
