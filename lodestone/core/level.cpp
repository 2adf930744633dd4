#include "lodestone/core/level.h"

namespace lodestone {

const char* to_string(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::estimated:
      return "estimated";
    case ErrorKind::measured:
      return "measured";
    case ErrorKind::bounded:
      return "bounded";
  }
  return "";
}

}  // namespace lodestone
