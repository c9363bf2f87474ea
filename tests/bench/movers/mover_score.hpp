#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/stamp.hpp"
#include "tests/bench/movers/true_mover.hpp"

namespace madori::bench {

/// Upper ends of the ranges, metres from the lidar. 8 m: the reach of the obstacle check.
inline constexpr std::array kRangesM{3.0, 6.0, 8.0, 10.0, 15.0, 25.0};
inline constexpr std::size_t kRanges = kRangesM.size();
inline constexpr std::size_t kKinds = 2;

/// The range that a distance lies in; nothing beyond the last.
[[nodiscard]] std::optional<std::size_t> range_of(double away_m);

/// Of those told to move, by the distance of the told place.
struct ToldCounts {
  long told = 0, right = 0, neither = 0;
  [[nodiscard]] long wrong() const { return told - right - neither; }
};

/// Of those that had to be found, by the distance of their outline.
struct FoundCounts {
  long asked = 0, found = 0;
  std::vector<double> outline_m, centre_m;  ///< of the told place from the outline (0 inside), the centre
  std::vector<double> velocity_mps;         ///< length of the difference
  std::vector<double> along_mps;            ///< the difference along the true velocity: below 0 is too slow
  std::vector<double> first_after_s;        ///< of those sought for a second or longer, from when they were
  long never = 0;                           ///< ... and not found until they were sought no more
};

/// What somebody tells of who moves, against the truth, scan by scan.
class MoverScore {
 public:
  /// `lidar`: where it was.
  void add(Stamp stamp, const std::vector<ToldMover>& told, const std::vector<TrueMover>& truths,
           const Point2<Building>& lidar);
  /// The drive is over: so is being sought.
  void end();
  void merge(const MoverScore& other);

  [[nodiscard]] const ToldCounts& told(std::size_t range) const { return told_[range]; }
  [[nodiscard]] const FoundCounts& found(Traffic kind, std::size_t range) const {
    return found_[static_cast<std::size_t>(kind)][range];
  }

 private:
  struct Search {
    Stamp begun{}, last{};
    std::optional<double> found_after_s;
    Traffic kind = Traffic::Person;
    std::size_t range = 0;  ///< where it began
  };
  void note_found(FoundCounts& counts, const ToldMover& told, const TrueMover& truth);
  void note_search(Stamp stamp, const TrueMover& truth, std::size_t range, bool found);
  void end_search(const Search& search);
  FoundCounts& counts_of(Traffic kind, std::size_t range) {
    return found_[static_cast<std::size_t>(kind)][range];
  }

  std::array<ToldCounts, kRanges> told_{};
  std::array<std::array<FoundCounts, kRanges>, kKinds> found_{};
  std::map<std::string, Search> searches_;  ///< by name
};

/// 2pr / (p + r) over the ranges up to 8 m, all kinds: where obstacle check and baseline both look.
[[nodiscard]] double f1_score(const MoverScore& score);

}  // namespace madori::bench
