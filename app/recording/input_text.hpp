#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// Whether the revolutions of a step were assembled from packets that are recorded.
[[nodiscard]] bool has_packets(const CycleInput& input);
/// One step's input without its revolutions, and the pose that localization gave in it, as a line of JSON;
/// every number comes back to the last bit.
[[nodiscard]] std::string input_text(const CycleInput& input, const PoseEstimate& pose = {});
/// The scans of the step without their ranges, in the order of the bag's messages.
[[nodiscard]] std::vector<LaserScan> scans_of_text(const std::string& text);
/// That pose.
[[nodiscard]] PoseEstimate pose_from_text(const std::string& text);
/// The same back; `clouds` stays empty. Throws Error on what no recorder wrote.
[[nodiscard]] CycleInput input_from_text(const std::string& text);
/// A revolution of a step, as its recording names it.
struct RecordedCloud {
  Stamp stamp{};
  std::optional<std::int64_t> firing_us;  ///< the lidar's own time; absent where it is recorded as a cloud
  std::size_t lidar = 0;
};
[[nodiscard]] std::vector<RecordedCloud> clouds_of_text(const std::string& text);

/// What the drive was told at `now`, to compare bit for bit.
[[nodiscard]] std::string command_text(const CycleOutput& output, Stamp now);
/// The `now` of such a text; throws Error on what no recorder wrote.
[[nodiscard]] Stamp stamp_of_command(const std::string& text);

}  // namespace madori::app
