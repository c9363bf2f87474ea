#include "app/simulated/factory_link.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/lidars.hpp"
#include "control/diff_drive/kinematics.hpp"

namespace madori::app {

FactoryLink::FactoryLink(std::shared_ptr<simulation::Factory> factory, const WheelGeometry& wheels,
                         Duration step)
    : factory_(std::move(factory)), wheels_(wheels), step_(step) {
  for (const auto& sensor : factory_->sensors()) {
    const auto& row = sensors::lidar_of(sensor.type, "sensor " + sensor.name);
    const std::size_t lidar = lidars_.size();
    const auto unit = std::ranges::count(lidars_, sensor.type, &Decoding::type);
    auto decoder = row.decoder(lidar_settings(sensor),
                               [this, lidar](sensors::LidarSweep& sweep) { take_sweep(lidar, sweep); });
    lidars_.push_back(
        {sensor.type, static_cast<std::size_t>(unit), row.keeps_bytes, false, std::move(decoder)});
  }
}

void FactoryLink::take_sweep(std::size_t lidar, sensors::LidarSweep& sweep) {
  lidars_[lidar].stops = !sweep.stop.empty();
  if (auto* scan = std::get_if<LaserScan>(&sweep.seen)) {
    scan->lidar = lidar;
    scans_.push_back(std::move(*scan));
    return;
  }
  clouds_.push_back(std::move(std::get<PointCloud<Lidar>>(sweep.seen)));
  clouds_.back().lidar = lidar;
  firings_us_.push_back(sweep.device_us);
}

void FactoryLink::collect(CycleInput& input) {
  factory_->step(step_);
  for (const auto& packet : factory_->take_packets()) take(packet, input);
  input.clouds = std::exchange(clouds_, {});
  input.scans = std::exchange(scans_, {});
  input.protective_stop = std::ranges::any_of(lidars_, &Decoding::stops);
  input.firings_us = std::exchange(firings_us_, {});
}

FactoryLink::Decoding* FactoryLink::decoding_of(const simulation::DevicePacket& packet) {
  for (Decoding& lidar : lidars_)
    if (lidar.type == simulation::to_string(packet.device) && lidar.unit == packet.unit) return &lidar;
  return nullptr;
}

void FactoryLink::take(const simulation::DevicePacket& packet, CycleInput& input) {
  if (Decoding* lidar = decoding_of(packet)) {
    lidar->decoder->push(packet.bytes, packet.sent);
    if (lidar->keeps_bytes) input.packets.push_back({packet.sent, packet.bytes});
  }
  if (packet.device != simulation::Device::Drive) return;
  for (const std::uint8_t byte : packet.bytes) {
    control::wire::Status status;
    if (cutter_.push(byte) &&
        control::wire::decode(cutter_.frame(), cutter_.size(), status) == control::wire::Verdict::Good)
      input.drive.push_back(status);
  }
}

void FactoryLink::send(const CycleOutput& output) {
  const auto wheels = control::wheel_speeds(wheels_, output.command);
  const control::wire::Command command{++sequence_, output.enable,
                                       static_cast<std::int32_t>(std::llround(wheels.left_radps * 1e6)),
                                       static_cast<std::int32_t>(std::llround(wheels.right_radps * 1e6))};
  std::array<std::uint8_t, control::wire::kMaxFrame> frame{};
  const std::size_t size = control::wire::encode(command, frame.data());
  factory_->drive_write(std::span(frame.data(), size));
}

}  // namespace madori::app
