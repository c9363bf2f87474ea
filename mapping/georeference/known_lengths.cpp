#include "mapping/georeference/known_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/result.hpp"
#include "mapping/georeference/number_list.hpp"

namespace madori::mapping {
namespace {

constexpr double kDisagreement = 0.01;

/// Least-squares scale of all but `left_out`.
double fit(const std::vector<KnownLength>& lengths, std::size_t left_out) {
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (i == left_out) continue;
    products += lengths[i].pixels() * lengths[i].metres;
    squares += lengths[i].pixels() * lengths[i].pixels();
  }
  return products / squares;
}

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// How far a length is off, relative to itself. What its two clicks may be off counts the less the shorter it
/// is: a door of 40 pixels is off by 3.5 % without contradicting anything.
double deviation(const KnownLength& k, double scale) {
  const double clicks = std::sqrt(2.0) * kClickPx / k.pixels();
  return (scale * k.pixels() / k.metres - 1.0) / std::hypot(1.0, clicks / kDisagreement);
}

/// RMS of the deviations of all but `left_out`.
double relative_rms(const std::vector<KnownLength>& lengths, std::size_t left_out) {
  const double scale = fit(lengths, left_out);
  double sum = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (i != left_out) sum += std::pow(deviation(lengths[i], scale), 2);
  const std::size_t used = lengths.size() - (left_out == kNone ? 0 : 1);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(used - 1, 1)));
}

/// The one length without which the others agree, while without any other one they do not.
std::optional<std::size_t> find_outlier(const std::vector<KnownLength>& lengths) {
  if (lengths.size() < 3) return std::nullopt;
  const double all = relative_rms(lengths, kNone);
  if (all < kDisagreement) return std::nullopt;
  std::size_t best = 0;
  std::vector<double> rest;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    rest.push_back(relative_rms(lengths, i));
    if (rest[i] < rest[best]) best = i;
  }
  double second = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (i != best) second = std::min(second, rest[i]);
  const bool clear = rest[best] < all / 3.0 && rest[best] < second / 3.0;
  return clear ? std::optional(best) : std::nullopt;
}

void explain_disagreement(const std::vector<KnownLength>& lengths, double relative, ScaleEstimate& e) {
  if (relative < kDisagreement || e.outlier) return;
  if (lengths.size() == 2)
    e.notes.push_back(
        {"scale-two-lengths",
         {},
         "the two lengths disagree; of two it cannot be told which one is wrong: measure a third"});
  else
    e.notes.push_back(
        {"scale-lengths", {}, "the lengths disagree, and no single one explains it: measure more of them"});
}

}  // namespace

double KnownLength::pixels() const {
  return std::hypot(u2 - u1, v2 - v1);
}

KnownLength parse_known_length(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto ends = parse_numbers(std::string_view(text).substr(0, equals));
  const auto length =
      equals == std::string::npos ? std::nullopt : parse_numbers(std::string_view(text).substr(equals + 1));
  if (!ends || ends->size() != 4 || !length || length->size() != 1)
    throw Error("--known " + text, "is not u1,v1,u2,v2=METRES", "e.g. --known 580.8,43.4,80.3,1025=9.315");
  const KnownLength known{(*ends)[0], (*ends)[1], (*ends)[2], (*ends)[3], (*length)[0]};
  if (!(known.metres > 0.0)) throw Error("--known " + text, "the length is not positive", "give metres");
  if (!(known.pixels() >= 1.0))
    throw Error("--known " + text, "its two points are the same pixel", "give the two ends of the length");
  return known;
}

void require_on_drawing(const std::vector<KnownLength>& lengths, const DrawingRecord& drawing) {
  for (const auto& k : lengths) {
    const auto where = fmt::format("--known {:g},{:g},{:g},{:g}={:g}", k.u1, k.v1, k.u2, k.v2, k.metres);
    require_on_drawing(where, k.u1, k.v1, drawing);
    require_on_drawing(where, k.u2, k.v2, drawing);
  }
}

ScaleEstimate fit_known_lengths(const std::vector<KnownLength>& lengths) {
  if (lengths.empty()) throw Error("--known", "no length was given", "give at least one");
  ScaleEstimate e;
  e.method = "known";
  e.m_per_px = fit(lengths, kNone);
  double residuals = 0.0;
  double squares = 0.0;
  for (const auto& k : lengths) {
    e.inputs.push_back(fmt::format("{:g},{:g},{:g},{:g}={:g}", k.u1, k.v1, k.u2, k.v2, k.metres));
    e.residuals_m.push_back(e.m_per_px * k.pixels() - k.metres);
    residuals += std::pow(e.residuals_m.back(), 2);
    squares += k.pixels() * k.pixels();
  }
  e.verified = lengths.size() > 1;
  const double relative = relative_rms(lengths, kNone);
  if (e.verified) e.error_m = std::sqrt(residuals / static_cast<double>(lengths.size() - 1));
  // What the clicks allow at best, and what the residuals show; few residuals alone flatter.
  const double clicks = std::sqrt(2.0 * kClickPx * kClickPx / squares);
  e.relative_uncertainty = std::hypot(clicks, relative / std::sqrt(static_cast<double>(lengths.size())));
  e.outlier = find_outlier(lengths);
  explain_disagreement(lengths, relative, e);
  judge(e);
  if (e.verdict != Verdict::Refused && relative > 2.0 * kDisagreement) {
    e.verdict = Verdict::Refused;
    e.reason = fmt::format("the lengths disagree by {:.1f} %", 100.0 * relative);
  }
  return e;
}

}  // namespace madori::mapping
