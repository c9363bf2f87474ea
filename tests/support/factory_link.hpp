#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/lidars.hpp"
#include "app/runner/vehicle_link.hpp"
#include "control/diff_drive/kinematics.hpp"
#include "control/drive_link/wire.hpp"
#include "sensors/lidar/registry.hpp"
#include "simulation/factory.hpp"

namespace madori::test {

/// The virtual factory in lock-step: the cycle gets what the devices' bytes decode to, the drive gets the
/// bytes of its commands. Time goes on in collect() alone.
class FactoryLink final : public app::VehicleLink {
 public:
  FactoryLink(std::shared_ptr<simulation::Factory> factory, const WheelGeometry& wheels, Duration step)
      : factory_(std::move(factory)), wheels_(wheels), step_(step) {
    for (const auto& sensor : factory_->sensors()) {
      const auto& row = sensors::lidar_of(sensor.type, "sensor " + sensor.name);
      const std::size_t lidar = lidars_.size();
      const auto unit = std::ranges::count(lidars_, sensor.type, &Decoding::type);
      auto decoder = row.decoder(app::lidar_settings(sensor),
                                 [this, lidar](sensors::LidarSweep& sweep) { take_sweep(lidar, sweep); });
      lidars_.push_back(
          {sensor.type, static_cast<std::size_t>(unit), row.keeps_bytes, false, std::move(decoder)});
    }
  }

  void collect(app::CycleInput& input) override {
    factory_->step(step_);
    for (const auto& packet : factory_->take_packets()) take(packet, input);
    input.clouds = std::exchange(clouds_, {});
    input.scans = std::exchange(scans_, {});
    input.protective_stop = std::ranges::any_of(lidars_, &Decoding::stops);
    input.firings_us = std::exchange(firings_us_, {});
  }

  void send(const app::CycleOutput& output) override {
    const auto wheels = control::wheel_speeds(wheels_, output.command);
    const control::wire::Command command{++sequence_, output.enable,
                                         static_cast<std::int32_t>(std::llround(wheels.left_radps * 1e6)),
                                         static_cast<std::int32_t>(std::llround(wheels.right_radps * 1e6))};
    std::array<std::uint8_t, control::wire::kMaxFrame> frame{};
    const std::size_t size = control::wire::encode(command, frame.data());
    factory_->drive_write(std::span(frame.data(), size));
  }

  [[nodiscard]] std::string problem() const override { return ""; }

 private:
  /// A lidar of the factory, in the site's order.
  struct Decoding {
    std::string type;
    std::size_t unit = 0;  ///< among those of its type
    bool keeps_bytes = false;
    bool stops = false;  ///< by its newest sweep
    std::unique_ptr<sensors::LidarDecoder> decoder;
  };

  void take_sweep(std::size_t lidar, sensors::LidarSweep& sweep) {
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

  [[nodiscard]] Decoding* decoding_of(const simulation::DevicePacket& packet) {
    for (Decoding& lidar : lidars_)
      if (lidar.type == simulation::to_string(packet.device) && lidar.unit == packet.unit) return &lidar;
    return nullptr;
  }

  void take(const simulation::DevicePacket& packet, app::CycleInput& input) {
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

  std::shared_ptr<simulation::Factory> factory_;
  WheelGeometry wheels_;
  Duration step_;
  std::vector<PointCloud<Lidar>> clouds_;
  std::vector<std::int64_t> firings_us_;
  std::vector<LaserScan> scans_;
  std::vector<Decoding> lidars_;
  control::wire::FrameCutter cutter_;
  std::uint16_t sequence_ = 0;
};

}  // namespace madori::test
