#include "tests/bench/buildings/trial_localizer.hpp"

#include <functional>
#include <map>

#include "localization/localizer/localizer.hpp"
#include "localization/wall_tracker/wall_tracker.hpp"

namespace madori::bench {
namespace {

class TrackerTrial final : public TrialLocalizer {
 public:
  explicit TrackerTrial(const mapping::Walls& drawing) : tracker_(drawing) {}

  PoseEstimate on_odometry(const OdometryReading& reading) override { return tracker_.on_odometry(reading); }
  void on_scan(Stamp stamp, const localization::ScanPoints& points, const Point2<Base>& /*sensor*/) override {
    (void)tracker_.on_scan(stamp, points);
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    tracker_.set_pose(map_from_base, sigma);
  }
  void search_anew() override { tracker_.search_anew(); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return tracker_.hypotheses(); }
  /// The share of the likeliest place among those that it knows.
  [[nodiscard]] double said() const override {
    const auto places = tracker_.hypotheses();
    return places.empty() ? 0.0 : places.front().probability;
  }

 private:
  localization::WallTracker tracker_;
};

class LocalizerTrial final : public TrialLocalizer {
 public:
  explicit LocalizerTrial(const mapping::Walls& drawing)
      : localizer_(drawing, std::nullopt, localization::driving_options()) {}

  PoseEstimate on_odometry(const OdometryReading& reading) override {
    return localizer_.on_odometry(reading);
  }
  void on_scan(Stamp stamp, const localization::ScanPoints& points, const Point2<Base>& sensor) override {
    (void)localizer_.on_scan(stamp, points, sensor);
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    localizer_.set_pose(map_from_base, sigma);
  }
  void search_anew() override { localizer_.search_anew(); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return localizer_.hypotheses(); }
  [[nodiscard]] double said() const override { return localizer_.evidence().here; }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return localizer_.bent();
  }

 private:
  localization::Localizer localizer_;
};

using Maker = std::function<std::unique_ptr<TrialLocalizer>(const mapping::Walls&)>;

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> all{
      {"localizer", [](const auto& drawing) { return std::make_unique<LocalizerTrial>(drawing); }},
      {"tracker", [](const auto& drawing) { return std::make_unique<TrackerTrial>(drawing); }},
  };
  return all;
}

}  // namespace

std::vector<std::string> localizer_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : makers()) names.push_back(name);
  return names;
}

std::unique_ptr<TrialLocalizer> make_trial_localizer(const std::string& name, const mapping::Walls& drawing) {
  return makers().at(name)(drawing);
}

}  // namespace madori::bench
