#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cycle/site_config.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/runner/transport_run.hpp"
#include "localization/ndt_map/map_learner.hpp"
#include "tests/end_to_end/soak/map_truth.hpp"
#include "tests/end_to_end/soak/plan.hpp"
#include "tests/end_to_end/soak/surprises.hpp"
#include "tests/end_to_end/soak/witness.hpp"

namespace madori::soak {

struct DayOptions {
  std::filesystem::path site;    ///< walls, vehicle, sensors
  std::filesystem::path routes;  ///< folder of path.csv and tree.csv; empty: those of the site
  std::filesystem::path scenario;
  std::filesystem::path database;  ///< folder of madori.db, kept from day to day
  double limit_s = 900.0;          ///< for one order
  std::filesystem::path
      living_map;  ///< folder in which the living map is kept from day to day; empty: none is made
  std::filesystem::path memory;  ///< folder in which the vehicle's memory goes on likewise; empty: forgotten
  bool verbose = false;
  std::pair<double, double> trace_s;  ///< every revolution between these times is told of; none by default
};

/// One day in the virtual factory, lock-step: the program is started in the morning, gets its orders one
/// after the other, and an operator who does nothing but what the table of states demands.
class WorkingDay {
 public:
  /// Throws Error where site, routes or scenario cannot be used.
  WorkingDay(const DayOptions& options, const Wishes& wishes, int number);
  WorkingDay(const WorkingDay&) = delete;
  WorkingDay& operator=(const WorkingDay&) = delete;

  /// Ends early, after a whole delivery, once `stop` is set.
  Figures work(const std::atomic<bool>& stop);

 private:
  void deliver(const Delivery& delivery);
  /// True when the order has ended, one way or the other.
  bool follow(const Delivery& delivery, std::int64_t order, Stamp began);
  void befall(const Delivery& delivery, Stamp began);
  void tick();
  void wait(double seconds);
  void look_after(const Delivery& delivery);
  void tell_place();
  void look_at_stop(const Delivery& delivery);
  /// The field is cleared where something was put into it, else the vehicle driven back out of it.
  void free_field(const Delivery& delivery, const std::string& because);
  void drive_back(const Delivery& delivery);
  void help(const Delivery& delivery, const std::string& reason, bool every_way_blocked);
  void note_delivered(const Delivery& delivery, Stamp began);
  void watch_map(app::LocalizerPoseOptions& options);
  void end_map();
  void note_undelivered(const Delivery& delivery, std::int64_t order, const std::string& why);

  DayOptions options_;
  Wishes wishes_;
  app::SiteForDriving loaded_;
  Day plan_;
  Figures figures_;
  std::shared_ptr<simulation::Factory> factory_;
  std::unique_ptr<app::TransportRun> run_;
  std::unique_ptr<app::OrderStore> orders_;  ///< as the panel has them
  std::unique_ptr<Surprises> surprises_;
  std::unique_ptr<Witness> witness_;
  std::unique_ptr<localization::MapLearner> map_learner_;
  std::unique_ptr<MapTruth> map_truth_;
  double map_cpu_s_ = 0.0;
  simulation::Random chance_;
  bool kidnapping_due_ = false, pallet_due_ = false, person_due_ = false;
  bool carried_ = false;  ///< by people, who know, in this delivery
  std::string stands_because_;
  Stamp stands_since_{};
  std::optional<std::pair<Stamp, Transform2<Map, Base>>> by_hand_;  ///< since when and from where
  bool pressed_ = false;     ///< the bumper was, in this emergency stop
  bool told_place_ = false;  ///< in this standstill
  std::uint64_t ticks_ = 0;
};

}  // namespace madori::soak
