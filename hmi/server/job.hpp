#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>

namespace madori::hmi {

/// Long work, one at a time, on a thread of its own; the panel asks how far it is.
class Job {
 public:
  /// Called with the stage that begins and the share done, 0..1.
  using Progress = std::function<void(const std::string& stage, double share)>;
  /// Returns a summary in words; throws on failure.
  using Work = std::function<std::string(const Progress&)>;

  Job() = default;
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// False while another one runs.
  bool start(const std::string& kind, Work work);
  /// Job of hmi/schema.
  [[nodiscard]] nlohmann::json state() const;

 private:
  void run(const Work& work);

  mutable std::mutex mutex_;
  std::thread thread_;
  bool running_ = false;
  std::string kind_, stage_, error_, summary_;
  double share_ = 0.0;
};

}  // namespace madori::hmi
