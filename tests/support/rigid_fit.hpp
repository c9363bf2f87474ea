#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::test {

/// The rigid motion that lays `from` on `onto` with the least squares (closed form; S. Umeyama, PAMI 13,
/// 1991, without scale). Identity for fewer than two pairs.
template <class To, class From>
[[nodiscard]] Transform2<To, From> fit_rigidly(
    const std::vector<std::pair<Point2<From>, Point2<To>>>& pairs) {
  if (pairs.size() < 2) return {};
  const double n = static_cast<double>(pairs.size());
  Point2<From> a{0.0, 0.0};
  Point2<To> b{0.0, 0.0};
  for (const auto& [from, onto] : pairs) {
    a = {a.x_m + from.x_m / n, a.y_m + from.y_m / n};
    b = {b.x_m + onto.x_m / n, b.y_m + onto.y_m / n};
  }
  double dot = 0.0, cross = 0.0;
  for (const auto& [from, onto] : pairs) {
    const double fx = from.x_m - a.x_m, fy = from.y_m - a.y_m;
    const double ox = onto.x_m - b.x_m, oy = onto.y_m - b.y_m;
    dot += fx * ox + fy * oy;
    cross += fx * oy - fy * ox;
  }
  const Transform2<To, From> turn(0.0, 0.0, std::atan2(cross, dot));
  const Point2<To> turned = turn * a;
  return {b.x_m - turned.x_m, b.y_m - turned.y_m, turn.yaw_rad()};
}

/// What lays the first poses' positions on those of the second: a map has no place of its own, and noise in
/// its first scans turns all of it.
inline Transform2<Map, Map> laid_on(const std::vector<Transform2<Map, Base>>& from,
                                    const std::vector<Transform2<Map, Base>>& to) {
  std::vector<std::pair<Point2<Map>, Point2<Map>>> pairs;
  for (std::size_t i = 0; i < from.size(); ++i)
    pairs.emplace_back(from[i].translation(), to[i].translation());
  return fit_rigidly<Map, Map>(pairs);
}

}  // namespace madori::test
