#include "localization/landmarks/landmark_agent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.hpp"

namespace madori::localization::landmarks {
namespace {

constexpr std::size_t kMostGuesses = 100;

double distance_m(const Displacement& d) {
  return std::hypot(d.x_m, d.y_m);
}

double widest_sigma_m(const Matrix3& covariance) {
  return std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
}

/// Squared sigmas between a match and what was expected, axes of the landmark.
double surprise(const FullPose& expected, const Displacement& found, const Matrix3& found_covariance) {
  const Vector3 off{{found.x_m - expected.motion.x_m, found.y_m - expected.motion.y_m,
                     wrap_angle(found.yaw_rad - expected.motion.yaw_rad)}};
  return dot(off, inverse(expected.uncertainty.covariance + found_covariance) * off);
}

}  // namespace

LandmarkAgent::LandmarkAgent(LandmarkHub& hub, const std::optional<FullPose>& rough_start,
                             const AgentOptions& options)
    : hub_(&hub), options_(options), sense_(options.turning_point_rad) {
  if (!rough_start || hub.map().size() == 0) return;
  last_ = 0;
  left_last_ = true;
  since_ = *rough_start;
  path_m_ = std::numeric_limits<double>::infinity();
}

void LandmarkAgent::move(const FullPose& step) {
  since_ = added(since_, step);
  for (Guess& guess : guesses_) guess.since = added(guess.since, step);
  path_m_ += distance_m(step.motion);
  sense_.move(distance_m(step.motion), step.motion.yaw_rad);
}

FullPose LandmarkAgent::pose() const {
  return last_ >= 0 ? added(hub_->landmark(last_), since_) : since_;
}

std::optional<LandmarkAgent::Recognised> LandmarkAgent::recognise(const Surroundings& seen, bool is_place,
                                                                  bool& near_known) const {
  const std::vector<FullPose> landmarks = hub_->seen_from(last_);
  const double reach_m = (is_place ? 1.0 : 0.5) * seen.corridor_width_m;
  std::optional<Recognised> best;
  near_known = false;
  for (int k = 0; k < static_cast<int>(landmarks.size()); ++k) {
    if (landmarks[k].uncertainty.is_unknown()) continue;
    if (k == last_ && !left_last_) {
      near_known = true;
      continue;
    }
    const FullPose expected = added(negated(landmarks[k]), since_);
    const double sigma_m = widest_sigma_m(expected.uncertainty.covariance);
    const double away_m = distance_m(expected.motion);
    if (away_m > reach_m + 3.0 * sigma_m) continue;
    if (away_m < seen.corridor_width_m && std::abs(expected.motion.yaw_rad) < 0.25 * kPi) near_known = true;
    const Descriptor& descriptor = hub_->map().descriptor(k);
    const MatchWindow window{expected.motion, 3.0 * sigma_m,
                             3.0 * std::sqrt(expected.uncertainty.covariance(2, 2))};
    const DescriptorMatch match = match_landmark(descriptor, seen, window);
    if (match.quality < options_.least_quality ||
        match.rival_quality > options_.rival_quality * match.quality ||
        surprise(expected, match.landmark_from_scan, match.uncertainty.covariance) > options_.gate)
      continue;
    if (!best || match.quality > best->match.quality) best = Recognised{k, match};
  }
  return best;
}

/// Nothing is known of the place, and crossings look alike: two different landmarks, one after the other,
/// must put the agent in the same place.
std::optional<LandmarkAgent::Recognised> LandmarkAgent::recognise_alone(const Surroundings& seen) {
  const std::vector<PlaceProposal> places = propose_places(*hub_, seen);
  for (const PlaceProposal& place : places)
    for (const Guess& guess : guesses_) {
      const FullPose carried_on = added(guess.place.pose, guess.since);
      if (guess.place.landmark == place.landmark ||
          surprise(carried_on, place.pose.motion, place.pose.uncertainty.covariance) > options_.gate)
        continue;
      const FullPose before{guess.place.match.landmark_from_scan, guess.place.match.uncertainty};
      last_ = guess.place.landmark;
      since_ = added(before, guess.since);
      guesses_.clear();
      return Recognised{place.landmark, place.match};
    }
  for (const PlaceProposal& place : places) guesses_.push_back({place, {}});
  while (guesses_.size() > kMostGuesses) guesses_.pop_front();
  return std::nullopt;
}

Sighting LandmarkAgent::arrive(Stamp stamp, int landmark, bool known, const FullPose& landmark_from_agent,
                               double quality) {
  if (last_ >= 0 && last_ != landmark)
    hub_->measure(last_, landmark, added(since_, negated(landmark_from_agent)));
  last_ = landmark;
  left_last_ = false;
  since_ = landmark_from_agent;
  path_m_ = 0.0;
  sightings_.push_back({stamp, landmark, known, landmark_from_agent, quality});
  return sightings_.back();
}

Sighting LandmarkAgent::arrive(Stamp stamp, const Recognised& found) {
  return arrive(stamp, found.landmark, true, {found.match.landmark_from_scan, found.match.uncertainty},
                found.match.quality);
}

std::optional<Sighting> LandmarkAgent::look(Stamp stamp, const Surroundings& seen) {
  const bool is_place = sense_.at_a_place(seen);
  left_last_ = left_last_ || distance_m(since_.motion) > 1.5 * seen.corridor_width_m;
  if (seen.descriptor.size() == 0) return std::nullopt;
  if (hub_->map().size() == 0) return arrive(stamp, hub_->add(seen.descriptor), false, {}, 1.0);
  if (last_ < 0) {
    if (sense_.driven_m() - looked_at_m_ < 0.5 * seen.corridor_width_m) return std::nullopt;
    looked_at_m_ = sense_.driven_m();
    const auto found = recognise_alone(seen);
    return found ? std::optional(arrive(stamp, *found)) : std::nullopt;
  }
  if (path_m_ < seen.corridor_width_m) return std::nullopt;
  bool near_known = false;
  if (const auto found = recognise(seen, is_place, near_known)) return arrive(stamp, *found);
  if (!is_place || near_known || hub_->full()) return std::nullopt;
  return arrive(stamp, hub_->add(seen.descriptor), false, {}, 1.0);
}

}  // namespace madori::localization::landmarks
