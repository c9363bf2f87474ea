#pragma once

// No standard library on purpose: what this folder's core needs of <cmath>, for targets that have none. Built
// from additions and multiplications alone, so that every processor gives the same bits (compiled without
// fused multiply-add).

namespace madori::localization::landmarks {

inline constexpr double kHalfTurn_rad = 3.14159265358979323846;
inline constexpr double kInfinity = __builtin_huge_val();

/// Square root of a finite x >= 0; 0 below.
[[nodiscard]] double square_root(double x);
/// Both at once, |angle_rad| < 1e6.
void sine_cosine(double angle_rad, double& sine, double& cosine);
/// Angle of (x, y) in [-pi, pi]; 0 for (0, 0).
[[nodiscard]] double arctangent(double y, double x);
/// e^x for x <= 0; 0 below -700.
[[nodiscard]] double exponential(double x);
/// Largest whole number that is not above x, |x| < 1e9.
[[nodiscard]] int whole_below(double x);
/// The same direction in [-pi, pi).
[[nodiscard]] double wrapped(double angle_rad);

}  // namespace madori::localization::landmarks
