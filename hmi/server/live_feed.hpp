#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hmi/server/replay.hpp"
#include "hmi/server/site_editor.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::hmi {

/// What every live socket sends, worked out once for all of them, and who edits what. Only the sockets'
/// thread may use it.
class LiveFeed {
 public:
  LiveFeed(Vehicle& vehicle, const SiteEditor& editor, Replay& replay)
      : vehicle_(vehicle), editor_(editor), replay_(replay) {}

  /// Works the newest state out again where the last one is older than 50 ms, and keeps it for the replay.
  void refresh(std::chrono::steady_clock::time_point now);
  /// LiveMessage of hmi/schema for the panel `who`.
  [[nodiscard]] std::string message(const void* who, const std::optional<Notice>& refused) const;
  /// The newest scan as a frame; null before the first.
  [[nodiscard]] const std::shared_ptr<const std::string>& scan() const { return scan_; }

  /// Panel `who` edits `what` (drawing, scale, walls, routes or vehicle); an empty one has finished. False
  /// for anything else.
  bool edits(const void* who, const std::string& what);
  void left(const void* who) { editing_.erase(who); }

 private:
  Vehicle& vehicle_;
  const SiteEditor& editor_;
  Replay& replay_;
  std::optional<std::chrono::steady_clock::time_point> made_;
  std::string live_;  ///< a Live without its editors and its closing brace
  std::shared_ptr<const std::string> scan_;
  std::map<const void*, std::string> editing_;
};

}  // namespace madori::hmi
