#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "simulation/factory.hpp"
#include "tests/bench/movers/plain_sight.hpp"
#include "tests/bench/movers/true_mover.hpp"

namespace madori::bench {

/// What truly was in the virtual factory over the last seconds, for scans that are looked at a little later.
class TruthHistory {
 public:
  explicit TruthHistory(const simulation::Factory& factory) : factory_(factory) {}

  /// After every step of the factory.
  void note();
  /// Where the vehicle was; nothing where that is not remembered.
  [[nodiscard]] std::optional<Transform2<Building, Base>> vehicle_at(Stamp stamp) const;
  /// Everybody, and the doors' leaves, as a lidar that stood there could see them.
  [[nodiscard]] std::vector<TrueMover> movers_at(Stamp stamp, const LidarPlace& lidar) const;

 private:
  struct Moment {
    Stamp stamp{};
    Transform2<Building, Base> vehicle;
    std::vector<simulation::Body> bodies;
  };
  /// Of the first moment at or after a stamp, where there is one before it.
  [[nodiscard]] std::optional<std::size_t> moment_after(Stamp stamp) const;
  [[nodiscard]] static const simulation::Body* find(const Moment& moment, const std::string& name);
  [[nodiscard]] bool is_leaf(const simulation::Body& body) const;
  /// How far it is from where it was at any moment since `stamp`, at most; zero for one that came later.
  [[nodiscard]] double moved_m(const simulation::Body& body, Stamp stamp) const;
  /// Whether it moves, and has to be found.
  void judge(TrueMover& mover, Stamp stamp, const std::vector<simulation::Body>& all,
             const LidarPlace& lidar) const;

  const simulation::Factory& factory_;
  std::deque<Moment> moments_;
};

}  // namespace madori::bench
