// A test with a folder of its own under the system's temporary folder, gone when the test ends.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>

namespace lodestone::test {

class InFolder : public ::testing::Test {
 protected:
  InFolder();
  ~InFolder() override;
  std::filesystem::path folder_;
};

}  // namespace lodestone::test
