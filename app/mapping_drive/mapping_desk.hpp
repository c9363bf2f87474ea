#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>

#include "app/mapping_drive/drive_journal.hpp"
#include "app/mapping_drive/mapping_picture.hpp"
#include "localization/slam/graph_mapper.hpp"

namespace madori::app {

/// How far a map by driving is.
struct MappingProgress {
  bool reading = false;  ///< what was driven before the program ended is being read
  double driven_m = 0.0;
  int scans = 0;
  std::size_t waiting = 0;  ///< scans that the mapper has still to look at
  int dropped = 0;          ///< scans that a busy computer had no time for
  std::size_t keyframes = 0;
  int loops = 0;
  bool lost = false;    ///< the map does not go on here
  std::string problem;  ///< why the drive is not kept on the disk; empty: it is
};

/// Where the mapper put a scan, and where the wheels were then.
struct MappedPose {
  PoseEstimate pose;
  Transform2<Odom, Base> odom_from_base;
};

/// The mapper of a drive by hand, on a thread of its own: who gives it something never waits for it. What it
/// gets is kept in a file, from which an interrupted drive goes on.
class MappingDesk {
 public:
  struct Options {
    std::filesystem::path journal;
    bool beside = true;  ///< false, in tests: the giver does the work
  };
  /// Goes on with the drive in the file where there is one. Throws Error (no permission, no drive).
  explicit MappingDesk(Options options);
  /// Waits for what is under way.
  ~MappingDesk();
  MappingDesk(const MappingDesk&) = delete;
  MappingDesk& operator=(const MappingDesk&) = delete;

  // Of the cycle's thread:
  void on_odometry(const OdometryReading& reading);
  /// Taken where the vehicle has moved since the last one that was. `odom_from_base`: at the stamp.
  void on_scan(DriveScan scan, const Transform2<Odom, Base>& odom_from_base);

  // From any thread:
  /// Nothing before the first scan.
  [[nodiscard]] std::optional<MappedPose> newest() const;
  [[nodiscard]] MappingProgress progress() const;
  /// Made anew at most once a second; never null.
  [[nodiscard]] std::shared_ptr<const MappingPicture> picture() const;
  /// The last look at all that was given so far; the drive may go on behind it. Takes seconds, on the desk's
  /// thread. Throws what the mapper throws.
  [[nodiscard]] localization::FinishedMap finish();

 private:
  struct GivenScan {
    DriveScan scan;
    Transform2<Odom, Base> odom_from_base;
  };
  using Item = std::variant<OdometryReading, GivenScan>;

  void run(const std::stop_token& stop);
  void put(Item item);
  void drop(std::deque<Item>::iterator item);
  void read_earlier(const std::stop_token& stop);
  void work(const Item& item);
  void take(const OdometryReading& reading);
  void take(const GivenScan& given);
  void join();
  void note(const PoseEstimate& pose, const Transform2<Odom, Base>& moved_to);
  void tell(bool reading);
  void draw_picture();

  Options options_;
  // of the giver:
  std::optional<OdometryReading> given_, held_;  ///< of a standing vehicle the last reading is held back
  std::optional<Transform2<Odom, Base>> scanned_;
  // of the desk's thread:
  localization::GraphMapper mapper_;
  std::optional<DriveJournal> journal_;
  MappingProgress count_;
  std::optional<OdometryReading> last_;  ///< that the mapper got
  std::optional<Transform2<Odom, Base>> last_scan_;
  std::optional<Transform2<Odom, Odom>> drive_from_odom_;  ///< what goes on joins the end of what was read
  Duration later_{};
  double lost_m_ = 0.0;
  int lost_scans_ = 0;
  std::size_t broken_at_ = 0;  ///< the keyframes of before the newest scans that fitted nothing
  Stamp synced_{};
  double picture_cost_s_ = 0.0;
  std::chrono::steady_clock::time_point drawn_at_;
  std::size_t drawn_keyframes_ = 0;
  int drawn_loops_ = -1;
  // of all:
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Item> waiting_;
  std::size_t waiting_scans_ = 0;
  int dropped_ = 0;
  OdometryReading begun_;  ///< the first that was given
  std::optional<MappedPose> newest_;
  MappingProgress told_;
  std::shared_ptr<const MappingPicture> picture_ = std::make_shared<const MappingPicture>();
  std::optional<std::promise<localization::FinishedMap>> asked_;
  std::jthread thread_;
};

}  // namespace madori::app
