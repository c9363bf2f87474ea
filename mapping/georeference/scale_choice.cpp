#include "mapping/georeference/scale_choice.hpp"

#include <algorithm>
#include <utility>

#include "mapping/georeference/local_plane.hpp"

namespace madori::mapping {
namespace {

bool better(const ScaleEstimate& a, const ScaleEstimate& b) {
  if (a.verdict != b.verdict) return a.verdict < b.verdict;
  if (a.verified != b.verified) return a.verified;
  return a.relative_uncertainty < b.relative_uncertainty;
}

/// The source's georeference for a drawing of another scale than its own.
std::optional<GeoreferenceRecord> at_scale(double m_per_px, const ScaleEstimate& source) {
  if (!source.georeference) return std::nullopt;
  return rescaled(*source.georeference, source.held, m_per_px / source.m_per_px);
}

}  // namespace

ScaleChoice choose_scale(std::vector<ScaleEstimate> sources) {
  ScaleChoice choice;
  choice.sources = std::move(sources);
  choice.best = *std::ranges::min_element(choice.sources, better);
  for (const auto& source : choice.sources)
    if (!choice.best.georeference && source.verdict != Verdict::Refused)
      choice.best.georeference = at_scale(choice.best.m_per_px, source);
  choice.disagreements = disagreements(choice.sources);
  if (!choice.disagreements.empty() && choice.best.verdict != Verdict::Refused) {
    choice.best.verdict = Verdict::Refused;
    choice.best.reason = choice.disagreements.front();
  }
  return choice;
}

}  // namespace madori::mapping
