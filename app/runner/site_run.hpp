#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/braking/braking_verdict.hpp"
#include "app/cycle/site_config.hpp"
#include "app/keeping/site_keeper.hpp"
#include "app/learned/wall_watch.hpp"
#include "app/mapping_drive/drive_site.hpp"
#include "app/mounting/mounting_run.hpp"
#include "app/runner/transport_run.hpp"

namespace madori::app {

/// The vehicle of a site from an empty folder on. While something is missing it only listens to the devices;
/// once the site can be driven it runs it (TransportRun), and anew after every change of the site, as soon as
/// the vehicle stands: no restart. A new run begins paused. What driving teaches of the drawing, and the last
/// pose, are kept with the site (SiteKeeper). Without a drawing the run is a drive by hand that makes a map.
class SiteRun {
 public:
  struct Hooks {
    std::function<void(TransportRun&)> opened;    ///< a run is about to begin
    std::function<void()> closing;                ///< the run is about to end
    std::function<void(const CycleInput&)> idle;  ///< a tick without a run: what the devices say
    /// A site that cannot be driven yet was read, and these are its sensors.
    std::function<void(const std::vector<mapping::SensorRecord>&)> looked = nullptr;
  };

  SiteRun(std::filesystem::path site, std::unique_ptr<VehicleLink> link, Hooks hooks);
  /// Waits for a site that is being loaded.
  ~SiteRun();
  SiteRun(const SiteRun&) = delete;
  SiteRun& operator=(const SiteRun&) = delete;

  /// Loads the site at once. Throws Error where it cannot be driven.
  void load_now();
  /// One step at `now`. Call every 20 ms, always from one thread.
  void tick(Stamp now);

  /// An event that did not come from the cycle. From the ticks' thread.
  void tell(const std::string& text);

  // From any thread:
  /// The site has changed: load it, beside the ticks.
  void reload();
  /// Begins a map by driving, or goes on with one; `anew`: what was driven before is forgotten. Throws Error:
  /// the folder is a site, a value of the setup is out of range.
  void map_by_driving(const MappingSetup& setup, bool anew);
  /// Ends it; the drive stays on the disk.
  void end_mapping();
  /// Null while no map is made by driving.
  [[nodiscard]] std::shared_ptr<MappingDesk> mapping() const;
  /// False, and not said, while there is no run or a measurement has the vehicle: when that ends, nothing
  /// may drive off by what was said during it.
  bool say(const OperatorCommand& command);
  /// Nothing while there is no run.
  [[nodiscard]] std::optional<VehicleView> view() const;
  /// The node's name, or its number where it has none; nothing for a node that is not in the routes.
  [[nodiscard]] std::optional<std::string> node_name(int id) const;
  /// The first of these stops that no way leads to: from the stop `after` (from where the vehicle is, while
  /// there is none; from the main part of the routes while that is not known), from each to the next, and
  /// from the last to the first where the order `repeats`.
  [[nodiscard]] std::optional<int> without_way(std::optional<int> after, const std::vector<int>& stops,
                                               bool repeats) const;
  /// The site has changed and was not taken over yet.
  [[nodiscard]] bool loads() const;
  /// The vehicle stands, and will not move before somebody lets it.
  [[nodiscard]] bool stands() const;
  /// It stands(), and nothing is to be confirmed: a new run would forget an emergency stop or a fault.
  [[nodiscard]] bool may_change_site() const;
  /// What the run has seen of the drawn walls; empty while there is none.
  [[nodiscard]] std::vector<SeenWall> walls_seen() const;
  /// What a braking test must know of the site that is driven; nothing while there is no run.
  [[nodiscard]] std::optional<BrakingSite> braking_site() const;
  /// Why there is no run, as the site's loader says it; empty while there is one.
  [[nodiscard]] std::string missing() const;
  /// The sensors of the site, as they were read last; empty while it names none.
  [[nodiscard]] std::vector<mapping::SensorRecord> sensors() const;
  /// Those of the run that is about to begin. On the ticks' thread.
  [[nodiscard]] const std::vector<mapping::SensorRecord>& sensors_begun_with() const { return next_sensors_; }
  /// memory.bin as the run that is about to begin has read it; empty: none. On the ticks' thread.
  [[nodiscard]] const std::string& memory_begun_with() const { return memory_; }
  [[nodiscard]] std::string device_problem() const { return link_->problem(); }
  [[nodiscard]] std::vector<LidarState> lidar_states() const { return link_->lidars(); }

  /// Measures how the lidars are mounted: the vehicle drives about a metre forward, once around and back,
  /// past everything else. Throws Error where the site names no vehicle and lidars. Precondition: it stands
  /// (may_change_site()), the site is not being loaded (loads()), and no measurement drives or computes.
  void measure_mounting();
  void stop_measuring();
  /// A measurement has the vehicle.
  [[nodiscard]] bool is_measured() const;
  [[nodiscard]] MountingView mounting() const;

 private:
  struct Loaded {
    std::optional<SiteForDriving> site;
    std::unique_ptr<PoseSource> pose;
    std::shared_ptr<MappingDesk> mapping;
    std::shared_ptr<WallWatch> watch;
    std::unique_ptr<SiteKeeper> keeper;
    LoadedPose last;     ///< of the run before
    std::string memory;  ///< memory.bin as this run begins with it
    std::string missing;
    std::vector<mapping::SensorRecord> sensors;
  };
  [[nodiscard]] static Loaded load(const std::filesystem::path& site);
  [[nodiscard]] static Loaded load_mapping(const std::filesystem::path& site);
  bool tick_mounting(Stamp now);
  void take(Loaded loaded);
  void end_beside(std::shared_ptr<void> what);
  void look_for_site();
  void recall_pose();
  void tell_what_is_not_kept(Stamp now);

  std::filesystem::path site_;
  std::unique_ptr<VehicleLink> link_;
  Hooks hooks_;
  std::future<Loaded> loading_;
  mutable std::mutex mutex_;  ///< of what follows; the ticks hold it only to exchange the run
  bool wanted_ = true;
  bool loads_ = false;
  bool mapping_wanted_ = false;
  std::shared_ptr<MappingDesk> mapping_;
  std::vector<mapping::SensorRecord> sensors_;
  std::string missing_ = "the site is being loaded";
  std::shared_ptr<WallWatch> watch_;
  std::unique_ptr<TransportRun> run_;
  std::shared_ptr<MountingRun> mounting_;
  // of the ticks' thread alone:
  std::shared_ptr<SiteKeeper> keeper_;
  std::string not_kept_;  ///< why, as it was told last
  Stamp looked_at_keeping_{};
  PoseRecall recall_{std::nullopt};
  std::string memory_;
  std::vector<mapping::SensorRecord> next_sensors_;
  std::optional<Stamp> again_at_;          ///< a run that could not be begun is tried again
  std::vector<std::future<void>> ending_;  ///< what the runs before learned is being written
};

}  // namespace madori::app
