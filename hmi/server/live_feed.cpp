#include "hmi/server/live_feed.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "core/clock.hpp"
#include "hmi/server/wire.hpp"

namespace madori::hmi {
namespace {

constexpr std::chrono::milliseconds kFresh{50};
constexpr std::array kEditable{"drawing", "scale", "walls", "routes", "vehicle"};

}  // namespace

void LiveFeed::refresh(std::chrono::steady_clock::time_point now) {
  if (made_ && now - *made_ < kFresh) return;
  made_ = now;
  const LiveState live = vehicle_.live();
  nlohmann::json wire = to_wire(live, clock_now());
  wire["locked"] = to_wire(vehicle_.may_change_site().reason);
  wire["revisions"] = editor_.revisions();
  live_ = dump(wire);
  live_.pop_back();
  scan_ = live.scan;
  replay_.add(now, live_ + R"(,"editors":[]})", scan_);
}

std::string LiveFeed::message(const void* who, const std::optional<Notice>& refused) const {
  std::set<std::string> others;
  for (const auto& [panel, what] : editing_)
    if (panel != who) others.insert(what);
  std::string text = R"({"live":)" + live_ + R"(,"editors":)" + nlohmann::json(others).dump() + "}";
  if (refused) text += R"(,"refused":)" + dump(to_wire(*refused));
  return text + "}";
}

bool LiveFeed::edits(const void* who, const std::string& what) {
  if (what.empty()) {
    left(who);
    return true;
  }
  if (std::ranges::find(kEditable, what) == kEditable.end()) return false;
  editing_[who] = what;
  return true;
}

}  // namespace madori::hmi
