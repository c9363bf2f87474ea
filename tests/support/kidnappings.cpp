#include "tests/support/kidnappings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::test {
namespace {

constexpr double kSettle_s = 3.0;
constexpr double kWatched_s = 8.0;

}  // namespace

Kidnapping Kidnapper::carry_out(int number) {
  Kidnapping k;
  k.kind = number % 4;
  k.drives = number / 4 % 2 == 1;
  do {
    const auto [from, to] = choose(k.kind);
    k.from = from, k.to = to;
  } while (!settle(k.from, k.drives));
  const Pose here = trial_.floor().truth();
  if (k.drives && k.kind != 2) {  // it has driven on: the shift counts, not the place
    const Pose along(here.x_m() + k.to.x_m() - k.from.x_m(), here.y_m() + k.to.y_m() - k.from.y_m(),
                     here.yaw_rad() + k.to.yaw_rad() - k.from.yaw_rad());
    const auto to = is_free(along) ? std::optional(along) : shifted(here, std::min(k.kind, 2));
    k.to = to.value_or(k.to);
  }
  k.from = here;
  k.by_m = distance_m(k.from.translation(), k.to.translation());
  trial_.kidnap(k.to);
  watch(k);
  return k;
}

/// Whether the vehicle may stand there.
bool Kidnapper::is_free(const Pose& pose) const {
  const auto& world = trial_.floor().world();
  const auto there = world.frames().building_pose(pose);
  const auto outline = simulation::rectangle(there.translation(), there.yaw_rad(), 1.3, 1.0);
  return pose.x_m() > 0.8 && pose.y_m() > 0.8 && pose.x_m() < 79.2 && pose.y_m() < 49.2 &&
         world.obstacles().find(outline, {0.03, 0.8}) == nullptr;
}

/// Somewhere near the routes.
Transform2<Map, Base> Kidnapper::anywhere() {
  const auto& nodes = trial_.routes().nodes();
  const auto& legs = trial_.routes().legs();
  for (;;) {
    const auto& leg = legs[random_.below(legs.size())];
    const Point2<Map>&a = nodes[leg.from].position, &b = nodes[leg.to].position;
    const double t = random_.uniform();
    const Pose pose(a.x_m + t * (b.x_m - a.x_m) + random_.uniform(-1.5, 1.5),
                    a.y_m + t * (b.y_m - a.y_m) + random_.uniform(-1.5, 1.5), random_.uniform(-kPi, kPi));
    if (is_free(pose)) return pose;
  }
}

std::optional<Transform2<Map, Base>> Kidnapper::shifted(const Pose& from, int kind) {
  for (int attempt = 0; attempt < 60; ++attempt) {
    const double by_m = kind == 0 ? 1.0 : kind == 1 ? random_.uniform(1.0, 5.0) : random_.uniform(5.0, 50.0);
    const double direction = random_.uniform(-kPi, kPi);
    const double turn = kind == 0 ? 0.0 : kind == 1 ? random_.uniform(-0.6, 0.6) : random_.uniform(-kPi, kPi);
    const Pose to(from.x_m() + by_m * std::cos(direction), from.y_m() + by_m * std::sin(direction),
                  from.yaw_rad() + turn);
    if (is_free(to)) return to;
  }
  return std::nullopt;
}

/// Bays, docks and aisles of the sample factory that are drawn alike: corner of a place, its size, and the
/// way to its twin.
std::optional<std::pair<Transform2<Map, Base>, Transform2<Map, Base>>> Kidnapper::alike() {
  struct Twins {
    double x, y, dx, dy, to_x, to_y;
  };
  constexpr std::array<Twins, 4> kTwins{{{47.2, 11.0, 4.0, 4.0, 0.0, 6.0},    // goods-in bays
                                         {53.0, 1.5, 2.5, 4.0, 10.0, 0.0},    // loading docks
                                         {59.6, 15.5, 2.0, 7.0, 10.0, 0.0},   // aisles between shelves
                                         {22.0, 9.0, 6.0, 6.0, 10.0, 0.0}}};  // columns 10 m apart
  const Twins& t = kTwins[random_.below(kTwins.size())];
  const bool back = random_.below(2) == 1;
  const double yaw = random_.uniform(-kPi, kPi);
  const Pose a(t.x + random_.uniform(0.0, t.dx), t.y + random_.uniform(0.0, t.dy), yaw);
  const Pose b(a.x_m() + t.to_x, a.y_m() + t.to_y, yaw);
  if (!is_free(a) || !is_free(b)) return std::nullopt;
  return back ? std::pair(b, a) : std::pair(a, b);
}

std::pair<Transform2<Map, Base>, Transform2<Map, Base>> Kidnapper::choose(int kind) {
  for (;;) {
    if (kind == 3) {
      if (const auto pair = alike()) return *pair;
      continue;
    }
    const Pose from = anywhere();
    if (const auto to = shifted(from, kind)) return {from, *to};
  }
}

/// Puts the vehicle there, lets it find itself and be for a while; false where it does not.
bool Kidnapper::settle(const Pose& at, bool drives) {
  trial_.kidnap(at);
  trial_.localizer().search_anew();
  double good_s = 0.0;
  for (double t = 0.0; t < 20.0 && good_s < kSettle_s; t += LocalizationTrial::kStep_s) {
    trial_.step(drives && good_s > 0.5);
    const bool good = trial_.pose().health.state == LocalizationState::Localized && trial_.error_m() < 0.1;
    good_s = good ? good_s + LocalizationTrial::kStep_s : 0.0;
  }
  return good_s >= kSettle_s;
}

void Kidnapper::watch(Kidnapping& k) {
  for (double t = LocalizationTrial::kStep_s; t < kWatched_s; t += LocalizationTrial::kStep_s) {
    trial_.step(k.drives);
    const LocalizationState state = trial_.pose().health.state;
    const bool sure = state == LocalizationState::Localized;
    if (state == LocalizationState::Lost && k.lost_after_s < 0.0) k.lost_after_s = t;
    if (sure && trial_.error_m() > 0.5) k.believed_wrong_s += LocalizationTrial::kStep_s;
    if (sure && trial_.error_m() < 0.2) {
      k.found_after_s = t;
      return;
    }
  }
}

}  // namespace madori::test
