#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/stamp.hpp"
#include "localization/landmarks/place_proposals.hpp"
#include "localization/landmarks/place_sense.hpp"

namespace madori::localization::landmarks {

/// An agent at a landmark.
struct Sighting {
  Stamp stamp{};
  int landmark = 0;
  bool known = false;            ///< recognised; else it was new and lies where the agent stood
  FullPose landmark_from_agent;  ///< the published -Det
  double quality = 1.0;          ///< of the match
};

struct AgentOptions {
  double turning_point_rad = PlaceSense::kTurningPoint_rad;
  double least_quality = 0.6;  ///< of a match: set beforehand, see docs/explanation/landmarks.md
  double rival_quality = 0.9;  ///< share of the best at which another place is as good: no answer
  /// Squared sigmas between a match and the expected pose, 95 % of three. An alias lies anywhere in the
  /// window of three sigmas: if one match in twenty is one, then at this distance one in seven is, at 99.9 %
  /// nine in ten.
  double gate = 7.81;
};

/// One vehicle that maps: dead reckoning between landmarks, a scan match at each. Deterministic.
class LandmarkAgent {
 public:
  /// The first agent starts the map: its first scan becomes landmark 0. A further agent has a rough pose,
  /// seen from landmark 0: as if it had driven from there, with that much uncertainty. Without one it
  /// compares what it sees with all landmarks until two of them, one after the other, put it in the same
  /// place.
  explicit LandmarkAgent(LandmarkHub& hub, const std::optional<FullPose>& rough_start = {},
                         const AgentOptions& options = {});

  /// Dead reckoning since the last call: the new pose seen from the old one.
  void move(const FullPose& step);
  /// A scan at the present pose. A sighting where it is of a place: known ones are matched, others become
  /// landmarks.
  std::optional<Sighting> look(Stamp stamp, const Surroundings& seen);

  /// Seen from landmark 0; unknown until a further agent has found its first landmark.
  [[nodiscard]] FullPose pose() const;
  [[nodiscard]] const std::vector<Sighting>& sightings() const { return sightings_; }

 private:
  struct Recognised {
    int landmark;
    DescriptorMatch match;
  };
  [[nodiscard]] std::optional<Recognised> recognise(const Surroundings& seen, bool is_place,
                                                    bool& near_known) const;
  [[nodiscard]] std::optional<Recognised> recognise_alone(const Surroundings& seen);
  Sighting arrive(Stamp stamp, int landmark, bool known, const FullPose& landmark_from_agent, double quality);
  Sighting arrive(Stamp stamp, const Recognised& found);

  /// A place that a scan suggested while nothing was known, and the way since.
  struct Guess {
    PlaceProposal place;
    FullPose since;
  };

  LandmarkHub* hub_;
  AgentOptions options_;
  int last_ = -1;           ///< landmark of the last sighting
  bool left_last_ = false;  ///< far enough from it to come back to it
  FullPose since_;          ///< the agent seen from it
  double path_m_ = 0.0;     ///< driven since
  PlaceSense sense_;
  double looked_at_m_ = -1e9;  ///< driven at the last look without any idea of the place
  double yaw_rad_ = 0.0;
  std::deque<Guess> guesses_;
  std::vector<Sighting> sightings_;
};

}  // namespace madori::localization::landmarks
