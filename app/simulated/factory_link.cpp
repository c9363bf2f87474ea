#include "app/simulated/factory_link.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "control/diff_drive/kinematics.hpp"

namespace madori::app {

FactoryLink::FactoryLink(std::shared_ptr<simulation::Factory> factory, const WheelGeometry& wheels,
                         Duration step)
    : factory_(std::move(factory)),
      wheels_(wheels),
      step_(step),
      scanner_([this](const sensors::s300::Telegram& telegram) {
        if (telegram.content == sensors::s300::Content::Distances)
          field_interrupted_ = sensors::s300::fields_of(telegram).must_stop();
      }),
      assembler_([this](sensors::vlp16::Frame& frame) {
        clouds_.push_back(std::move(frame.cloud));
        firings_us_.push_back(frame.first_firing_us);
      }) {}

void FactoryLink::collect(CycleInput& input) {
  factory_->step(step_);
  for (const auto& packet : factory_->take_packets()) take(packet, input);
  input.clouds = std::exchange(clouds_, {});
  input.protective_stop = field_interrupted_;
  input.firings_us = std::exchange(firings_us_, {});
}

void FactoryLink::take(const simulation::DevicePacket& packet, CycleInput& input) {
  if (packet.device == simulation::Device::Vlp16) {
    assembler_.push(packet.bytes, packet.sent);
    input.packets.push_back({packet.sent, packet.bytes});
  }
  if (packet.device == simulation::Device::S300) scanner_.push(packet.bytes);
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
