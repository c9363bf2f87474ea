#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/stamp.hpp"
#include "core/wheels.hpp"

namespace madori::localization {

/// How far each wheel has turned since the beginning, by the encoders.
struct WheelReading {
  Stamp stamp{};
  double left_rad = 0.0;
  double right_rad = 0.0;
};

/// What the wheels turned, and where that would have led. Between two readings they turned evenly; before the
/// first and after the last they stood.
class WheelPath {
 public:
  /// Readings in the order of time.
  WheelPath(std::vector<WheelReading> readings, const WheelGeometry& wheels);

  [[nodiscard]] bool empty() const { return readings_.empty(); }
  [[nodiscard]] Transform2<Odom, Base> at(Stamp moment) const;
  /// Left and right angles of the pieces between two moments, each short enough to count as an arc.
  [[nodiscard]] std::vector<std::array<double, 2>> pieces(Stamp from, Stamp to) const;
  [[nodiscard]] const WheelGeometry& wheels() const { return wheels_; }
  /// Turned on the spot or in curves, and driven, all directions added up.
  [[nodiscard]] double turned_rad() const { return turned_rad_; }
  [[nodiscard]] double driven_m() const { return driven_m_; }

 private:
  [[nodiscard]] WheelReading reading_at(Stamp moment) const;
  [[nodiscard]] std::size_t first_after(Stamp moment) const;

  WheelGeometry wheels_;
  std::vector<WheelReading> readings_;
  std::vector<Transform2<Odom, Base>> poses_;  ///< at each reading
  double turned_rad_ = 0.0;
  double driven_m_ = 0.0;
};

}  // namespace madori::localization
