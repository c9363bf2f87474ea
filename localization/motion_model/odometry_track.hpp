#pragma once

#include <optional>

#include "core/odometry.hpp"
#include "core/ring.hpp"
#include "localization/motion_model/odometry_model.hpp"

namespace madori::localization {

/// The last readings of dead reckoning, to ask for the motion between any two recent moments.
class OdometryTrack {
 public:
  /// False, and the reading is left out, when it is not finite or older than its forerunner.
  bool add(const OdometryReading& reading);
  /// Adds it; the raw motion since its forerunner (the first reading: none), nothing where it is left out.
  [[nodiscard]] std::optional<Transform2<Base, Base>> follow(const OdometryReading& reading);

  [[nodiscard]] bool empty() const { return readings_.empty(); }
  [[nodiscard]] const OdometryReading& newest() const { return readings_.back(); }
  /// Where dead reckoning was at `stamp`: interpolated, or carried on at the last speed for at most
  /// kCarryOn; nothing when there is no reading near enough.
  [[nodiscard]] std::optional<OdometryReading> at(Stamp stamp) const;
  /// The corrected motion from one moment to a later one. Before the first reading, and later than kCarryOn
  /// after the newest, it stands: silent wheels tell nothing of what was before them.
  [[nodiscard]] OdometryStep between(Stamp from, Stamp to, const OdometryModel& model) const;
  /// The same from a moment to the newest reading; none where nothing was read.
  [[nodiscard]] OdometryStep since(Stamp from, const OdometryModel& model) const {
    return empty() ? OdometryStep{} : between(from, newest().stamp, model);
  }

 private:
  [[nodiscard]] Transform2<Odom, Base> clipped(Stamp stamp) const;

  static constexpr Duration kCarryOn = std::chrono::milliseconds(250);
  static constexpr Duration kKept = std::chrono::seconds(30);
  Ring<OdometryReading> readings_;
};

}  // namespace madori::localization
