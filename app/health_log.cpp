#include "app/health_log.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

namespace madori::app {
namespace {

std::string state_line(const PoseEstimate& e) {
  std::array<char, 32> stamp{};
  std::snprintf(stamp.data(), stamp.size(), "%.6f", to_seconds(e.stamp));
  return std::string(stamp.data()) + "," + to_string(e.health.state) + ",\"" + e.health.reason + "\"\n";
}

}  // namespace

void HealthLog::add(const PoseEstimate& estimate) {
  if (started_ && estimate.stamp > last_.stamp) {  // the state lasted until now
    seconds_[static_cast<std::size_t>(last_.health.state)] += to_seconds(estimate.stamp - last_.stamp);
  }
  csv_ += state_line(estimate);
  if (!started_ || estimate.stamp >= last_.stamp) {
    last_ = estimate;
  }
  started_ = true;
}

double HealthLog::share(LocalizationState state) const {
  const double all = std::accumulate(seconds_.begin(), seconds_.end(), 0.0);
  return all > 0.0 ? seconds_[static_cast<std::size_t>(state)] / all : 0.0;
}

nlohmann::json HealthLog::json() const {
  nlohmann::json result = {{"last", to_string(last_.health.state)}, {"reason", last_.health.reason}};
  for (const LocalizationState state : kLocalizationStates) {
    result["share"][to_string(state)] = share(state);
  }
  return result;
}

std::string HealthLog::summary() const {
  std::string text = std::string("ends ") + to_string(last_.health.state);
  if (!last_.health.reason.empty()) text += " (" + last_.health.reason + ")";
  text += ";";
  for (const LocalizationState state : kLocalizationStates) {
    std::array<char, 64> part{};
    std::snprintf(part.data(), part.size(), " %s %.1f %%", to_string(state), 100.0 * share(state));
    text += part.data();
  }
  return text;
}

}  // namespace madori::app
