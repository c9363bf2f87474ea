#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "control/drive_link/wire.hpp"

namespace madori::app {

/// A fault bit of the drive's status, for people; panels know it by its code.
struct DriveFault {
  control::wire::Fault bit;
  const char* code;
  const char* english;
};
inline constexpr std::array kDriveFaults{
    DriveFault{control::wire::kLeftEncoder, "left-encoder", "left wheel's encoder"},
    DriveFault{control::wire::kRightEncoder, "right-encoder", "right wheel's encoder"},
    DriveFault{control::wire::kLeftMotor, "left-motor", "left motor"},
    DriveFault{control::wire::kRightMotor, "right-motor", "right motor"},
    DriveFault{control::wire::kUndervoltage, "undervoltage", "voltage too low"},
    DriveFault{control::wire::kOvertemperature, "overtemperature", "too hot"},
    DriveFault{control::wire::kInternal, "internal", "controller"},
};

/// "16 (voltage too low)": the number for a service manual, and what it means.
[[nodiscard]] inline std::string fault_words(std::uint16_t faults) {
  std::string words;
  for (const auto& fault : kDriveFaults)
    if ((faults & fault.bit) != 0) words += (words.empty() ? " (" : ", ") + std::string(fault.english);
  return std::to_string(faults) + words + (words.empty() ? "" : ")");
}

/// The codes of what fault_words() says, joined by '+'; empty where it names none.
[[nodiscard]] inline std::string fault_codes(std::string_view words) {
  std::uint16_t faults = 0;
  (void)std::from_chars(words.data(), words.data() + words.size(), faults);
  std::string codes;
  for (const auto& fault : kDriveFaults)
    if ((faults & fault.bit) != 0) codes += (codes.empty() ? "" : "+") + std::string(fault.code);
  return codes;
}

}  // namespace madori::app
