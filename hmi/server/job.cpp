#include "hmi/server/job.hpp"

#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

namespace madori::hmi {

Job::~Job() {
  if (thread_.joinable()) thread_.join();
}

bool Job::start(const std::string& kind, Work work) {
  const std::scoped_lock lock(mutex_);
  if (running_) return false;
  if (thread_.joinable()) thread_.join();
  running_ = true;
  kind_ = kind;
  stage_ = error_ = summary_ = "";
  share_ = 0.0;
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
  return true;
}

void Job::run(const Work& work) {
  std::string summary;
  std::string error;
  try {
    summary = work([this](const std::string& stage, double share) {
      const std::scoped_lock lock(mutex_);
      stage_ = stage;
      share_ = share;
    });
  } catch (const std::exception& e) {
    error = e.what();
  }
  const std::scoped_lock lock(mutex_);
  summary_ = std::move(summary);
  error_ = std::move(error);
  share_ = 1.0;
  running_ = false;
}

nlohmann::json Job::state() const {
  const std::scoped_lock lock(mutex_);
  return {{"kind", kind_},   {"running", running_}, {"stage", stage_},
          {"share", share_}, {"error", error_},     {"summary", summary_}};
}

}  // namespace madori::hmi
