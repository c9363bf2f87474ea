#include "tests/bench/movers/mover_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace madori::bench {
namespace {

constexpr std::array<const char*, kKinds> kKindNames{"person", "truck"};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr long kFewestAsked = 20;  ///< of fewer looks no row is made

double share(long part, long of) {
  return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : kNone;
}

double quantile(std::vector<double> values, double share_below) {
  if (values.empty()) return kNone;
  const auto at = static_cast<std::ptrdiff_t>(share_below * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? kNone : std::sqrt(sum / static_cast<double>(values.size()));
}

std::string range_name(std::size_t range) {
  return fmt::format("{:.0f}-{:.0f} m", range == 0 ? 0.0 : kRangesM[range - 1], kRangesM[range]);
}

std::string figure(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string both(double tracker, double baseline, int decimals) {
  return figure(tracker, decimals) + " / " + figure(baseline, decimals);
}

double precision(const ToldCounts& c) {
  return share(c.right, c.told - c.neither);
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json found_json(const FoundCounts& c) {
  return {
      {"asked", c.asked},
      {"recall", number(share(c.found, c.asked))},
      {"outline_m", {{"median", number(median(c.outline_m))}, {"p95", number(quantile(c.outline_m, 0.95))}}},
      {"centre_m", {{"median", number(median(c.centre_m))}, {"p95", number(quantile(c.centre_m, 0.95))}}},
      {"velocity_mps",
       {{"median", number(median(c.velocity_mps))}, {"rms", number(root_mean_square(c.velocity_mps))}}},
      {"along_mps", {{"median", number(median(c.along_mps))}}},
      {"first_after_s",
       {{"median", number(median(c.first_after_s))}, {"p95", number(quantile(c.first_after_s, 0.95))}}},
      {"searches", c.first_after_s.size() + static_cast<std::size_t>(c.never)},
      {"never", c.never}};
}

}  // namespace

void print_told_head() {
  fmt::print(
      "| lidar | told at | told | precision | wrong in 1000 scans |\n| --- | --- | --- | --- | --- |\n");
}

void print_told(const Comparison& c) {
  for (std::size_t r = 0; r < kRanges; ++r) {
    const ToldCounts &t = c.tracker.told(r), &b = c.baseline.told(r);
    if (t.told + b.told == 0) continue;
    fmt::print("| {} | {} | {} / {} | {} | {} |\n", c.setup, range_name(r), t.told, b.told,
               both(precision(t), precision(b), 3),
               both(1e3 * share(t.wrong(), c.looks), 1e3 * share(b.wrong(), c.looks), 1));
  }
}

void print_found_head() {
  fmt::print(
      "| lidar | who | range | looks | recall | from the outline, p95 | from the centre | velocity | RMS | "
      "told after | never |\n|{}\n",
      " --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
}

void print_found(const Comparison& c) {
  for (std::size_t k = 0; k < kKinds; ++k)
    for (std::size_t r = 0; r < kRanges; ++r) {
      const auto kind = static_cast<Traffic>(k);
      const FoundCounts &t = c.tracker.found(kind, r), &b = c.baseline.found(kind, r);
      if (t.asked < kFewestAsked) continue;
      fmt::print("| {} | {} | {} | {} | {} | {} m | {} m | {} m/s | {} m/s | {} s | {} / {} of {} |\n",
                 c.setup, kKindNames[k], range_name(r), t.asked,
                 both(share(t.found, t.asked), share(b.found, b.asked), 2),
                 both(quantile(t.outline_m, 0.95), quantile(b.outline_m, 0.95), 2),
                 both(median(t.centre_m), median(b.centre_m), 2),
                 both(median(t.velocity_mps), median(b.velocity_mps), 2),
                 both(root_mean_square(t.velocity_mps), root_mean_square(b.velocity_mps), 2),
                 both(median(t.first_after_s), median(b.first_after_s), 1), t.never, b.never,
                 t.first_after_s.size() + static_cast<std::size_t>(t.never));
    }
}

nlohmann::json to_json(const MoverScore& score) {
  nlohmann::json ranges = nlohmann::json::array();
  for (std::size_t r = 0; r < kRanges; ++r) {
    const ToldCounts& c = score.told(r);
    nlohmann::json range{{"to_m", kRangesM[r]},
                         {"told", c.told},
                         {"right", c.right},
                         {"neither", c.neither},
                         {"precision", number(precision(c))}};
    for (std::size_t k = 0; k < kKinds; ++k)
      range[kKindNames[k]] = found_json(score.found(static_cast<Traffic>(k), r));
    ranges.push_back(std::move(range));
  }
  return {{"ranges", ranges}, {"f1_within_8m", f1_score(score)}};
}

}  // namespace madori::bench
