#include <gtest/gtest.h>

#include "lodestone/base/parallel.h"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const lodestone::ThreadLimit limit(7);  // more than the machine has, so that 7 threads are really 7
  return RUN_ALL_TESTS();
}
