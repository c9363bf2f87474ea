#include "mapping/georeference/scale_choice.hpp"

#include <algorithm>
#include <utility>

namespace madori::mapping {
namespace {

bool better(const ScaleEstimate& a, const ScaleEstimate& b) {
  if (a.verdict != b.verdict) return a.verdict < b.verdict;
  if (a.verified != b.verified) return a.verified;
  return a.relative_uncertainty < b.relative_uncertainty;
}

}  // namespace

ScaleChoice choose_scale(std::vector<ScaleEstimate> sources) {
  ScaleChoice choice;
  choice.sources = std::move(sources);
  choice.best = *std::ranges::min_element(choice.sources, better);
  for (const auto& source : choice.sources)
    if (!choice.best.georeference && source.verdict != Verdict::Refused)
      choice.best.georeference = source.georeference;
  choice.disagreements = disagreements(choice.sources);
  if (!choice.disagreements.empty() && choice.best.verdict != Verdict::Refused) {
    choice.best.verdict = Verdict::Refused;
    choice.best.reason = choice.disagreements.front();
  }
  return choice;
}

}  // namespace madori::mapping
