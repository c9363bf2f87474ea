#include "hmi/server/job.hpp"

#include <exception>
#include <utility>

#include "core/failure_words.hpp"
#include "hmi/server/wire.hpp"

namespace madori::hmi {
namespace {

struct Cancelled : std::exception {};

}  // namespace

Job::~Job() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

bool Job::start(const std::string& kind, Work work) {
  const std::scoped_lock lock(mutex_);
  if (running_) return false;
  if (thread_.joinable()) thread_.join();
  running_ = true;
  cancelled_ = false;
  kind_ = kind;
  stage_ = "";
  error_ = {};
  outcome_ = {};
  share_ = 0.0;
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
  return true;
}

void Job::cancel() {
  const std::scoped_lock lock(mutex_);
  cancelled_ = true;
}

void Job::run(const Work& work) {
  Outcome outcome;
  Notice error;
  try {
    outcome = work([this](const std::string& stage, double share) {
      const std::scoped_lock lock(mutex_);
      if (cancelled_) throw Cancelled();
      stage_ = stage;
      share_ = share;
    });
  } catch (const Cancelled&) {
    error = {"cancelled", {}, "cancelled; nothing has changed"};
  } catch (const Failed& e) {
    error = {"job-failed", {{"reason", e.what()}, {"kind", e.kind}}, e.what()};
  } catch (const std::exception& e) {
    const std::string reason = failure_words(e);
    error = {"job-failed", {{"reason", reason}}, reason};
  }
  const std::scoped_lock lock(mutex_);
  outcome_ = std::move(outcome);
  error_ = std::move(error);
  share_ = 1.0;
  running_ = false;
}

nlohmann::json Job::state() const {
  const std::scoped_lock lock(mutex_);
  return {{"kind", kind_},
          {"running", running_},
          {"stage", stage_},
          {"share", share_},
          {"error", to_wire(error_)},
          {"summary", outcome_.summary},
          {"report", outcome_.report}};
}

}  // namespace madori::hmi
