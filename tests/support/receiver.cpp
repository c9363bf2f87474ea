#include "tests/support/receiver.hpp"

#include <utility>

namespace madori::test {
namespace {

namespace lms1xx = sensors::lms1xx;
namespace s300 = sensors::s300;
namespace wire = control::wire;

control::OdometryOptions odometry_options(const WheelGeometry& wheels) {
  control::OdometryOptions options;
  options.wheels = wheels;
  return options;
}

}  // namespace

Receiver::Receiver(const WheelGeometry& wheels, bool binary_lms)
    : dialect_(binary_lms ? lms1xx::Dialect::B : lms1xx::Dialect::A),
      vlp16_([this](sensors::vlp16::Frame& frame) { clouds.push_back(std::move(frame.cloud)); }),
      lms_(dialect_),
      s300_([this](const s300::Telegram& telegram) {
        if (telegram.content != s300::Content::Distances) return;
        fields_ = s300::fields_of(telegram);
        LaserScan scan = s300::to_laser_scan(telegram);
        scan.stamp = s300_clock_.stamp_of(telegram, s300_received_);
        s300_scans.push_back(std::move(scan));
      }),
      odometry_(odometry_options(wheels)) {}

void Receiver::push(const simulation::DevicePacket& packet) {
  switch (packet.device) {
    case simulation::Device::Vlp16:
      vlp16_.push(packet.bytes, packet.sent);
      break;
    case simulation::Device::Lms1xx:
      take_lms(packet);
      break;
    case simulation::Device::S300:
      s300_received_ = packet.sent;
      s300_.push(packet.bytes);
      break;
    case simulation::Device::Drive:
      take_drive(packet);
      break;
  }
}

void Receiver::take_lms(const simulation::DevicePacket& packet) {
  lms_.push(packet.bytes);
  while (const auto payload = lms_.next()) {
    const auto head = lms1xx::head_of(*payload);
    if (!head || head->name != "LMDscandata" || head->kind != "sSN") continue;
    const auto data = lms1xx::decode_scan(dialect_, *payload);
    if (!data) continue;
    auto scan = lms1xx::to_laser_scan(data.value());
    if (!scan) continue;
    LaserScan taken = std::move(scan).value();
    // 15 ms of turning lie between the first beam and the telegram.
    taken.stamp = lms_clock_.stamp_of(data.value(), packet.sent);
    lms_scans.push_back(std::move(taken));
  }
}

void Receiver::take_drive(const simulation::DevicePacket& packet) {
  for (const std::uint8_t byte : packet.bytes) {
    if (!cutter_.push(byte)) continue;
    wire::Status status;
    if (wire::decode(cutter_.frame(), cutter_.size(), status) != wire::Verdict::Good) {
      ++damaged_status_;
      continue;
    }
    status_ = status;
    const auto verdict = odometry_.update(status, packet.sent);
    if (verdict == control::OdometryVerdict::First || verdict == control::OdometryVerdict::Moved)
      odometry.push_back(odometry_.reading());
  }
}

}  // namespace madori::test
