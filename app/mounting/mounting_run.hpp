#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <optional>
#include <vector>

#include "app/mounting/mounting_findings.hpp"
#include "app/mounting/mounting_log.hpp"
#include "app/mounting/mounting_manoeuvre.hpp"

namespace madori::app {

/// How a measurement of the mountings stands.
struct MountingView {
  enum class State { Idle, Driving, Computing, Done, Stopped };
  State state = State::Idle;
  double progress = 0.0;                    ///< of the drive, 0 to 1
  Notice notice;                            ///< why it stands or was given up
  localization::MountingCalibration found;  ///< of Done
  std::vector<MountingFinding> findings;
};
[[nodiscard]] const char* to_string(MountingView::State state);

/// Drives the short way and computes what it tells, beside the ticks.
class MountingRun {
 public:
  /// `sensors` in the order of the link's lidars. Throws Error where one is none.
  MountingRun(const mapping::VehicleRecord& vehicle, std::vector<mapping::SensorRecord> sensors,
              const MountingDriveOptions& options = {});

  /// From the ticks' thread: what the drive shall do after this input.
  [[nodiscard]] CycleOutput tick(const CycleInput& input);
  /// From any thread.
  void stop() { stop_ = true; }
  [[nodiscard]] MountingView view() const;
  /// It moves the vehicle.
  [[nodiscard]] bool drives() const {
    const std::scoped_lock lock(mutex_);
    return view_.state == MountingView::State::Driving;
  }

 private:
  void look_after_answer();

  std::vector<mapping::SensorRecord> sensors_;
  CycleConfig vehicle_;
  MountingLog log_;
  MountingManoeuvre manoeuvre_;
  std::atomic<bool> stop_ = false;
  std::future<localization::MountingCalibration> answer_;
  mutable std::mutex mutex_;
  MountingView view_;
};

}  // namespace madori::app
