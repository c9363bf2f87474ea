#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/stamp.hpp"

struct sqlite3;

namespace madori::app {

/// What a vehicle did over a while; adds up.
struct Work {
  double distance_m = 0.0;
  double driving_s = 0.0;
  double standing_s = 0.0;  ///< while it should have driven, or was stopped
  struct Stood {
    std::int64_t count = 0;
    double seconds = 0.0;
  };
  std::map<std::string, Stood> causes;  ///< by code

  void add(const Work& other);
};

/// The sums of a site, kept in madori.db. Throws Error where the database cannot be used.
class StatisticsStore {
 public:
  explicit StatisticsStore(const std::filesystem::path& file);
  ~StatisticsStore();
  StatisticsStore(const StatisticsStore&) = delete;
  StatisticsStore& operator=(const StatisticsStore&) = delete;

  void add(const Work& work, Stamp now);
  [[nodiscard]] Work sums() const;
  /// When the first work was added.
  [[nodiscard]] std::optional<Stamp> since() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace madori::app
