#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "hmi/server/vehicle.hpp"

namespace madori::hmi {

/// Long work, one at a time, on a thread of its own; the panel asks how far it is.
class Job {
 public:
  /// Called with the stage that begins and the share done, 0..1. Throws where the job was cancelled.
  using Progress = std::function<void(const std::string& stage, double share)>;
  struct Outcome {
    std::string summary;    ///< in words
    nlohmann::json report;  ///< ImportSummary of an import, else null
  };
  /// A failure of a kind that panels know.
  struct Failed : std::runtime_error {
    Failed(std::string known_as, const std::string& reason)
        : std::runtime_error(reason), kind(std::move(known_as)) {}
    std::string kind;
  };
  /// Throws on failure.
  using Work = std::function<Outcome(const Progress&)>;

  Job() = default;
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// False while another one runs.
  bool start(const std::string& kind, Work work);
  /// The running job ends at its next progress; nothing of the site has changed then.
  void cancel();
  /// Job of hmi/schema.
  [[nodiscard]] nlohmann::json state() const;

 private:
  void run(const Work& work);

  mutable std::mutex mutex_;
  std::thread thread_;
  bool running_ = false;
  bool cancelled_ = false;
  std::string kind_, stage_;
  Notice error_;
  Outcome outcome_;
  double share_ = 0.0;
};

}  // namespace madori::hmi
