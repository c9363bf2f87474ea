#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "localization/memory/local_map.hpp"

namespace madori::localization {

/// What a memory matches scans against, made of it when asked, and the room to make it and to remember more.
/// No part of what is remembered: who copies a memory gets room of his own.
struct MatchRoom {
  MatchRoom() = default;
  MatchRoom(const MatchRoom& /*other*/) {}
  MatchRoom& operator=(const MatchRoom& /*other*/) {
    has_recent = false;
    return *this;
  }
  MatchRoom(MatchRoom&&) = default;
  MatchRoom& operator=(MatchRoom&&) = default;
  ~MatchRoom() = default;

  LocalMap recent;  ///< surfaces of the last question, until the memory changes
  bool has_recent = false;
  Point2<Map> recent_centre;
  LocalMap whole;
  std::vector<LocalMap::Piece> pieces;
  std::vector<std::pair<double, std::size_t>> near;  ///< distance and number of keyframes
  std::vector<std::shared_ptr<SurfaceScan>> spare;   ///< for keyframes to come
};

}  // namespace madori::localization
