#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/stamp.hpp"

namespace madori::io {

/// What a byte pipe tells its owner, always from the pipe's own thread. The callbacks must not throw or
/// block.
struct LinkEvents {
  std::function<void()> opened;
  std::function<void(std::span<const std::uint8_t> bytes, Stamp received)> bytes;
  std::function<void(const std::string& reason)>
      closed;  ///< also when opening failed; it is tried again by itself
};

}  // namespace madori::io
