#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "app/runner/site_run.hpp"
#include "simulation/factory.hpp"
#include "tests/support/factory_link.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::test {

/// How a person steers by hand.
struct Hand {
  double speed_mps = 0.5;       ///< at most
  double turn_gain = 1.5;       ///< radians a second of each radian off the goal,
  double turn_radps = 0.7;      ///< at most
  double turn_first_rad = 0.6;  ///< farther off the goal: turns on the spot
  double arrived_m = 0.15;
  double rest_s = 0.6;  ///< at a goal that was reached
};

/// A site without a drawing, made by driving the vehicle by hand through the virtual factory: the panel's own
/// way (SiteRun, MappingDesk, make_site_of_drive) in lock-step, steps of 20 ms. The mapper never drops a
/// scan.
class HandDrive {
 public:
  HandDrive(const simulation::FactorySetup& setup, Hand hand = {});
  ~HandDrive();
  HandDrive(const HandDrive&) = delete;
  HandDrive& operator=(const HandDrive&) = delete;

  /// Begins to map, or goes on with what was driven; returns as soon as the mapper listens.
  void map(bool anew = true);
  void tick();
  void jog(const VelocityCommand& velocity);
  void jog_for(double seconds, const VelocityCommand& velocity);
  /// A person who sees the vehicle and steers it to a place of the building's plan; whether it came.
  bool drive_to(const Point2<Map>& goal, double limit_s = 60.0);
  /// Finishes the map: the number of walls. Throws NoMap.
  std::size_t finish();
  /// The program is killed and started again.
  void kill_program();
  void start_program();

  [[nodiscard]] const std::filesystem::path& site() const { return site_; }
  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }
  [[nodiscard]] simulation::Factory& factory() { return *factory_; }
  [[nodiscard]] app::SiteRun& run() { return *run_; }
  [[nodiscard]] app::MappingSetup& setup() { return setup_; }

 private:
  Hand hand_;
  TemporaryFolder folder_;
  std::filesystem::path site_;
  app::MappingSetup setup_;
  std::shared_ptr<simulation::Factory> factory_;
  std::unique_ptr<FactoryLink> link_;
  std::optional<app::SiteRun> run_;
};

}  // namespace madori::test
