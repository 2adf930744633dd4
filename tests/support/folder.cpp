#include "support/folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

namespace lodestone::test {

InFolder::InFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "lodestone-test-XXXXXX").string();
  EXPECT_NE(::mkdtemp(name.data()), nullptr) << name;
  folder_ = name;
}

InFolder::~InFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace lodestone::test
