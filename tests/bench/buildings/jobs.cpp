#include "tests/bench/buildings/jobs.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <map>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::bench {
namespace {

nlohmann::json failure(const std::string& name, const std::string& why) {
  return {{"name", name}, {"error", why}};
}

/// The child's part: nothing of the parent is cleaned up here.
[[noreturn]] void work_and_leave(const Job& job, const std::filesystem::path& result) {
  nlohmann::json figures;
  try {
    figures = job.work();
  } catch (const std::exception& e) {
    figures = failure(job.name, e.what());
  }
  std::ofstream(result) << figures;
  std::fflush(nullptr);
  ::_exit(0);
}

nlohmann::json figures_of(const Job& job, const std::filesystem::path& result) {
  std::ifstream file(result);
  auto figures = nlohmann::json::parse(file, nullptr, false);
  return figures.is_discarded() ? failure(job.name, "its process died") : figures;
}

}  // namespace

void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<void(const nlohmann::json&)>& done) {
  const test::TemporaryFolder folder;
  std::map<pid_t, std::size_t> running;
  const auto file = [&](std::size_t job) { return folder.path() / std::to_string(job); };
  for (std::size_t next = 0; next < jobs.size() || !running.empty();) {
    if (next < jobs.size() && running.size() < static_cast<std::size_t>(at_once)) {
      std::fflush(nullptr);  // what is buffered shall not be written by the child as well
      const pid_t child = ::fork();
      if (child < 0) throw Error("fork", "no process can be started", "");
      if (child == 0) work_and_leave(jobs[next], file(next));
      running[child] = next++;
      continue;
    }
    const pid_t ended = ::wait(nullptr);
    const auto found = running.find(ended);
    if (found == running.end()) continue;
    done(figures_of(jobs[found->second], file(found->second)));
    running.erase(found);
  }
}

}  // namespace madori::bench
