// Switched on in an aisle whose racks were rearranged over night, in halls whose drawing is its own image
// turned by half a turn: does what was seen the day before tell the place, and does the drawing alone?
//   bench_rearranged [HALLS [FIRST SEED]]
// From the place where it is switched on the vehicle drives 4 m along the aisle, to its end and back through
// the next one. A line a hall: metres until it said DEGRADED or better ("placed") and LOCALIZED ("sure") at
// the right place for good; seconds LOCALIZED while more than 0.5 m off; the last state by the drawing alone.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "localization/localizer/localizer.hpp"
#include "tests/support/driven_localizer.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

using test::drive;
using test::take;
using test::ten_hertz;

constexpr double kAisleM = 2.6;
constexpr double kRackM = 0.9;  // deep
constexpr double kSideM = 2.0;  // between the outer walls and the racks

struct Rack {
  double from_m = 0.0, to_m = 0.0;
  int row = 0;
};

/// A hall with rows of racks that nobody drew, between which aisles run along x.
class Hall {
 public:
  explicit Hall(unsigned seed) : engine_(seed) {
    length_m_ = uniform(24.0, 34.0);
    rows_ = seed % 2 == 0 ? 3 : 4;
    for (int row = 0; row < rows_; ++row)
      for (double x = kSideM + uniform(0.0, 2.0); x < length_m_ - kSideM - 2.6; x += uniform(0.3, 1.5)) {
        racks_.push_back({x, x + uniform(1.2, 2.6), row});
        x = racks_.back().to_m;
      }
  }

  [[nodiscard]] mapping::Walls drawn() const {
    mapping::Walls walls;
    test::add_box(walls, 0.0, 0.0, length_m_, width_m());
    return walls;
  }
  [[nodiscard]] mapping::Walls built() const {
    mapping::Walls walls = drawn();
    for (const Rack& rack : racks_)
      test::add_box(walls, rack.from_m, side_m(rack.row) - kRackM, rack.to_m, side_m(rack.row));
    return walls;
  }
  /// Over night a fifth of the racks goes away, and a fifth along its row by up to a metre.
  void rearrange() {
    std::vector<Rack> left;
    for (Rack rack : racks_) {
      const double chance = uniform(0.0, 1.0);
      const double by_m = uniform(0.4, 1.0) * (chance < 0.3 ? -1.0 : 1.0);
      if (chance < 0.2) continue;
      if (chance < 0.4) rack.from_m += by_m, rack.to_m += by_m;
      left.push_back(rack);
    }
    racks_ = left;
  }
  /// Through every aisle, back and forth.
  [[nodiscard]] std::vector<Point2<Map>> round() const {
    std::vector<Point2<Map>> way{{1.0, 1.0}, {length_m_ - 1.0, 1.0}};
    for (int aisle = 0; aisle + 1 < rows_; ++aisle) {
      const bool back = aisle % 2 == 0;
      way.push_back({back ? length_m_ - 1.0 : 1.0, middle_m(aisle)});
      way.push_back({back ? 1.0 : length_m_ - 1.0, middle_m(aisle)});
    }
    way.push_back({way.back().x_m, width_m() - 1.0});
    way.push_back({length_m_ - way.back().x_m, width_m() - 1.0});
    return way;
  }
  /// Four metres of one aisle, to its end, and back through another.
  [[nodiscard]] std::vector<Point2<Map>> in_an_aisle() {
    const int aisle = static_cast<int>(uniform(0.0, rows_ - 1.0));
    const int other = aisle > 0 ? aisle - 1 : aisle + 1;
    const double x = uniform(kSideM + 2.0, length_m_ - kSideM - 6.0);
    const bool right = uniform(0.0, 1.0) < 0.5;
    const double end = right ? length_m_ - 1.0 : 1.0;
    return {{right ? x : x + 4.0, middle_m(aisle)},
            {right ? x + 4.0 : x, middle_m(aisle)},
            {end, middle_m(aisle)},
            {end, middle_m(other)},
            {0.5 * length_m_, middle_m(other)}};
  }
  [[nodiscard]] double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine_);
  }

 private:
  [[nodiscard]] double side_m(int row) const { return kSideM + kRackM + row * (kRackM + kAisleM); }
  [[nodiscard]] double middle_m(int aisle) const { return side_m(aisle) + kAisleM / 2.0; }
  [[nodiscard]] double width_m() const { return side_m(rows_ - 1) + kSideM; }

  std::mt19937 engine_;
  double length_m_ = 0.0;
  int rows_ = 0;
  std::vector<Rack> racks_;
};

struct Found {
  double placed_after_m = -1.0;  ///< DEGRADED or LOCALIZED within 0.3 m from there to the end; negative: not
  double sure_after_m = -1.0;    ///< LOCALIZED likewise
  int wrong_and_sure = 0;        ///< scans LOCALIZED while more than 0.5 m off
  LocalizationState last = LocalizationState::Lost;
};

Found seek(Localizer& localizer, const std::vector<test::DriveMoment>& moments) {
  Found found;
  double driven_m = 0.0;
  const auto keep = [&](double& after_m, bool holds) {
    if (!holds)
      after_m = -1.0;
    else if (after_m < 0.0)
      after_m = driven_m;
  };
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const auto& truth = moments[i].truth;
    if (i > 0) driven_m += distance_m(truth.translation(), moments[i - 1].truth.translation());
    const PoseEstimate e = take(localizer, moments[i]);
    const double off_m = distance_m(e.map_from_base.translation(), truth.translation());
    found.last = e.health.state;
    const bool sure = found.last == LocalizationState::Localized;
    found.wrong_and_sure += sure && off_m > 0.5 ? 1 : 0;
    keep(found.sure_after_m, sure && off_m < 0.3);
    keep(found.placed_after_m, (sure || found.last == LocalizationState::Degraded) && off_m < 0.3);
  }
  return found;
}

int run(unsigned halls, unsigned first) {
  unsigned placed = 0, sure = 0, by_drawing = 0;
  int wrong = 0;
  for (unsigned seed = first; seed < first + halls; ++seed) {
    Hall hall(seed);
    const auto yesterday = drive(hall.built(), hall.round(), ten_hertz(), seed);
    Localizer before(hall.drawn(), InitialPose{yesterday.front().truth}, driving_options());
    for (const auto& moment : yesterday) (void)take(before, moment);
    hall.rearrange();
    const auto today = drive(hall.built(), hall.in_an_aisle(), ten_hertz(), 100 + seed);
    Localizer alone(hall.drawn(), std::nullopt, driving_options());
    const Found drawing = seek(alone, today);
    Localizer next(hall.drawn(), std::nullopt, driving_options());
    if (const auto parts = before.remembered()) next.recall(parts->together());
    const Found memory = seek(next, today);
    std::printf(
        "hall %3u: by what was seen before placed after %5.1f m, sure after %5.1f m, wrong and sure %.1f s; "
        "by the "
        "drawing alone %s, wrong and sure %.1f s\n",
        seed, memory.placed_after_m, memory.sure_after_m, 0.1 * memory.wrong_and_sure,
        to_string(drawing.last), 0.1 * drawing.wrong_and_sure);
    std::fflush(stdout);
    placed += memory.placed_after_m >= 0.0 ? 1 : 0;
    sure += memory.sure_after_m >= 0.0 ? 1 : 0;
    by_drawing += drawing.placed_after_m >= 0.0 ? 1 : 0;
    wrong += memory.wrong_and_sure + drawing.wrong_and_sure;
  }
  std::printf(
      "of %u: by what was seen before placed %u, sure %u; by the drawing alone %u; wrong and sure %.1f s\n",
      halls, placed, sure, by_drawing, 0.1 * wrong);
  return sure == halls && wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace madori::localization

int main(int argc, char** argv) {
  return madori::localization::run(argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 20,
                                   argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1);
}
