#include "tests/bench/buildings/bent_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace madori::bench {
namespace {

using nlohmann::json;

struct Group {
  int drives = 0, failed = 0;
  double driven_m = 0.0, cpu_s = 0.0, wrongly_sure_s = 0.0;
  std::map<std::string, double> seconds;
  std::vector<double> ends_m, errors_m;

  [[nodiscard]] double percent(const std::string& state) const {
    double sum = 0.0;
    for (const auto& [name, s] : seconds) sum += s;
    const auto found = seconds.find(state);
    return sum > 0.0 && found != seconds.end() ? 100.0 * found->second / sum : 0.0;
  }
};

std::string quantiles(std::vector<double> values) {
  if (values.empty()) return "-";
  std::sort(values.begin(), values.end());
  return fmt::format("{:.3f}/{:.3f}", values[values.size() / 2], values[values.size() * 95 / 100]);
}

void add(Group& group, const json& trial) {
  ++group.drives;
  group.driven_m += trial["driven_m"].get<double>();
  group.cpu_s += trial["cpu_s"].get<double>();
  group.wrongly_sure_s += trial["wrongly_sure_s"].get<double>();
  for (const auto& [state, s] : trial["seconds"].items()) group.seconds[state] += s.get<double>();
  for (const json& sample : trial["samples"]) group.errors_m.push_back(sample[2].get<double>());
  if (trial["first_place_s"].is_null()) ++group.failed;
  if (!trial["end_m"].is_null()) group.ends_m.push_back(trial["end_m"].get<double>());
}

}  // namespace

void print_bent(const std::vector<json>& trials) {
  std::map<std::pair<double, std::string>, Group> groups;
  for (const json& trial : trials)
    if (trial.value("error", "").empty())
      add(groups[{trial["amplitude_m"].get<double>(), trial["sensor"].get<std::string>()}], trial);
  fmt::print("{:>5} {:>6} {:>6} {:>5} {:>6} {:>5} {:>5} {:>5} {:>5} {:>6} {:>13} {:>13} {:>6}\n", "bend",
             "sensor", "drives", "never", "km", "LOC", "DEG", "AMB", "LOST", "sure_s", "error", "end",
             "cpu_s");
  for (const auto& [key, g] : groups)
    fmt::print(
        "{:5.1f} {:>6} {:6} {:5} {:6.2f} {:5.1f} {:5.1f} {:5.1f} {:5.1f} {:6.1f} {:>13} {:>13} {:6.0f}\n",
        key.first, key.second, g.drives, g.failed, 1e-3 * g.driven_m, g.percent("LOCALIZED"),
        g.percent("DEGRADED"), g.percent("AMBIGUOUS"), g.percent("LOST"), g.wrongly_sure_s,
        quantiles(g.errors_m), quantiles(g.ends_m), g.cpu_s);
  fmt::print(
      "bend: metres; never: drives that never found a place; LOC..LOST: % of the time from the first place "
      "on;\n"
      "sure_s: seconds LOCALIZED, more than 1 m off; error, end: on the drawing, against the known warp, "
      "metres,\n"
      "median/p95 over the samples of all drives, and over the drives' last 10 m (their median each).\n");
}

std::string samples_csv(const std::vector<json>& trials) {
  std::string text = "amplitude_m,sensor,seed,time_s,said,error_m,error_deg,state\n";
  for (const json& trial : trials) {
    if (!trial.value("error", "").empty()) continue;
    for (const json& s : trial["samples"])
      text +=
          fmt::format("{},{},{},{:.1f},{:.4f},{:.3f},{:.2f},{}\n", trial["amplitude_m"].get<double>(),
                      trial["sensor"].get<std::string>(), trial["seed"].get<int>(), s[0].get<double>(),
                      s[1].get<double>(), s[2].get<double>(), s[3].get<double>(), s[4].get<std::string>());
  }
  return text;
}

}  // namespace madori::bench
