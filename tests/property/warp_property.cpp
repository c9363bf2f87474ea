// The laws of the warp between drawing and building, for random fields that do not fold.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "localization/warp/drawing_warp.hpp"

namespace madori::localization {
namespace {

double fraction(int from, int to) {
  return *rc::gen::inRange(from, to + 1) / 1000.0;
}

DrawingWarp any_warp() {
  WarpField field;
  field.origin = {10.0 * fraction(-1000, 1000), 10.0 * fraction(-1000, 1000)};
  field.spacing_m = 2.0 + fraction(0, 2000);
  field.width = *rc::gen::inRange(0, 12);
  field.height = *rc::gen::inRange(0, 12);
  // Neighbours differ by at most 0.45 spacings: sqrt(2) * 2 * 0.159.
  const double most = 0.159 * field.spacing_m;
  for (int i = 0; i < field.width * field.height; ++i) {
    field.control_m.push_back(most * fraction(-1000, 1000));
    field.control_m.push_back(most * fraction(-1000, 1000));
    field.sigma_m.push_back(fraction(1, 400));
  }
  const WarpSimilarity similarity{1.0 + 0.03 * fraction(-1000, 1000), 0.1 * fraction(-1000, 1000),
                                  2.0 * fraction(-1000, 1000), 2.0 * fraction(-1000, 1000)};
  return {similarity, std::move(field), {}};
}

Point2<Map> any_place() {
  return {60.0 * fraction(-1000, 1000), 60.0 * fraction(-1000, 1000)};
}

RC_GTEST_PROP(WarpProperty, EachWayUndoesTheOther, ()) {
  const DrawingWarp warp = any_warp();
  const Transform2<Map, Base> pose(any_place().x_m, any_place().y_m, 3.0 * fraction(-1000, 1000));
  const Transform2<Map, Base> back = warp.map(warp.building(pose));
  RC_ASSERT(distance_m(back.translation(), pose.translation()) < 1e-4);
  RC_ASSERT(std::abs(wrap_angle(back.yaw_rad() - pose.yaw_rad())) < 1e-4);
  const Point2<Building> q{any_place().x_m, any_place().y_m};
  RC_ASSERT(distance_m(warp.building(warp.map(q)), q) < 1e-4);
}

RC_GTEST_PROP(WarpProperty, NothingFolds, ()) {
  const DrawingWarp warp = any_warp();
  const Point2<Map> p = any_place();
  const double turn = kPi * fraction(-1000, 1000);
  const Point2<Map> q{p.x_m + 0.01 * std::cos(turn), p.y_m + 0.01 * std::sin(turn)};
  // Places 1 cm apart stay apart, and on the same side of each other.
  const Point2<Building> a = warp.building(p);
  const Point2<Building> b = warp.building(q);
  const double along = (b.x_m - a.x_m) * (q.x_m - p.x_m) + (b.y_m - a.y_m) * (q.y_m - p.y_m);
  RC_ASSERT(along > 0.0);
  RC_ASSERT(distance_m(a, b) < 0.03);
}

RC_GTEST_PROP(WarpProperty, TheUncertaintyIsPositiveEverywhere, ()) {
  RC_ASSERT(any_warp().sigma_m(any_place()) > 0.0);
}

}  // namespace
}  // namespace madori::localization
