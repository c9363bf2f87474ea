#include "app/mounting/mounting_findings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/mounting/mounting_words.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

using localization::MountingKnown;

/// Against what is typed.
std::string wheels_text(const std::optional<localization::FoundWheels>& found) {
  if (!found) return "the wheels: not found\n";
  const Eigen::Vector3d percent = 100.0 * found->too_large, sigma = 100.0 * found->sigma;
  return fmt::format(
      "the wheels: left {:+.2f} +- {:.2f} %, right {:+.2f} +- {:.2f} %, distance {:+.2f} +- {:.2f} % against "
      "what is typed\n",
      percent[0], sigma[0], percent[1], sigma[1], percent[2], sigma[2]);
}

Notice lack_of(const localization::FoundMounting& lidar, const localization::MountingCalibration& found) {
  if (lidar.lack != localization::MountingLack::Wheels) return lack_words(lidar.lack);
  const auto percent = [&](int i) { return fmt::format("{:+.1f}", 100.0 * found.wheels->too_large[i]); };
  return notice(kLackWheels, {{"left", percent(0)}, {"right", percent(1)}, {"distance", percent(2)}});
}

double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

}  // namespace

double MountingFinding::apart_m() const {
  return std::hypot(found.x_m - typed.x_m, found.y_m - typed.y_m);
}

double MountingFinding::turned_deg() const {
  return to_deg(wrap_angle(to_rad(found.yaw_deg - typed.yaw_deg)));
}

double MountingFinding::tilt_deg() const {
  return measured.floor ? to_deg(measured.floor->tilt_rad()) : 0.0;
}

std::vector<MountingFinding> mounting_findings(const localization::MountingCalibration& found,
                                               const std::vector<mapping::SensorRecord>& sensors) {
  std::vector<MountingFinding> all;
  for (std::size_t i = 0; i < sensors.size() && i < found.lidars.size(); ++i) {
    const auto& lidar = found.lidars[i];
    MountingFinding one{sensors[i], sensors[i], lidar, lack_of(lidar, found)};
    if (lidar.known != MountingKnown::Nothing)
      one.found.yaw_deg = rounded(to_deg(lidar.mounting.yaw_rad), 100.0);
    if (lidar.known == MountingKnown::All) {
      one.found.x_m = rounded(lidar.mounting.x_m, 1000.0);
      one.found.y_m = rounded(lidar.mounting.y_m, 1000.0);
    }
    if (lidar.floor) one.found.z_m = rounded(lidar.floor->height_m, 1000.0);
    all.push_back(std::move(one));
  }
  return all;
}

std::string known_word(MountingKnown known) {
  return known == MountingKnown::All ? "all" : known == MountingKnown::Yaw ? "yaw" : "nothing";
}

std::string mounting_text(const localization::MountingCalibration& found,
                          const std::vector<MountingFinding>& findings) {
  std::string text;
  for (const auto& f : findings) {
    const auto& m = f.measured;
    text += fmt::format("lidar {} ({})\n", f.typed.name, f.typed.type);
    const auto line = [&](const char* what, double typed, double is, double sigma, const char* unit,
                          bool known) {
      if (known)
        text += fmt::format("  {:<6} typed {:+8.3f} {}  found {:+8.3f} {} +- {:.3f}\n", what, typed, unit, is,
                            unit, sigma);
      else
        text += fmt::format("  {:<6} typed {:+8.3f} {}  not found\n", what, typed, unit);
    };
    const bool place = m.known == MountingKnown::All;
    line("x", f.typed.x_m, f.found.x_m, m.sigma[0], "m", place);
    line("y", f.typed.y_m, f.found.y_m, m.sigma[1], "m", place);
    line("yaw", f.typed.yaw_deg, f.found.yaw_deg, to_deg(m.sigma[2]), "deg",
         m.known != MountingKnown::Nothing);
    if (m.floor) {
      line("height", f.typed.z_m, f.found.z_m, m.floor->sigma_m, "m", true);
      text += fmt::format("  it leans by {:.1f} deg against the floor\n", f.tilt_deg());
    }
    text += fmt::format("  {} sweeps, {} pieces of wall, which lie {:.1f} mm off their walls\n", m.sweeps,
                        m.walls, m.residual_m * 1e3);
    if (!f.lack.empty()) text += "  " + f.lack.text + "\n";
  }
  for (const auto& a : found.agreements)
    text +=
        fmt::format("lidars {} and {} see {} pieces of the same walls, {:.1f} mm apart\n",
                    findings[a.first].typed.name, findings[a.second].typed.name, a.walls, a.apart_m * 1e3);
  return text + wheels_text(found.wheels) +
         fmt::format("by the wheels: turned {:.0f} deg, driven {:.1f} m\n", to_deg(found.turned_rad),
                     found.driven_m);
}

}  // namespace madori::app
