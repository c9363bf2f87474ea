// Control points with half a pixel of noise on a 2000 px drawing: scale, mirroring and stretch.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>

#include "mapping/georeference/control_points.hpp"
#include "mapping/georeference/local_plane.hpp"

namespace madori::mapping {
namespace {

struct Case {
  std::vector<ControlPoint> points;
  double m_per_px = 0.0;
};

/// One point in each quarter of a 2000 px square drawing, as an operator is told to choose them, and up to
/// eight more anywhere; clicks are normally distributed, 0.5 px in each coordinate.
Case random_case(double stretch) {
  std::mt19937 engine(*rc::gen::arbitrary<std::uint32_t>());
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> click(0.0, 0.5);
  Case c;
  c.m_per_px = 0.005 * std::pow(100.0, unit(engine));
  const GeoreferenceRecord truth{-60.0 + 120.0 * unit(engine), -179.0 + 358.0 * unit(engine),
                                 360.0 * unit(engine) - 180.0};
  const int count = *rc::gen::inRange(4, 13);
  for (int i = 0; i < count; ++i) {
    double u = 2000.0 * unit(engine);
    double v = 2000.0 * unit(engine);
    if (i < 4) {
      u = 600.0 * unit(engine) + (i % 2 == 0 ? 0.0 : 1400.0);
      v = 600.0 * unit(engine) + (i / 2 == 0 ? 0.0 : 1400.0);
    }
    const LatLon place = place_of(truth, {u * c.m_per_px * (1.0 + stretch), (2000.0 - v) * c.m_per_px});
    c.points.push_back({u + click(engine), v + click(engine), place});
  }
  return c;
}

RC_GTEST_PROP(ControlPoints, GiveTheScaleWithinATenthOfAPercent, ()) {
  const Case c = random_case(0.0);
  const ScaleEstimate e = fit_control_points(c.points, 2000);
  RC_ASSERT(std::abs(e.m_per_px / c.m_per_px - 1.0) < 0.001);
  RC_ASSERT(!e.mirrored);
  RC_ASSERT(!e.outlier);
  RC_ASSERT(e.verdict != Verdict::Refused);
}

RC_GTEST_PROP(ControlPoints, RecogniseEveryMirroredDrawing, ()) {
  Case c = random_case(0.0);
  const bool along_u = *rc::gen::arbitrary<bool>();
  for (auto& p : c.points) (along_u ? p.u : p.v) = 2000.0 - (along_u ? p.u : p.v);
  const ScaleEstimate e = fit_control_points(c.points, 2000);
  RC_ASSERT(e.mirrored);
  RC_ASSERT(e.verdict == Verdict::Refused);
}

RC_GTEST_PROP(ControlPoints, ReportAStretchOfOnePercent, ()) {
  const double stretch = *rc::gen::element(-0.01, 0.01);
  const ScaleEstimate e = fit_control_points(random_case(stretch).points, 2000);
  RC_ASSERT(e.stretch.has_value());
  RC_ASSERT(std::abs(*e.stretch - stretch) < 0.004);
}

}  // namespace
}  // namespace madori::mapping
