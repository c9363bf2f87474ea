#include "hmi/server/replay.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "hmi/server/scan_frame.hpp"

namespace madori::hmi {
namespace {

void append(std::string& out, const std::string& part) {
  const auto size = static_cast<std::uint32_t>(part.size());
  std::array<char, sizeof size> head{};
  std::memcpy(head.data(), &size, sizeof size);
  out.append(head.data(), head.size());
  out += part;
}

}  // namespace

void Replay::add(std::chrono::steady_clock::time_point now, const std::string& live,
                 const std::shared_ptr<const std::string>& scan) {
  const std::scoped_lock lock(mutex_);
  if (!moments_.empty() && now - moments_.back().when < kPeriod) return;
  moments_.push_back({now, live, scan ? thinned_scan_frame(*scan, kMostPoints) : std::string()});
  while (now - moments_.front().when > kLength) moments_.pop_front();
}

std::string Replay::bytes() const {
  const std::scoped_lock lock(mutex_);
  std::string all;
  for (const auto& moment : moments_) {
    append(all, moment.live);
    append(all, moment.scan);
  }
  return all;
}

}  // namespace madori::hmi
