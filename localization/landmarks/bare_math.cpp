#include "localization/landmarks/bare_math.hpp"

#include <stdint.h>

namespace madori::localization::landmarks {
namespace {

/// 1 / n! up to 18, and 1 / n up to 27.
struct Reciprocals {
  double factorial[19] = {};
  double whole[28] = {};
  constexpr Reciprocals() {
    factorial[0] = 1.0;
    for (int n = 1; n < 19; ++n) factorial[n] = factorial[n - 1] / n;
    for (int n = 1; n < 28; ++n) whole[n] = 1.0 / n;
  }
};
constexpr Reciprocals kReciprocal;

/// Taylor series of the sine (first = 1, without its factor x) and the cosine (0): |x| <= pi/4.
double alternating_series(double x2, int first) {
  double sum = 0.0;
  for (int n = 16 + first; n >= 0; n -= 2) sum = kReciprocal.factorial[n] - x2 * sum;
  return sum;
}

/// arctan for 0 <= x <= 1; above tan(15 degrees) by arctan x = 30 degrees + arctan((sqrt3 x - 1) / (sqrt3 +
/// x)).
double arctangent_of_ratio(double x) {
  constexpr double kTan15 = 0.2679491924311227;
  constexpr double kRoot3 = 1.7320508075688772;
  double base = 0.0;
  if (x > kTan15) {
    base = kHalfTurn_rad / 6.0;
    x = (kRoot3 * x - 1.0) / (kRoot3 + x);
  }
  double sum = 0.0;
  for (int n = 27; n >= 1; n -= 2) sum = kReciprocal.whole[n] - x * x * sum;
  return base + x * sum;
}

}  // namespace

double square_root(double x) {
  if (!(x > 0.0)) return 0.0;
  // Half the exponent for a start, then Newton's method.
  double root = __builtin_bit_cast(double, (__builtin_bit_cast(uint64_t, x) >> 1U) + (0x1FF8ULL << 48U));
  for (int i = 0; i < 6; ++i) root = 0.5 * (root + x / root);
  return root;
}

int whole_below(double x) {
  const int towards_zero = static_cast<int>(x);
  return towards_zero - (static_cast<double>(towards_zero) > x ? 1 : 0);
}

double wrapped(double angle_rad) {
  const double turns = whole_below((angle_rad + kHalfTurn_rad) / (2.0 * kHalfTurn_rad));
  const double result = angle_rad - 2.0 * kHalfTurn_rad * turns;
  return result >= kHalfTurn_rad ? -kHalfTurn_rad : result;
}

void sine_cosine(double angle_rad, double& sine, double& cosine) {
  // A quarter turn in two parts, the first exact when multiplied with a small whole number.
  constexpr double kQuarterHigh = 1.57079632673412561417e+00;
  constexpr double kQuarterLow = 6.07710050650619224932e-11;
  const int quarters = whole_below(angle_rad / (0.5 * kHalfTurn_rad) + 0.5);
  const double rest = (angle_rad - quarters * kQuarterHigh) - quarters * kQuarterLow;
  const double s = rest * alternating_series(rest * rest, 1);
  const double c = alternating_series(rest * rest, 0);
  switch (static_cast<unsigned>(quarters) & 3U) {
    case 0:
      sine = s, cosine = c;
      break;
    case 1:
      sine = c, cosine = -s;
      break;
    case 2:
      sine = -s, cosine = -c;
      break;
    default:
      sine = -c, cosine = s;
      break;
  }
}

double arctangent(double y, double x) {
  const double abs_x = x < 0.0 ? -x : x;
  const double abs_y = y < 0.0 ? -y : y;
  if (abs_x == 0.0 && abs_y == 0.0) return 0.0;
  double angle = abs_y <= abs_x ? arctangent_of_ratio(abs_y / abs_x)
                                : 0.5 * kHalfTurn_rad - arctangent_of_ratio(abs_x / abs_y);
  if (x < 0.0) angle = kHalfTurn_rad - angle;
  return y < 0.0 ? -angle : angle;
}

double exponential(double x) {
  if (!(x > -700.0)) return 0.0;
  constexpr double kLn2 = 0.69314718055994530942;
  const int twos = whole_below(x / kLn2 + 0.5);
  const double rest = x - twos * kLn2;
  double sum = 0.0;
  for (int n = 14; n >= 0; --n) sum = kReciprocal.factorial[n] + sum * rest;
  return sum * __builtin_bit_cast(double, static_cast<uint64_t>(1023 + twos) << 52U);
}

}  // namespace madori::localization::landmarks
