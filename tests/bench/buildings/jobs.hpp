#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace madori::bench {

/// Work that ends in figures.
struct Job {
  std::string name;
  std::function<nlohmann::json()> work;
};

/// Does every job in a process of its own, `at_once` of them at a time, and hands out each one's figures as
/// it ends. One that throws, or whose process dies, hands out {name, error}.
void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<void(const nlohmann::json&)>& done);

}  // namespace madori::bench
