#include "tests/support/hand_drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/angle.hpp"

namespace madori::test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kStep = 20ms;

/// Hands the factory's link to one SiteRun after the other.
class Lent final : public app::VehicleLink {
 public:
  explicit Lent(app::VehicleLink& link) : link_(link) {}
  void collect(app::CycleInput& input) override { link_.collect(input); }
  void send(const app::CycleOutput& output) override { link_.send(output); }
  [[nodiscard]] std::string problem() const override { return ""; }

 private:
  app::VehicleLink& link_;
};

}  // namespace

HandDrive::HandDrive(const simulation::FactorySetup& setup, Hand hand)
    : hand_(hand),
      site_(folder_.path() / "site"),
      setup_{setup.vehicle, setup.sensors},
      factory_(std::make_shared<simulation::Factory>(setup)) {
  const auto& v = setup_.vehicle;
  link_ = std::make_unique<FactoryLink>(
      factory_, WheelGeometry{v.wheel_radius_m, v.wheel_radius_m, v.half_wheel_separation_m}, kStep);
  start_program();
}

HandDrive::~HandDrive() = default;

void HandDrive::start_program() {
  run_.emplace(site_, std::make_unique<Lent>(*link_), app::SiteRun::Hooks{});
}

void HandDrive::kill_program() {
  run_.reset();
}

void HandDrive::map(bool anew) {
  run_->map_by_driving(setup_, anew);
  while (!run_->mapping() || run_->mapping()->progress().reading) {  // the test's own limit ends this
    tick();
    std::this_thread::sleep_for(1ms);
  }
}

void HandDrive::tick() {
  run_->tick(factory_->now() + kStep);
  while (run_->mapping() && run_->mapping()->progress().waiting > 0) std::this_thread::sleep_for(100us);
}

void HandDrive::jog(const VelocityCommand& velocity) {
  if (run_->view() && run_->view()->mode != app::Mode::Manual)
    run_->say({app::OperatorWord::ManualOn, {}, {}});
  run_->say({app::OperatorWord::Jog, velocity, {}});
}

void HandDrive::jog_for(double seconds, const VelocityCommand& velocity) {
  for (double t = 0.0; t < seconds; t += 0.02) {
    jog(velocity);
    tick();
  }
}

bool HandDrive::drive_to(const Point2<Map>& goal, double limit_s) {
  for (double t = 0.0; t < limit_s; t += 0.02) {
    const auto at = factory_->truth().map_from_base;
    const double dx = goal.x_m - at.x_m(), dy = goal.y_m - at.y_m();
    const double away_m = std::hypot(dx, dy);
    if (away_m < hand_.arrived_m) {
      jog_for(hand_.rest_s, {});
      return true;
    }
    const double off = wrap_angle(std::atan2(dy, dx) - at.yaw_rad());
    const double ahead =
        std::abs(off) > hand_.turn_first_rad ? 0.0 : hand_.speed_mps * std::min(1.0, away_m / 0.5);
    jog({ahead, std::clamp(hand_.turn_gain * off, -hand_.turn_radps, hand_.turn_radps)});
    tick();
  }
  return false;
}

std::size_t HandDrive::finish() {
  jog_for(0.5, {});
  const auto view = *run_->view();
  return app::make_site_of_drive(*run_->mapping(), site_,
                                 app::StandsAt{view.pose.map_from_base, app::counters_of(view.drive)},
                                 [](const std::string&, double) {});
}

}  // namespace madori::test
