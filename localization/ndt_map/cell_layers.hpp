#pragma once

#include <algorithm>
#include <cstdint>

#include "core/stamp.hpp"

namespace madori::localization {

/// What a cell is, as it is read.
enum class CellState : std::uint8_t { Unseen, Free, Moving, SemiStatic, Static, TakenAway };

/// What the drawing shows where something was seen.
enum class DrawnAs : std::uint8_t {
  Nothing,
  Line,  ///< a line that is no wall: a machine's, a rack's, or one of the floor
  Wall
};

/// Constants of the layers; docs/explanation/living-map.md says why. Evidence in nats.
struct LayerOptions {
  double look_most = 1.4;  ///< of one look
  double now_most = 2.8;   ///< two looks say all, one does not turn it over
  double stands_most = 1.4;
  double permanent_most = 4.0;
  double permanent_least = -1.4;          ///< a new wall is believed within days, too
  double stands_tau_s = 30.0;             ///< looks closer in time are not independent of each other ...
  double permanent_tau_s = 6.0 * 3600.0;  ///< ... nor of each other's day
  double known = 0.2;                     ///< below it nothing is known
  double stands = 0.05;                   ///< about a second of standing
  double gone = 0.2;                      ///< what stood so surely and is not there was taken away
  double permanent = 2.0;                 ///< two other days: on one, what comes and goes is back by chance
};

/// Occupancy at three speeds, log odds.
struct CellLayers {
  float now = 0.0F;
  float stands = 0.0F;
  float permanent = 0.0F;
  Stamp seen{};  ///< of the last look; the epoch: never

  [[nodiscard]] bool was_seen() const { return seen != Stamp{}; }
  /// One look's evidence, at `stamp`. A look that is not later than the last one tells of *now* only.
  /// `same_thing`, 0..1: how surely what it sees is what was known there.
  void take(double evidence, Stamp stamp, const LayerOptions& options, double same_thing = 1.0);
  /// All beams so far passed above what is seen now: of that they said nothing.
  void forget_free() {
    now = std::max(now, 0.0F);
    stands = std::max(stands, 0.0F);
  }
  /// As they count at `stamp`: out of view, each falls back to the slower one; what is not known to be
  /// permanent is not known to be there on another day.
  [[nodiscard]] CellLayers at(Stamp stamp, const LayerOptions& options) const;
  [[nodiscard]] bool lasts(const LayerOptions& options) const {
    return static_cast<double>(permanent) > options.permanent;
  }
  /// On a drawn wall it is static at once, on another drawn line as soon as it stands. `is_what_lasts`: what
  /// is seen there is what is known to last.
  [[nodiscard]] CellState state(Stamp stamp, const LayerOptions& options, DrawnAs drawn = DrawnAs::Nothing,
                                bool is_what_lasts = true) const;
};

}  // namespace madori::localization
