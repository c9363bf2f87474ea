#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/cycle/cycle.hpp"
#include "app/keeping/background_jobs.hpp"
#include "app/keeping/kept_file.hpp"
#include "app/learned/map_watch.hpp"
#include "app/learned/wall_watch.hpp"
#include "app/pose/pose_store.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// Keeps with the site what the next start wants to know: the pose (at most every second, and when the
/// vehicle comes to stand), and what was learned of the drawing, its walls, how they stand in the building,
/// what the vehicle remembers, the living map and what it reads today (when it stands, at most every minute,
/// and at the end). Files are written on a thread of its own, atomically; what was learned is not, where
/// somebody else has replaced the file since.
class SiteKeeper {
 public:
  /// What of the learned files is the run's: as they are before it reads them.
  struct Learned {
    explicit Learned(std::filesystem::path folder);
    std::filesystem::path site;
    KeptFile memory, map, warp, reliability;
  };

  /// `frame`: mapping::map_frame() of the site as it was loaded; without one no days are kept.
  SiteKeeper(Learned learned, const mapping::Walls& walls, std::shared_ptr<const WallWatch> watch,
             std::shared_ptr<const MapWatch> map_watch = nullptr, std::string frame = "");
  /// Keeps everything once more.
  ~SiteKeeper();
  SiteKeeper(const SiteKeeper&) = delete;
  SiteKeeper& operator=(const SiteKeeper&) = delete;

  /// After every step, on the cycle's thread.
  void observe(const CycleState& state, Stamp now);
  /// Keeps what was learned once more, and nothing that is learned later: the files are about to be read
  /// again.
  void finish_learning();
  /// Waits until what was put so far is on the disk.
  void flush() { jobs_.wait(); }
  [[nodiscard]] std::string problem() const { return jobs_.problem(); }

 private:
  void keep_pose(const CycleState& state, Stamp now);
  void take_memory(const CycleState& state, Stamp now);
  void keep_learned();

  std::filesystem::path site_;
  mapping::Walls walls_;
  std::string fingerprint_;
  std::string frame_;
  std::shared_ptr<const WallWatch> watch_;
  std::shared_ptr<const MapWatch> map_watch_;
  Stamp pose_kept_{};
  Stamp learned_kept_{};
  WheelCounters kept_wheels_;
  WheelCounters wheels_before_;
  bool pose_known_ = false;  ///< last_pose.yaml is of this run
  bool stood_ = false;
  std::shared_ptr<const localization::BentDrawing> bent_;        ///< as last believed while sure of the place
  std::shared_ptr<const localization::RememberedParts> memory_;  ///< likewise
  Stamp memory_taken_{};
  Learned learned_;  ///< used by the jobs alone
  BackgroundJobs jobs_;
};

}  // namespace madori::app
