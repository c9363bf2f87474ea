#include "core/transform2.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <type_traits>

#include "core/frames.hpp"

namespace madori {
namespace {

template <class To, class From>
Transform2<To, From> any_transform() {
  const auto number = [](int limit) { return *rc::gen::inRange(-limit * 1000, limit * 1000) / 1000.0; };
  return {number(200), number(200), number(7)};
}

template <class To, class From>
void expect_same(const Transform2<To, From>& a, const Transform2<To, From>& b) {
  RC_ASSERT(std::abs(a.x_m() - b.x_m()) < 1e-9);
  RC_ASSERT(std::abs(a.y_m() - b.y_m()) < 1e-9);
  RC_ASSERT(std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < 1e-9);
}

// The inner frames must cancel: a compile-time property.
static_assert(std::is_invocable_v<std::multiplies<>, Transform2<Map, Odom>, Transform2<Odom, Base>>);
static_assert(!std::is_invocable_v<std::multiplies<>, Transform2<Map, Odom>, Transform2<Base, Odom>>);
static_assert(!std::is_invocable_v<std::multiplies<>, Transform2<Map, Odom>, Point2<Base>>);

RC_GTEST_PROP(Transform2, CompositionIsAssociative, ()) {
  const auto a = any_transform<Map, Odom>();
  const auto b = any_transform<Odom, Base>();
  const auto c = any_transform<Base, Lidar>();
  expect_same((a * b) * c, a * (b * c));
}

RC_GTEST_PROP(Transform2, InverseUndoes, ()) {
  const auto a = any_transform<Map, Base>();
  expect_same(a * a.inverse(), Transform2<Map, Map>());
  expect_same(a.inverse() * a, Transform2<Base, Base>());
}

RC_GTEST_PROP(Transform2, ActsOnPointsAsItComposes, ()) {
  const auto a = any_transform<Map, Odom>();
  const auto b = any_transform<Odom, Base>();
  const Point2<Base> p{1.5, -2.25};
  RC_ASSERT(distance_m((a * b) * p, a * (b * p)) < 1e-9);
}

TEST(Transform2, TurnsCounterClockwise) {
  const Transform2<Map, Base> map_from_base(1.0, 2.0, kPi / 2.0);
  const Point2<Map> ahead = map_from_base * Point2<Base>{3.0, 0.0};
  EXPECT_NEAR(ahead.x_m, 1.0, 1e-12);
  EXPECT_NEAR(ahead.y_m, 5.0, 1e-12);
}

}  // namespace
}  // namespace madori
