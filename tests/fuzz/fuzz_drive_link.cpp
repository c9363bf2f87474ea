// Both directions of the drive link, and the controller that listens: it never drives on garbage.
#include <cstdlib>

#include "control/diff_drive/odometry.hpp"
#include "control/drive_link/controller.hpp"

using namespace madori;

namespace {

void require(bool good) {
  if (!good) std::abort();
}

template <class Message>
void check(const control::wire::FrameCutter& cutter, Message& message) {
  using namespace control::wire;
  if (decode(cutter.frame(), cutter.size(), message) != Verdict::Good) return;
  std::uint8_t again[kMaxFrame];
  const std::size_t size = encode(message, again);
  Message twice;
  require(decode(again, size - 1, twice) == Verdict::Good && twice.sequence == message.sequence);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace control::wire;
  FrameCutter cutter;
  Controller controller;
  control::DiffDriveOdometry odometry({});
  std::uint32_t now_us = 0;
  for (std::size_t i = 0; i < size; ++i) {
    controller.receive(data[i], now_us += 87);
    if (i % 16 == 0) controller.tick({.emergency_stop = (data[i] & 0xC0) == 0xC0}, now_us);
    require(controller.state() == DriveState::Running || controller.left_uradps() == 0);
    if (!cutter.push(data[i])) continue;
    Command command;
    check(cutter, command);
    Status status;
    check(cutter, status);
    odometry.update(status, {});
    require(odometry.reading().odom_from_base.is_finite());
  }
  return 0;
}
