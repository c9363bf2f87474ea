#include "simulation/mailbox.hpp"

#include <algorithm>
#include <utility>

#include "simulation/random.hpp"

namespace madori::simulation {
namespace {

constexpr std::uint64_t kStream = 0xFA17;

void change_byte(std::vector<std::uint8_t>& bytes, Random& random) {
  const std::size_t at = random.below(bytes.size());
  bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U + random.below(255)));
}

/// Where the checksum lies: the last byte, or before the drive frame's closing zero. Never makes a zero,
/// which would end a drive frame early.
void spoil_checksum(Device device, std::vector<std::uint8_t>& bytes) {
  std::uint8_t& byte = bytes[bytes.size() - (device == Device::Drive ? 2 : 1)];
  byte = static_cast<std::uint8_t>(byte == 0x10 ? 0x30 : byte ^ 0x10);
}

}  // namespace

void Mailbox::add_fault(const FaultSpec& fault, double now_s) {
  std::erase_if(faults_, [&](const FaultSpec& f) { return f.at_s + f.for_s < now_s; });
  faults_.push_back(fault);
}

const FaultSpec* Mailbox::active(FaultKind kind, Device device, double now_s) const {
  for (const FaultSpec& f : faults_)
    if (f.kind == kind && f.device == device && now_s >= f.at_s && now_s < f.at_s + f.for_s) return &f;
  return nullptr;
}

/// False when the packet is lost.
bool Mailbox::damage(Device device, std::vector<std::uint8_t>& bytes, double now_s,
                     std::uint64_t number) const {
  if (active(FaultKind::Silence, device, now_s) != nullptr) return false;
  Random random(seed_, kStream + static_cast<std::uint64_t>(device), number);
  const auto strikes = [&](FaultKind kind) {
    const double chance = random.uniform();
    const FaultSpec* fault = active(kind, device, now_s);
    return fault != nullptr && chance < fault->share;
  };
  if (strikes(FaultKind::Drop)) return false;
  if (strikes(FaultKind::Corrupt)) change_byte(bytes, random);
  if (strikes(FaultKind::Checksum)) spoil_checksum(device, bytes);
  return true;
}

void Mailbox::send(Device device, std::vector<std::uint8_t> bytes, Duration now, std::size_t unit) {
  const double now_s = to_seconds(now);
  const std::uint64_t number = sent_[static_cast<std::size_t>(device)]++;
  if (!damage(device, bytes, now_s, number)) return;
  Pending pending{now, device, std::move(bytes), unit};
  if (const FaultSpec* delay = active(FaultKind::Delay, device, now_s))
    pending.due += duration_from_seconds(delay->delay_s);
  const FaultSpec* twice = active(FaultKind::Duplicate, device, now_s);
  Random random(seed_, ~kStream + static_cast<std::uint64_t>(device), number);
  if (twice != nullptr && random.uniform() < twice->share) pending_.push_back(pending);
  pending_.push_back(std::move(pending));
}

std::vector<DevicePacket> Mailbox::take(Duration now, Stamp epoch) {
  std::stable_sort(pending_.begin(), pending_.end(),
                   [](const Pending& a, const Pending& b) { return a.due < b.due; });
  const auto first_later =
      std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.due > now; });
  std::vector<DevicePacket> arrived;
  arrived.reserve(static_cast<std::size_t>(first_later - pending_.begin()));
  for (auto p = pending_.begin(); p != first_later; ++p)
    arrived.push_back({p->device, epoch + p->due, std::move(p->bytes), p->unit});
  pending_.erase(pending_.begin(), first_later);
  return arrived;
}

}  // namespace madori::simulation
