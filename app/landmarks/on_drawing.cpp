#include "app/landmarks/on_drawing.hpp"

#include <cmath>
#include <vector>

#include "core/pose_hypothesis.hpp"
#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/memory/memory.hpp"

namespace madori::app {
namespace {

namespace lm = localization::landmarks;

localization::SurfaceScan seen_at(const lm::Descriptor& descriptor) {
  std::vector<Point2<Base>> points;
  for (int i = 0; i < descriptor.size(); ++i)
    points.push_back({descriptor.range_m(i) * std::cos(descriptor.angle_rad(i)),
                      descriptor.range_m(i) * std::sin(descriptor.angle_rad(i))});
  return localization::make_surface_scan({}, {}, points);
}

}  // namespace

Transform2<Map, Map> landmarks_on_drawing(const lm::LandmarkHub& hub, const mapping::Walls& walls,
                                          const Transform2<Map, Map>& about) {
  localization::Memory seen;
  for (int i = 0; i < hub.map().size(); ++i) {
    const lm::FullPose landmark = hub.landmark(i);
    if (landmark.uncertainty.is_unknown()) continue;
    const auto& [x_m, y_m, yaw_rad] = landmark.motion;
    seen.add(seen_at(hub.map().descriptor(i)), 0.0, about * Transform2<Map, Base>(x_m, y_m, yaw_rad),
             Eigen::Matrix3d::Identity());
  }
  constexpr PoseSigma kGiven;
  const auto found = localization::DrawingFit(walls).align(localization::memory_cloud(seen),
                                                           {3.0 * kGiven.position_m, 3.0 * kGiven.yaw_rad});
  return found.correction * about;
}

}  // namespace madori::app
