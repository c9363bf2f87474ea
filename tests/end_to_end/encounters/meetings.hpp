#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>

#include "tests/end_to_end/encounters/placements.hpp"
#include "tests/support/lock_step_run.hpp"

namespace madori::encounters {

struct MeetingOptions {
  std::string site;
  std::string scenario;  ///< its movers stay at home
  double speed_mps = 1.0;
  bool detours = false;
  unsigned seed = 1;
  bool verbose = false;
};

/// What became of one kind of thing in the way.
struct Tally {
  int met = 0;
  int stopped = 0;
  int contacts = 0;         ///< that began while the vehicle drove or turned
  int refused = 0;          ///< of them: who lies there was not seen, and touched no faster than that allows
  double touch_mps = 0.0;   ///< of the outline's fastest point, at the fastest of the contacts
  int others_touched = 0;   ///< that began while it stood: the other one walked into it
  double nearest_m = 10.0;  ///< while the vehicle moved
  double fastest_mps = 0.0;
};

/// How the vehicle got past carts that stood on its way.
struct CartTally {
  int met = 0;
  int around = 0;       ///< by a detour
  int other_route = 0;  ///< or without one: the rest of the route, or another one, left the cart aside
  int waited = 0;       ///< until it was taken away
  int contacts = 0;
};

/// A vehicle that drives from station to station, and what is put in its way.
class Meetings {
 public:
  explicit Meetings(const MeetingOptions& options);

  void meet(simulation::MoverKind kind, int count, Tally& tally);
  /// Carts that were left standing on the way: driven around where there is room.
  void pass_carts(int count, CartTally& tally);

 private:
  void go_on();
  void encounter(const Placement& placement, Tally& tally);
  void report(const Placement& placement, bool stopped, double touch_mps, double nearest_m) const;
  void clear();
  /// Contacts since the first `before` that began while the vehicle moved.
  [[nodiscard]] int contacts_since(std::size_t before) const;
  /// As fast as the vehicle drives with what it sees by.
  [[nodiscard]] double driven_mps() const;

  MeetingOptions options_;
  app::SiteForDriving site_;
  std::mt19937 random_;
  std::unique_ptr<test::LockStepRun> run_;
  std::optional<std::int64_t> order_;
};

}  // namespace madori::encounters
