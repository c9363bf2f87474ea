#include "app/panel/panel_preview.hpp"

#include <nlohmann/json.hpp>

#include "app/revision/drawing_revision.hpp"

namespace madori::app {
namespace {

class PanelPreview final : public hmi::DrawingPreview {
 public:
  PanelPreview(const mapping::ImportOptions& options, const mapping::Progress& progress)
      : revised_(options, progress) {}

  [[nodiscard]] nlohmann::json report() const override {
    auto report = revision_json(revised_.found(), false);
    report["drawn"] = segment_rows(revised_.drawn());
    return report;
  }
  void move(const mapping::Similarity& by) override { revised_.move(by); }
  void apply() override { revised_.apply(); }

 private:
  RevisedDrawing revised_;
};

}  // namespace

std::unique_ptr<hmi::DrawingPreview> preview_drawing(const mapping::ImportOptions& options,
                                                     const mapping::Progress& progress) {
  return std::make_unique<PanelPreview>(options, progress);
}

}  // namespace madori::app
