// Whether operations validate what they are given.
#pragma once

namespace lodestone {

/// What an operation takes for granted of meshes, models and volumes that it is given. See validate.h.
enum class Input {
  unchecked,  ///< nothing: it validates them first
  valid,      ///< they were validated, or made by this library: that pass is spared. If they aren't, anything happens.
};

}  // namespace lodestone
