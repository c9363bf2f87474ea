#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/georeference/tile_math.hpp"
#include "mapping/site/site.hpp"

namespace madori::mapping {

inline constexpr double kClickPx = 1.0;  ///< a point of a drawing is clicked to about so much

enum class Verdict { Good, Usable, Refused };
[[nodiscard]] const char* to_string(Verdict verdict);

/// What else an operator should know. The panel's catalogues know it by its code, `text` is English.
struct ScaleNote {
  std::string code;
  std::map<std::string, std::string> values;  ///< what a catalogue's {placeholders} stand for
  std::string text;
};

/// One way to the scale of a drawing, how well it fits, and what to think of it.
struct ScaleEstimate {
  std::string method;  ///< known, control, overlay, paper, dxf-units, option
  double m_per_px = 0.0;
  double relative_uncertainty = 0.0;  ///< one sigma
  double error_m = 0.0;             ///< of the fit: sqrt(sum r^2 / degrees of freedom); 0 without redundancy
  bool verified = false;            ///< more was measured than the fit needs
  std::vector<std::string> inputs;  ///< as they were given
  std::vector<double> residuals_m;  ///< one an input, fitted minus given (control: distance)
  std::vector<double> leave_one_out_m;  ///< control: how far off each point is predicted by the others
  std::optional<std::size_t> outlier;   ///< index of the input that contradicts the others
  bool mirrored = false;
  std::optional<double> stretch;  ///< scale along u over scale along v, minus 1, where it is significant
  std::optional<GeoreferenceRecord> georeference;
  Point2<Map> held;  ///< what the georeference laid on its place: at another scale it stays there
  Verdict verdict = Verdict::Refused;
  std::string reason;  ///< of the verdict, in words
  std::vector<ScaleNote> notes;
};

/// Sets verdict and reason from what was found: refused when mirrored, contradicted by an outlier or less
/// certain than 2 %; good when verified and within 0.5 %.
void judge(ScaleEstimate& estimate);

/// The published interface: U = L_t / (R_t * Z_p) * Z_m, Eq. (9) of the layout-map paper, metres a pixel.
[[nodiscard]] double overlay_scale(double tile_side_m, double tile_pixels, double photo_zoom,
                                   double layout_zoom);
/// A paper drawing 1:`ratio` at `dpi`.
[[nodiscard]] ScaleEstimate paper_scale(double ratio, double dpi);
/// The scale that site.yaml holds already, as a source beside the others.
[[nodiscard]] ScaleEstimate recorded_scale(const ScaleRecord& record);

/// One sentence for every two sources that differ by more than twice their joint uncertainty.
[[nodiscard]] std::vector<std::string> disagreements(const std::vector<ScaleEstimate>& estimates);

}  // namespace madori::mapping
