#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/path.hpp"
#include "core/ring.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/column_groups.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

/// Something of a person's or a forklift's size that moves, as a disc.
template <class F>
struct Mover {
  Point2<F> at;
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double radius_m = 0.0;
};

/// One that is seen no more.
struct LostMover {
  Mover<Odom> last;     ///< as it was last seen
  double high_m = 0.0;  ///< as high as it was ever seen to be, above the floor
  Stamp seen{};
};

struct MoverOptions {
  double widest_m = 2.6;      ///< larger things are no traffic
  double slowest_mps = 0.35;  ///< slower ones are measured as if they stood
  double fastest_mps = 3.0;
  double match_m = 0.45;   ///< furthest from where it was expected
  double history_s = 0.5;  ///< over which a velocity is measured, and over fewest_sightings at least
  int fewest_sightings = 4;
  double margin_m = 0.15;  ///< around the disc
  double window_s = 1.0;   ///< before and after the vehicle would be at a place
  double foresight_s = 3.0;
  double turn_s = 1.2;         ///< of movement that is foreseen around a vehicle that turns on the spot
  double gain_mps2 = 0.5;      ///< how fast the vehicle gains speed
  double top_speed_mps = 1.0;  ///< ... and up to what
};

/// Follows compact groups of columns that came where the floor was seen empty, and measures how they move.
/// Remembered columns, and things that only come into sight, are no movers.
class MovingObjects {
 public:
  struct Sighting {
    Stamp stamp{};
    Point2<Odom> at;
  };
  struct Track {
    Ring<Sighting> sightings;
    double radius_m = 0.0;
    double high_m = 0.0;  ///< as high as it was ever seen to be
    Stamp since{};        ///< when it was first seen
    [[nodiscard]] Mover<Odom> mover() const;
  };

  explicit MovingObjects(const MoverOptions& options = {}) : options_(options) {}

  /// `columns` after a scan taken at `stamp`.
  void update(const std::vector<Column>& columns, Stamp stamp);
  [[nodiscard]] const std::vector<Mover<Odom>>& movers() const { return movers_; }
  /// Movers that no group of the last update went on with.
  [[nodiscard]] const std::vector<LostMover>& lost() const { return lost_; }
  [[nodiscard]] const MoverOptions& options() const { return options_; }
  /// What is remembered, and going on with what was remembered at another time.
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  void restore(std::vector<Track> tracks);

 private:
  /// Tracks that ended: their memory serves new ones.
  class Spare {
   public:
    Track take();
    void give(Track&& track) { tracks_.push_back(std::move(track)); }

   private:
    std::vector<Track> tracks_;
  };
  /// The track that a group goes on with; null where it begins one.
  [[nodiscard]] Track* followed_by(const ColumnGroups::Group& group, Stamp stamp);
  void find_movers();
  [[nodiscard]] std::optional<Mover<Odom>> moves(const Track& track) const;

  MoverOptions options_;
  ColumnGroups groups_;
  std::vector<Track> tracks_, followed_;  ///< followed_: empty between two updates
  std::vector<Mover<Odom>> movers_;       ///< of the tracks
  std::vector<LostMover> lost_;
  Spare spare_;
};

/// Points [from, ...] of the path against where the movers will be when the vehicle gets there: at the
/// earliest gaining speed from `speed_mps` (negative backward), at the latest keeping it. free_m,
/// first_blocked and where as in check_path().
[[nodiscard]] PathCheck check_movers(const Path& path, std::size_t from, double ahead_m, double speed_mps,
                                     const std::vector<Mover<Map>>& movers, const CheckOptions& check,
                                     const MoverOptions& options);

/// Whether something moves into what the vehicle sweeps while it turns on the spot.
[[nodiscard]] bool turn_meets(const Transform2<Map, Base>& pose, const std::vector<Mover<Map>>& movers,
                              const CheckOptions& check, const MoverOptions& options);

}  // namespace madori::planning
