// The landmark core's test vectors on the host: the same ones run on a bare RISC-V (tests/embedded).
#include <gtest/gtest.h>

#include "tests/embedded/landmark_vectors.hpp"

namespace madori::test {
namespace {

TEST(LandmarkCore, Vectors) {
  landmark_vectors([](const char* name, double computed, double expected, double tolerance) {
    EXPECT_NEAR(computed, expected, tolerance) << name;
  });
}

}  // namespace
}  // namespace madori::test
