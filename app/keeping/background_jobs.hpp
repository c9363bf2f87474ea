#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace madori::app {

/// Work that must not hold up the cycle (writing and syncing files), on a thread of its own. Of one kind only
/// the newest waits: a slow disk skips, it does not queue up.
class BackgroundJobs {
 public:
  BackgroundJobs();
  /// Does what still waits.
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  void put(const std::string& kind, std::function<void()> job);
  /// Returns when everything put so far is done.
  void wait();
  /// What the last job of a kind threw, of the kinds whose last job failed; empty where all went well.
  [[nodiscard]] std::string problem() const;

 private:
  void run(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::string, std::function<void()>> waiting_;
  bool busy_ = false;
  std::map<std::string, std::string> problems_;  ///< by kind
  std::jthread thread_;
};

}  // namespace madori::app
