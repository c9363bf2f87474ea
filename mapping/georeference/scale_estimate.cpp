#include "mapping/georeference/scale_estimate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr double kGood = 0.005;
constexpr double kUsable = 0.02;
constexpr double kMetresPerInch = 0.0254;
/// Plotters "fit to page" and scanners stretch: a stated paper scale is not trusted further than this.
constexpr double kPaperUncertainty = 0.02;

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::Good:
      return "good";
    case Verdict::Usable:
      return "usable";
    case Verdict::Refused:
      return "refused";
  }
  return "refused";
}

void judge(ScaleEstimate& e) {
  e.verdict = Verdict::Refused;
  const double percent = 100.0 * e.relative_uncertainty;
  if (e.mirrored) {
    e.reason = "the drawing is mirrored: import it flipped, or exchange the points that were mixed up";
  } else if (e.outlier) {
    e.reason = fmt::format("input {} ({}) contradicts the others: measure it again or leave it out",
                           *e.outlier + 1, e.inputs[*e.outlier]);
  } else if (!(e.m_per_px > 0.0) || !std::isfinite(e.m_per_px)) {
    e.reason = "no positive scale fits the inputs";
  } else if (e.verified && !(e.relative_uncertainty <= kUsable)) {
    e.reason = fmt::format("the inputs disagree: the scale is uncertain by {:.2f} %, more than 2 %", percent);
  } else if (!e.verified) {
    e.verdict = Verdict::Usable;
    e.reason = "unverified: nothing checks it; measure one more length to be sure";
  } else if (e.relative_uncertainty > kGood || e.stretch) {
    e.verdict = Verdict::Usable;
    e.reason = e.stretch ? "the drawing is stretched; lengths along u and v differ"
                         : fmt::format("uncertain by {:.2f} %; good would be 0.5 %", percent);
  } else {
    e.verdict = Verdict::Good;
    e.reason = fmt::format("{} inputs agree, uncertain by {:.2f} %", e.inputs.size(), percent);
  }
}

double overlay_scale(double side_m, double tile_pixels, double photo_zoom, double layout_zoom) {
  return side_m / (tile_pixels * photo_zoom) * layout_zoom;
}

ScaleEstimate paper_scale(double ratio, double dpi) {
  if (!(ratio > 0.0 && std::isfinite(ratio)))
    throw Error("--paper", "is no scale", "write it as on the drawing, e.g. 1:200");
  if (!(dpi > 0.0 && std::isfinite(dpi)))
    throw Error("--paper", "the drawing has no known resolution", "add --dpi, the scanner's setting");
  ScaleEstimate e;
  e.method = "paper";
  e.m_per_px = ratio * kMetresPerInch / dpi;
  e.relative_uncertainty = kPaperUncertainty;
  e.inputs = {fmt::format("1:{:g} at {:g} dpi", ratio, dpi)};
  judge(e);
  return e;
}

ScaleEstimate recorded_scale(const ScaleRecord& record) {
  ScaleEstimate e;
  e.method = record.method;
  e.m_per_px = record.m_per_px;
  e.relative_uncertainty = record.relative_uncertainty;
  e.error_m = record.residual_m;
  e.verified = e.error_m > 0.0;  // where nothing checks it, nothing is left over
  e.inputs = record.inputs;
  judge(e);
  return e;
}

std::vector<std::string> disagreements(const std::vector<ScaleEstimate>& estimates) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < estimates.size(); ++i)
    for (std::size_t j = i + 1; j < estimates.size(); ++j) {
      const auto& a = estimates[i];
      const auto& b = estimates[j];
      const double difference = b.m_per_px / a.m_per_px - 1.0;
      // A source that states no uncertainty is taken to be within 0.5 %.
      const double joint = std::hypot(a.relative_uncertainty > 0.0 ? a.relative_uncertainty : kGood,
                                      b.relative_uncertainty > 0.0 ? b.relative_uncertainty : kGood);
      if (std::abs(difference) > 2.0 * joint)
        found.push_back(
            fmt::format("{} ({:.6g} m/px) and {} ({:.6g} m/px) disagree by {:.2f} %, more than their "
                        "uncertainty of {:.2f} %",
                        a.method, a.m_per_px, b.method, b.m_per_px, 100.0 * difference, 100.0 * joint));
    }
  return found;
}

}  // namespace madori::mapping
