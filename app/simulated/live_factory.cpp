#include "app/simulated/live_factory.hpp"

#include "sensors/lidar/registry.hpp"
#include "simulation/devices/live_run.hpp"

namespace madori::app {
namespace {

simulation::DeviceHubOptions hub_options(const simulation::Factory& factory,
                                         const std::filesystem::path& folder) {
  simulation::DeviceHubOptions options;
  options.sensors = factory.sensors();
  options.folder = folder;
  return options;
}

}  // namespace

LiveFactory::LiveFactory(const simulation::FactorySetup& setup, const std::filesystem::path& folder)
    : factory_(setup), hub_(hub_options(factory_, folder)), truth_server_(0), truth_(factory_.truth()) {
  thread_ = std::thread([this] {
    simulation::run_live(factory_, hub_, truth_server_, {}, stop_,
                         [this](const simulation::GroundTruth& truth) {
                           const std::scoped_lock lock(mutex_);
                           truth_ = truth;
                           collisions_ = factory_.collisions();
                         });
  });
}

std::vector<mapping::SensorRecord> LiveFactory::served() const {
  auto sensors = factory_.sensors();
  const auto addresses = hub_.addresses();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto* row = sensors::find_lidar(sensors[i].type);
    if (row != nullptr && row->link != sensors::LidarLink::Udp) sensors[i].address = addresses[i];
  }
  return sensors;
}

LiveFactory::~LiveFactory() {
  stop_ = true;
  thread_.join();
}

simulation::GroundTruth LiveFactory::truth() const {
  const std::scoped_lock lock(mutex_);
  return truth_;
}

std::vector<simulation::Collision> LiveFactory::collisions() const {
  const std::scoped_lock lock(mutex_);
  return collisions_;
}

}  // namespace madori::app
