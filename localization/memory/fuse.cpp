#include "localization/memory/fuse.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

/// A quarter turn of a vector: what a small turn moves it by.
Eigen::Vector2d turned(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

Eigen::Matrix2d rotation(const Transform2<Base, Base>& t) {
  Eigen::Matrix2d r;
  r << t.cos_yaw(), -t.sin_yaw(), t.sin_yaw(), t.cos_yaw();
  return r;
}

Eigen::Vector2d translation(const Transform2<Base, Base>& t) {
  return {t.x_m(), t.y_m()};
}

Eigen::Matrix3d covariance_of(const RelativeFactor& factor) {
  return (factor.information + 1e-6 * Eigen::Matrix3d::Identity()).inverse();
}

/// The strongest tie of the node, seen from its neighbour; motions of the chain before loops.
std::vector<RelativeFactor>::const_iterator best_tie(const std::vector<RelativeFactor>& ties) {
  return std::max_element(ties.begin(), ties.end(), [](const auto& a, const auto& b) {
    return std::pair(!a.loop, a.information.determinant()) < std::pair(!b.loop, b.information.determinant());
  });
}

void add(std::vector<RelativeFactor>& factors, RelativeFactor factor) {
  if (factor.from > factor.to) factor = reversed(factor);
  for (RelativeFactor& f : factors) {
    if (f.from == factor.from && f.to == factor.to) {
      f = merged(f, factor);
      return;
    }
  }
  factors.push_back(factor);
}

}  // namespace

Eigen::Matrix3d limited(const Eigen::Matrix3d& information, const Eigen::Vector3d& grown) {
  const Eigen::Vector3d floor = Eigen::Vector3d(1e-4, 1e-4, 7e-6) + grown;
  const Eigen::Matrix3d regular = information + 1e-3 * Eigen::Matrix3d::Identity();
  return (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse();
}

bool contradicts(const RelativeFactor& f, const std::vector<Transform2<Map, Base>>& poses) {
  constexpr double kContradiction = 25.0;  // sigmas squared
  const Eigen::Vector3d e =
      relative_error(f, poses[static_cast<std::size_t>(f.from)], poses[static_cast<std::size_t>(f.to)]);
  return f.loop && e.dot(f.information * e) > kContradiction;
}

RelativeFactor reversed(const RelativeFactor& factor) {
  const Eigen::Matrix2d back = rotation(factor.motion).transpose();
  Eigen::Matrix3d j = -Eigen::Matrix3d::Identity();
  j.topLeftCorner<2, 2>() = -back;
  j.topRightCorner<2, 1>() = turned(back * translation(factor.motion));
  const Eigen::Matrix3d information = (j * covariance_of(factor) * j.transpose()).inverse();
  return {factor.to, factor.from, factor.motion.inverse(), information, factor.loop};
}

RelativeFactor chained(const RelativeFactor& first, const RelativeFactor& second) {
  Eigen::Matrix3d by_first = Eigen::Matrix3d::Identity();
  by_first.topRightCorner<2, 1>() = turned(rotation(first.motion) * translation(second.motion));
  Eigen::Matrix3d by_second = Eigen::Matrix3d::Identity();
  by_second.topLeftCorner<2, 2>() = rotation(first.motion);
  const Eigen::Matrix3d covariance = by_first * covariance_of(first) * by_first.transpose() +
                                     by_second * covariance_of(second) * by_second.transpose();
  return {first.from, second.to, first.motion * second.motion, covariance.inverse(),
          first.loop || second.loop};
}

RelativeFactor merged(const RelativeFactor& a, const RelativeFactor& b) {
  const Eigen::Matrix3d sum = a.information + b.information;
  const Eigen::Vector3d apart = pose_difference(b.motion, a.motion);
  const Eigen::Vector3d step = (sum + 1e-6 * Eigen::Matrix3d::Identity()).inverse() * (b.information * apart);
  return {a.from, a.to,
          Transform2<Base, Base>(a.motion.x_m() + step[0], a.motion.y_m() + step[1],
                                 a.motion.yaw_rad() + step[2]),
          limited(sum), a.loop && b.loop};
}

bool take_out(int node, const std::vector<Transform2<Map, Base>>& poses,
              std::vector<RelativeFactor>& factors) {
  std::vector<RelativeFactor> ties;  // from the neighbours to the node
  std::vector<RelativeFactor> others;
  for (const RelativeFactor& f : factors) {
    if (f.from != node && f.to != node) {
      others.push_back(f);
    } else if (!contradicts(f, poses)) {
      ties.push_back(f.to == node ? f : reversed(f));
    }
  }
  if (ties.empty()) return false;
  const auto heir = best_tie(ties);
  for (auto tie = ties.cbegin(); tie != ties.cend(); ++tie) {
    if (tie != heir && tie->from != heir->from) add(others, chained(*heir, reversed(*tie)));
  }
  factors = std::move(others);
  return true;
}

}  // namespace madori::localization
