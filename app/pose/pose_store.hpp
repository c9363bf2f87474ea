#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "app/cycle/cycle.hpp"
#include "control/drive_link/wire.hpp"
#include "core/pose_estimate.hpp"

namespace madori::app {

inline constexpr const char* kPoseFile = "last_pose.yaml";

/// What the wheels' counters of the drive read.
struct WheelCounters {
  std::uint16_t left_angle = 0;
  std::uint16_t right_angle = 0;
  std::int16_t left_turns = 0;
  std::int16_t right_turns = 0;

  friend bool operator==(const WheelCounters&, const WheelCounters&) = default;
};
[[nodiscard]] WheelCounters counters_of(const control::wire::Status& status);
/// Whether the wheels stand where they stood, to half a degree. A drive that lost its turns counts as moved.
[[nodiscard]] bool same_place(const WheelCounters& a, const WheelCounters& b);

/// Where the vehicle stood last, and how it will know that it still stands there.
struct StoredPose {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  WheelCounters wheels;
  std::string walls;  ///< fingerprint of the walls that the pose is on
};

[[nodiscard]] std::string stored_pose_yaml(const StoredPose& pose);

struct LoadedPose {
  std::optional<StoredPose> pose;
  std::string message;  ///< why there is none, for people; empty where none was ever stored
};
/// Reads `site`/last_pose.yaml. A damaged file, or one of other walls, is no error: the place is found anew.
[[nodiscard]] LoadedPose load_stored_pose(const std::filesystem::path& site, const std::string& walls);

/// Decides once, at the drive's first status, whether the stored pose still holds. What it answers goes to
/// the cycle as an operator's word, and so into the recording.
class PoseRecall {
 public:
  explicit PoseRecall(std::optional<StoredPose> stored) : stored_(std::move(stored)) {}

  /// The place to try, where no wheel has turned since; nothing otherwise, and ever after.
  [[nodiscard]] std::optional<OperatorCommand> on_status(const control::wire::Status& status);
  /// What was decided, for people; empty before.
  [[nodiscard]] const std::string& verdict() const { return verdict_; }

 private:
  std::optional<StoredPose> stored_;
  std::string verdict_;
};

}  // namespace madori::app
