#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace madori::bench {

/// A line for each amplitude and sensor, from the figures of drive_bent_building().
void print_bent(const std::vector<nlohmann::json>& trials);
/// `amplitude_m,sensor,seed,time_s,said,error_m,error_deg,state`, a line a sample: what plot_reliability.py
/// reads.
[[nodiscard]] std::string samples_csv(const std::vector<nlohmann::json>& trials);

}  // namespace madori::bench
