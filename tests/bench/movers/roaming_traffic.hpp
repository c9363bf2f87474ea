#pragma once

#include <optional>
#include <vector>

#include "simulation/factory.hpp"
#include "simulation/random.hpp"

namespace madori::bench {

/// Persons, tuggers and forklifts who walk and drive to and fro on straight ways near the vehicle, wherever
/// it goes. They come from where it does not see them, or from 9 m away, stop before it and turn back. Who is
/// far away, or has been about for a minute and is out of sight, gives way to another one.
class RoamingTraffic {
 public:
  RoamingTraffic(simulation::Factory& factory, std::uint64_t seed)
      : factory_(factory), chance_(seed, kStream, 0) {}

  /// A few times a second.
  void advance();
  /// Who stands in the vehicle's way for good is asked to go: everybody within 4 m of it.
  void make_room();

 private:
  static constexpr std::uint64_t kStream = 0x6D6F76657273;  ///< of the random numbers, its own
  struct Somebody {
    std::string name;
    simulation::MoverKind kind;
    Stamp since{};
  };
  struct Way {
    Point2<simulation::Building> from, to;
  };
  void let_go();
  void send(simulation::MoverKind kind);
  [[nodiscard]] std::optional<Way> way_near(const Point2<simulation::Building>& here, double half_width_m);
  [[nodiscard]] bool is_free(const Point2<simulation::Building>& at, double half_width_m) const;
  [[nodiscard]] bool is_in_sight(const Point2<simulation::Building>& at) const;
  /// As it is now; null for one that was sent in this step.
  [[nodiscard]] const simulation::Body* body_of(const Somebody& one) const;
  [[nodiscard]] double away_m(const Point2<simulation::Building>& at) const;

  simulation::Factory& factory_;
  simulation::Random chance_;
  std::vector<Somebody> all_;
  int number_ = 0;
};

}  // namespace madori::bench
