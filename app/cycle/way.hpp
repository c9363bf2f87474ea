#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cycle/notice.hpp"
#include "app/orders/order.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "core/path.hpp"
#include "planning/obstacle_check/path_check.hpp"

/// From the order to the wheels: what the cycle remembers of it, each part by the stage that works on it.
namespace madori::app {

/// What the vehicle is to do now, and by which nodes it gets there: navigate().
struct Errand {
  std::optional<Target> target;
  OrderStop stop;
  std::vector<std::size_t> nodes;  ///< of the route
  std::vector<std::size_t>
      doors;      ///< doors and lifts that it leads through, also one just behind the vehicle
  Notice no_way;  ///< why there is no path
  bool arrived = false;
  bool reported = false;
  Stamp dwell_until{};
  int back_outs = 0;          ///< on this route
  bool backing_held = false;  ///< the way that it came led into something: it curves
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, Stamp>> blocked_legs;
};

/// The path at hand: navigate() and back_out() lay it. Progress and Ahead begin anew with it.
struct Way {
  control::TrackedPath path;
  Path plain;                      ///< the same path as planning wants it
  std::optional<double> rejoin_m;  ///< of a detour
  bool backing = false;            ///< it is the way that the vehicle came, driven backward
};

/// How far the vehicle is on it: pursue_way().
struct Progress {
  control::PursuitState pursuit;
  control::PursuitStatus status = control::PursuitStatus::Following;
  double along_m = 0.0;
  double cross_track_m = 0.0;
};

/// How far the path is free: check_way().
struct Ahead {
  planning::PathCheck check;
  double stop_along_m = planning::PathCheck::kFree;
  double care_along_m = planning::PathCheck::kFree;
  bool turn_free = true;
  bool held = false;  ///< driving on leads into something beside the path
  std::optional<Stamp> held_since;
};

/// A place at which something seems to move.
struct Stirring {
  Point2<Map> at;
  Stamp since{};
  Stamp last{};
};

/// What holds the vehicle up, whichever path it tries: check_way(), and watch_effort() what is felt.
struct Block {
  bool felt = false;           ///< something that was not seen has held the vehicle
  bool by_mover = false;       ///< it is on its way across
  bool unseen = false;         ///< it is remembered from before it came too near for the lidar
  bool height_unseen = false;  ///< ahead is a door or lift of which no lidar sees how high it is open
  std::vector<std::size_t> doors_allowed;  ///< nodes that an operator has looked at
  bool door_shut = false;                  ///< it stands before one, for what is seen there
  planning::Squeeze squeeze;               ///< until it is out of where it stands too near to something
  std::vector<Stirring> stirring;
  std::optional<Stamp> since;
  std::optional<Stamp> free_since;
};

/// The search for a way around, which runs beside the cycle: check_way() asks, navigate() takes the answer.
struct DetourSearch {
  Stamp asked{};
  std::uint32_t id = 0;
  bool pending = false;
  std::string failed;
};

}  // namespace madori::app
