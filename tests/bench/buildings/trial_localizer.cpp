#include "tests/bench/buildings/trial_localizer.hpp"

#include <functional>
#include <map>

#include "localization/localizer/localizer.hpp"

namespace madori::bench {
namespace {

class LocalizerTrial final : public TrialLocalizer {
 public:
  explicit LocalizerTrial(const mapping::Walls& drawing)
      : localizer_(drawing, std::nullopt, localization::driving_options()) {}

  void set_places(const std::vector<Point2<Map>>& drawn) override { localizer_.set_places(drawn); }
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
