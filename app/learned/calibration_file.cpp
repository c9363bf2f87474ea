#include "app/learned/calibration_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/covariance_yaml.hpp"
#include "core/angle.hpp"
#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/strict_yaml.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {
namespace {

using localization::SelfCalibration;

constexpr double kWorthKeeping = 0.01;
constexpr double kCertainEnough = 0.003;
constexpr double kSignificantStretch = 9.2;  // chi-squared of 2 degrees of freedom at 1 %

constexpr CovarianceKeys kCovariance{"xx", "xy", "xs", "yy", "ys", "ss"};

double sigma(const SelfCalibration& c, int i) {
  return std::sqrt(c.covariance(i, i));
}

/// Where the file names other walls, what was learned there says nothing of these.
SelfCalibration read(const std::filesystem::path& file, const mapping::Walls& walls) {
  auto yaml = mapping::StrictYaml::load(file);
  if (yaml.text("walls_fingerprint") != mapping::walls_fingerprint(walls))
    throw Error(file.string(), "is of the drawing as it was before it was changed",
                "drive again: it is measured anew");
  SelfCalibration c;
  constexpr std::array kStrain{"strain_x", "strain_y", "shear_rad"};
  for (int i = 0; i < 3; ++i) c.strain[i] = yaml.number(kStrain[static_cast<std::size_t>(i)], -0.5, 0.5);
  c.covariance = read_covariance(yaml, kCovariance, 1.0);
  c.wall_sigma_m = yaml.number("wall_sigma_m", 0.0, 10.0);
  c.walls = yaml.integer("walls", 0, 1'000'000);
  c.displaced = yaml.integer("displaced", 0, 1'000'000);
  c.keyframes = yaml.integer("keyframes", 0, 1'000'000);
  c.pieces = yaml.integer("pieces", 0, 100'000'000);
  yaml.refuse_unknown_keys();
  c.converged = true;
  return c;
}

}  // namespace

std::string calibration_yaml(const SelfCalibration& c, const mapping::Walls& walls) {
  std::string text =
      "# How the drawing is stretched, as measured while driving: drawn = (1 + strain) * true.\n";
  text += fmt::format("strain_x: {:.9f}\nstrain_y: {:.9f}\nshear_rad: {:.9f}\n", c.strain[0], c.strain[1],
                      c.strain[2]);
  text += covariance_yaml(c.covariance, kCovariance);
  return text + fmt::format(
                    "wall_sigma_m: {:.4f}\nwalls: {}\ndisplaced: {}\nkeyframes: {}\npieces: {}\n"
                    "walls_fingerprint: \"{}\"\n",
                    c.wall_sigma_m, c.walls, c.displaced, c.keyframes, c.pieces,
                    mapping::walls_fingerprint(walls));
}

SelfCalibration load_calibration(const std::filesystem::path& site, const mapping::Walls& walls) {
  const auto file = site / kCalibrationFile;
  if (!std::filesystem::exists(file))
    throw Error(site.string(), "the scale was not measured while driving yet",
                "play a log of a drive with madori localize --learn");
  return read(file, walls);
}

bool keep_calibration(const std::filesystem::path& site, const mapping::Walls& walls,
                      const SelfCalibration& found) {
  if (!found.converged || std::min(sigma(found, 0), sigma(found, 1)) > kWorthKeeping) return false;
  try {
    if (load_calibration(site, walls).uniform_sigma() < found.uniform_sigma()) return false;
  } catch (const Error&) {  // none yet, damaged, or of other walls: the new one takes its place
  }
  mapping::write_file_atomically(site / kCalibrationFile, calibration_yaml(found, walls));
  return true;
}

std::string describe(const SelfCalibration& c) {
  if (!c.converged)
    return "the drawing's scale could not be measured: too few drawn walls were seen, or they do not agree\n";
  std::string text;
  for (int i = 0; i < 2; ++i) {
    const double percent = 100.0 * c.strain[i];
    text += fmt::format("{} {:.2f} % +- {:.2f} % too {} along {}", i == 0 ? "the drawing seems" : ",",
                        std::abs(percent), 100.0 * sigma(c, i), percent < 0.0 ? "small" : "large", "xy"[i]);
  }
  return text + fmt::format(
                    ", skewed by {:.2f} +- {:.2f} deg\n  ({} scans on {} walls, {} of them displaced; "
                    "the others are misdrawn by {:.3f} m)\n",
                    to_deg(c.strain[2]), to_deg(sigma(c, 2)), c.keyframes, c.walls, c.displaced,
                    c.wall_sigma_m);
}

nlohmann::json to_json(const SelfCalibration& c) {
  if (!c.converged) return {{"converged", false}, {"walls", c.walls}, {"keyframes", c.keyframes}};
  return {{"converged", c.converged},
          {"too_large_x_percent", 100.0 * c.strain[0]},
          {"too_large_y_percent", 100.0 * c.strain[1]},
          {"skew_deg", to_deg(c.strain[2])},
          {"sigma_x_percent", 100.0 * sigma(c, 0)},
          {"sigma_y_percent", 100.0 * sigma(c, 1)},
          {"sigma_skew_deg", to_deg(sigma(c, 2))},
          {"too_large_percent", 100.0 * c.uniform()},
          {"sigma_percent", 100.0 * c.uniform_sigma()},
          {"stretch_chi2", c.stretch_chi2()},
          {"wall_sigma_m", c.wall_sigma_m},
          {"walls", c.walls},
          {"displaced", c.displaced},
          {"keyframes", c.keyframes},
          {"pieces", c.pieces}};
}

mapping::ScaleEstimate scale_of(const SelfCalibration& found, const mapping::ScaleRecord& now) {
  mapping::ScaleEstimate e;
  e.method = "self-calibration";
  e.m_per_px = now.m_per_px / (1.0 + found.uniform());
  e.relative_uncertainty = found.uniform_sigma();
  e.verified = true;
  e.inputs = {fmt::format("{} scans on {} walls", found.keyframes, found.walls)};
  e.residuals_m = {found.wall_sigma_m};
  if (found.stretch_chi2() > kSignificantStretch) {
    e.stretch = (1.0 + found.strain[1]) / (1.0 + found.strain[0]) - 1.0;
    const std::string found_so = describe(found);
    e.notes.push_back(
        {"scale-one-for-both",
         {},
         "one scale for both directions is applied: " + found_so.substr(0, found_so.find('\n'))});
  }
  mapping::judge(e);
  if (e.verdict != mapping::Verdict::Refused && e.relative_uncertainty > kCertainEnough) {
    e.verdict = mapping::Verdict::Refused;
    e.reason = fmt::format("uncertain by {:.2f} %, more than 0.3 %: drive on, past more walls",
                           100.0 * e.relative_uncertainty);
  } else if (e.verdict == mapping::Verdict::Good) {
    e.reason = fmt::format("measured while driving, uncertain by {:.2f} %", 100.0 * e.relative_uncertainty);
  }
  return e;
}

}  // namespace madori::app
