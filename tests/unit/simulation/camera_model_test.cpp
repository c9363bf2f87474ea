#include "simulation/camera/camera_model.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

/// Blue, green and red of a pixel, together.
int light_at(const CameraPicture& picture, int column, int row) {
  const auto at = 3 * static_cast<std::size_t>(row * picture.width_px + column);
  return picture.bgr.at(at) + picture.bgr.at(at + 1) + picture.bgr.at(at + 2);
}

TEST(CameraModel, TheSameFactoryGivesTheSamePicture) {
  const Factory factory(test::small_hall());
  const auto picture = take_picture(factory);
  EXPECT_EQ(picture.bgr.size(), 3U * 320U * 180U);
  EXPECT_EQ(picture.bgr, take_picture(factory).bgr);
}

TEST(CameraModel, ANearWallIsBrighterThanAFarOneAndThanTheFloor) {
  const auto near = take_picture(Factory(test::small_hall(20.0, 12.0, 17.0, 6.0)));
  const auto far = take_picture(Factory(test::small_hall(20.0, 12.0, 3.0, 6.0)));
  EXPECT_GT(light_at(near, 160, 70), light_at(far, 160, 70) + 30);
  EXPECT_GT(light_at(near, 160, 70), light_at(near, 160, 179) + 30) << "its own floor";
}

TEST(CameraModel, WhatStandsInFrontIsSeenInItsPlace) {
  auto setup = test::small_hall(20.0, 12.0, 5.0, 6.0);
  const auto empty = take_picture(Factory(setup));
  Factory factory(setup);
  MoverSpec person;
  person.name = "person";
  person.path = {{8.0, 7.0}, {8.0, 7.01}};
  factory.add_mover(person);
  factory.step(std::chrono::milliseconds(100));
  const auto seen = take_picture(factory);
  int left = 0, right = 0;
  for (int row = 0; row < seen.height_px; ++row)
    for (int column = 0; column < seen.width_px; ++column)
      if (light_at(seen, column, row) != light_at(empty, column, row)) ++(column < 160 ? left : right);
  EXPECT_GT(left, 300) << "a person one metre to the left, three ahead";
  EXPECT_EQ(right, 0);
}

}  // namespace
}  // namespace madori::simulation
