#include "app/mounting/mounting_run.hpp"

#include <chrono>
#include <utility>

#include "app/cycle/site_config.hpp"
#include "app/lidars.hpp"
#include "app/mounting/mounting_words.hpp"
#include "core/thread_role.hpp"

namespace madori::app {
namespace {

using State = MountingView::State;

std::vector<LidarModel> models_of(const std::vector<mapping::SensorRecord>& sensors) {
  std::vector<LidarModel> models;
  for (const auto& sensor : sensors) models.push_back(lidar_model(sensor));
  return models;
}

}  // namespace

const char* to_string(State state) {
  switch (state) {
    case State::Idle:
      return "idle";
    case State::Driving:
      return "driving";
    case State::Computing:
      return "computing";
    case State::Done:
      return "done";
    case State::Stopped:
      break;
  }
  return "stopped";
}

MountingRun::MountingRun(const mapping::VehicleRecord& vehicle, std::vector<mapping::SensorRecord> sensors,
                         const MountingDriveOptions& options)
    : sensors_(std::move(sensors)),
      vehicle_(vehicle_config(vehicle, models_of(sensors_))),
      log_(vehicle_.odometry.wheels),
      manoeuvre_(vehicle_, options) {
  view_.state = State::Driving;
}

MountingView MountingRun::view() const {
  const std::scoped_lock lock(mutex_);
  return view_;
}

CycleOutput MountingRun::tick(const CycleInput& input) {
  using Stage = MountingManoeuvre::Stage;
  if (answer_.valid()) look_after_answer();
  if (!drives()) return {};
  log_.add(input);
  if (stop_) manoeuvre_.stop(notice(kMountingStopped));
  const CycleOutput output = manoeuvre_.step(input, log_.odometry());
  const Stage stage = manoeuvre_.stage();
  if (stage == Stage::Done)
    answer_ = std::async(std::launch::async,
                         [drive = log_.drive(), lidars = vehicle_.lidars, wheels = vehicle_.odometry.wheels] {
                           (void)take_role("mounting", ThreadRole::Behind);
                           return localization::calibrate_mounting(drive, lidars, wheels);
                         });
  const std::scoped_lock lock(mutex_);
  view_.progress = manoeuvre_.progress();
  view_.notice = manoeuvre_.notice();
  if (stage == Stage::Done) view_.state = State::Computing;
  if (stage == Stage::Stopped) view_.state = State::Stopped;
  return output;
}

void MountingRun::look_after_answer() {
  if (answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  auto found = answer_.get();
  auto findings = mounting_findings(found, sensors_);
  const std::scoped_lock lock(mutex_);
  view_.state = State::Done;
  view_.found = std::move(found);
  view_.findings = std::move(findings);
}

}  // namespace madori::app
