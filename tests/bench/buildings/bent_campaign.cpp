#include "tests/bench/buildings/bent_campaign.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/buildings/bent_report.hpp"
#include "tests/bench/buildings/jobs.hpp"

namespace madori::bench {
namespace {

std::vector<Job> jobs_of(const BentCampaign& campaign) {
  std::vector<Job> jobs;
  for (int i = 0; i < campaign.count; ++i)
    for (const double amplitude_m : campaign.amplitudes_m)
      for (const auto& sensor : campaign.sensors) {
        BentTrialOptions trial = campaign.trial;
        trial.seed = campaign.first_seed + static_cast<std::uint32_t>(i);
        trial.amplitude_m = amplitude_m;
        trial.sensor = sensor;
        jobs.push_back({fmt::format("seed {} bent {} m, {}", trial.seed, amplitude_m, sensor),
                        [trial] { return drive_bent_building(trial); }});
      }
  return jobs;
}

}  // namespace

int drive_bent_buildings(const BentCampaign& campaign, int jobs, const std::filesystem::path& json_file) {
  std::vector<nlohmann::json> trials;
  int failed = 0;
  run_jobs(jobs_of(campaign), jobs, [&](const nlohmann::json& trial) {
    if (const std::string error = trial.value("error", ""); !error.empty()) {
      fmt::print(stderr, "{}: {}\n", trial["name"].get<std::string>(), error);
      ++failed;
    }
    trials.push_back(trial);
  });
  print_bent(trials);
  if (!campaign.samples_file.empty()) std::ofstream(campaign.samples_file) << samples_csv(trials);
  for (auto& trial : trials) trial.erase("samples");
  if (!json_file.empty()) std::ofstream(json_file) << nlohmann::json(trials).dump(1) << '\n';
  return failed > 0 ? 1 : 0;
}

}  // namespace madori::bench
