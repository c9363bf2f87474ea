#include "simulation/camera/camera_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/lidar/view.hpp"

namespace madori::simulation {
namespace {

using Colour = std::array<double, 3>;  ///< blue, green, red

Colour colour_of(Material material) {
  switch (material) {
    case Material::Wall:
      return {205, 212, 214};
    case Material::Floor:
      return {120, 126, 128};
    case Material::Metal:
      return {150, 140, 120};
    case Material::Wood:
      return {90, 130, 170};
    case Material::Glass:
      return {190, 170, 140};
    case Material::Cloth:
      return {60, 90, 200};
  }
  return {0, 0, 0};
}

/// Slanted and distant surfaces are darker; what is out of range is dark.
Colour shade(const Hit& hit, double range_max_m) {
  const double range_m = static_cast<double>(hit.range_m);
  if (!(range_m < range_max_m)) return {40, 36, 32};
  const double slant = 0.45 + 0.55 * std::abs(static_cast<double>(hit.incidence_cos));
  const double light = slant * (0.35 + 0.65 / (1.0 + 0.004 * range_m * range_m));
  Colour colour = colour_of(hit.material);
  for (double& part : colour) part *= light;
  return colour;
}

}  // namespace

CameraPicture take_picture(const Factory& factory, const CameraOptions& options) {
  const int width = options.width_px, height = options.height_px;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto& record = factory.vehicle().record();
  const mapping::SensorRecord mounting{"camera", "camera",         record.length_m - record.base_to_rear_m,
                                       0.0,      options.height_m, 0.0};
  const SensorPose from = sensor_pose(factory.world(), factory.truth().building_from_base, mounting);
  const double reach = std::tan(0.5 * to_rad(options.field_of_view_deg));
  const double c = std::cos(to_rad(options.tilt_deg)), s = std::sin(to_rad(options.tilt_deg));
  BeamBatch rays;
  rays.reset(pixels);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double left = reach * (1.0 - (2.0 * column + 1.0) / width);
      const double up = reach * height / width * (1.0 - (2.0 * row + 1.0) / height);
      const double length = std::sqrt(1.0 + left * left + up * up);
      rays.set(
          static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column),
          from, (c + s * up) / length, left / length, (c * up - s) / length);
    }
  }
  rays.cast(factory.world().rays(), factory.bodies(), static_cast<float>(options.range_max_m));
  CameraPicture picture{width, height, std::vector<std::uint8_t>(3 * pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const Colour colour = shade(rays.hit(i), options.range_max_m);
    for (std::size_t part = 0; part < 3; ++part)
      picture.bgr[3 * i + part] = static_cast<std::uint8_t>(std::clamp(colour[part], 0.0, 255.0));
  }
  return picture;
}

}  // namespace madori::simulation
