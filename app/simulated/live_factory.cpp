#include "app/simulated/live_factory.hpp"

#include "simulation/devices/live_run.hpp"

namespace madori::app {
namespace {

simulation::DeviceHubOptions hub_options(std::uint16_t lidar_port, const std::filesystem::path& folder) {
  simulation::DeviceHubOptions options;
  options.vlp16_port = lidar_port;
  options.folder = folder;
  return options;
}

}  // namespace

LiveFactory::LiveFactory(const simulation::FactorySetup& setup, std::uint16_t lidar_port,
                         const std::filesystem::path& folder)
    : factory_(setup), hub_(hub_options(lidar_port, folder)), truth_server_(0), truth_(factory_.truth()) {
  thread_ = std::thread([this] {
    simulation::run_live(factory_, hub_, truth_server_, {}, stop_,
                         [this](const simulation::GroundTruth& truth) {
                           const std::scoped_lock lock(mutex_);
                           truth_ = truth;
                           collisions_ = factory_.collisions();
                         });
  });
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
