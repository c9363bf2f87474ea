#include "localization/surroundings/recent_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace madori::localization {
namespace {

using Motion = Transform2<Base, Base>;

Stamp at_ms(int ms) {
  return Stamp(std::chrono::milliseconds(ms));
}

/// Points along a room of 20 m x 12 m with a pillar, seen from `place` in it, with noise.
ScanPoints seen_from(const Motion& place, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  ScanPoints points;
  const auto add = [&](double x, double y) {
    const Point2<Base> p = place.inverse() * Point2<Base>{x + noise(engine), y + noise(engine)};
    points.add(p.x_m, p.y_m);
  };
  for (double s = 0.0; s < 20.0; s += 0.15) add(s, 0.0), add(s, 12.0);
  for (double s = 0.0; s < 12.0; s += 0.15) add(0.0, s), add(20.0, s);
  for (double s = 0.0; s < 1.0; s += 0.1) add(7.0 + s, 5.0), add(7.0 + s, 6.0), add(7.0, 5.0 + s);
  return points;
}

int degree_of(const Point2<Base>& p) {
  return std::min(359, static_cast<int>((std::atan2(p.y_m, p.x_m) + kPi) / (2.0 * kPi) * 360.0));
}

/// How far a scan saw in a whole degree: to its farthest return there, between two degrees with returns at
/// most six apart to the nearer of them, else not at all.
double sight_m(const ScanPoints& scan, int degree) {
  const auto farthest = [&](int at) {
    double most = 0.0;
    for (std::size_t i = 0; i < scan.size(); ++i)
      if (degree_of(scan.point(i)) == (at + 360) % 360)
        most = std::max(most, std::hypot(scan.point(i).x_m, scan.point(i).y_m));
    return most;
  };
  if (const double here = farthest(degree); here > 0.0) return here;
  int left = 1, right = 1;
  while (left < 360 && farthest(degree + left) == 0.0) ++left;
  while (right < 360 && farthest(degree - right) == 0.0) ++right;
  return left + right <= 6 ? std::min(farthest(degree + left), farthest(degree - right)) : 0.0;
}

/// The share counted the long way: each point against each, as far as the other scan could see it.
double by_hand(const ScanPoints& before, const ScanPoints& now, const Motion& before_from_now) {
  const auto within_m = [](const Point2<Base>& p) {
    return std::min(0.15 + 0.01 * std::hypot(p.x_m, p.y_m), 0.5);
  };
  const auto share = [&](const ScanPoints& of, const ScanPoints& in, const Motion& in_from_of) {
    std::vector<double> sight;
    for (int degree = 0; degree < 360; ++degree) sight.push_back(sight_m(in, degree));
    double near = 0.0, all = 0.0;
    for (std::size_t i = 0; i < of.size(); ++i) {
      const Point2<Base> p = in_from_of * of.point(i);
      const double reach_m = sight[static_cast<std::size_t>(degree_of(p))];
      if (std::hypot(p.x_m, p.y_m) >= reach_m + within_m(p)) continue;
      all += 1.0;
      for (std::size_t k = 0; k < in.size(); ++k)
        if (distance_m(p, in.point(k)) < within_m(of.point(i))) {
          near += 1.0;
          break;
        }
    }
    return near / all;
  };
  return 0.5 * (share(now, before, before_from_now) + share(before, now, before_from_now.inverse()));
}

TEST(RecentView, IsTheShareCountedByHand) {
  const Motion first(5.0, 4.0, 0.3);
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> shift(-6.0, 6.0);
  for (unsigned i = 0; i < 20; ++i) {
    const Motion second = first * Motion(shift(engine), shift(engine), 0.2 * shift(engine));
    const ScanPoints before = seen_from(first, 2 * i);
    const ScanPoints now = seen_from(second, 2 * i + 1);
    RecentView view;
    view.take(at_ms(0), before);
    view.take(at_ms(100), now);
    EXPECT_NEAR(view.kept({}), by_hand(before, now, {}), 1e-9) << i;
    EXPECT_GT(view.kept(first.inverse() * second), 0.98) << "the wheels' own motion, number " << i;
  }
}

TEST(RecentView, SaysNothingOfScansFarApartInTimeOrWithFewPoints) {
  const ScanPoints before = seen_from({5.0, 4.0, 0.0}, 1);
  const ScanPoints elsewhere = seen_from({9.0, 7.0, 1.0}, 2);
  RecentView view;
  EXPECT_EQ(view.kept({}), 1.0);
  view.take(at_ms(0), before);
  EXPECT_EQ(view.kept({}), 1.0);
  view.take(at_ms(100), elsewhere);
  EXPECT_LT(view.kept({}), 0.7);
  view.take(at_ms(700), before);
  EXPECT_EQ(view.kept({}), 1.0);
  view.take(at_ms(800), {});
  EXPECT_EQ(view.kept({}), 1.0);
}

TEST(RecentView, LearnsWhatIsUsual) {
  RecentView view;
  EXPECT_EQ(view.fall(0.1), 0.0) << "nothing is known yet";
  for (int i = 0; i < 40; ++i) view.learn(i % 2 == 0 ? 0.70 : 0.66);
  EXPECT_NEAR(view.fall(0.40), 0.28, 0.01);
}

}  // namespace
}  // namespace madori::localization
