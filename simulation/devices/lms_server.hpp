#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensors/lms1xx/cola.hpp"

namespace madori::simulation {

/// The LMS1xx's half of CoLa for one client: answers, and knows whether scans were asked for.
class LmsDialogue {
 public:
  explicit LmsDialogue(sensors::lms1xx::Dialect dialect) : dialect_(dialect), splitter_(dialect) {}

  /// Bytes from the client; returns the answers, ready for the wire. `newest`: the telegram of the newest
  /// scan, which is what a client gets that asks for one.
  [[nodiscard]] std::vector<std::uint8_t> receive(std::span<const std::uint8_t> bytes,
                                                  std::span<const std::uint8_t> newest = {});
  /// True after `sEN LMDscandata 1`, as long as the device measures.
  [[nodiscard]] bool wants_scans() const { return subscribed_ && measuring_; }

 private:
  [[nodiscard]] std::vector<std::uint8_t> answer(const sensors::lms1xx::Head& head,
                                                 std::span<const std::uint8_t> newest);

  sensors::lms1xx::Dialect dialect_;
  sensors::lms1xx::Splitter splitter_;
  bool logged_in_ = false;
  bool measuring_ = true;
  bool subscribed_ = false;
};

}  // namespace madori::simulation
