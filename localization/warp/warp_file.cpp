#include "localization/warp/warp_file.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <sstream>

#include "core/possible.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::localization {
namespace {

constexpr const char* kHeader = "madori-warp 1";
constexpr int kMostControls = 4'000'000;

void append(std::string& text, const char* word, std::span<const double> values) {
  text += word;
  for (const double value : values) {
    std::array<char, 40> number{};
    std::snprintf(number.data(), number.size(), " %.17g", value);
    text += number.data();
  }
  text += '\n';
}

/// Lines of a word and a known count of numbers, in a known order.
class Lines {
 public:
  explicit Lines(const std::string& text) : stream_(text) {}

  [[nodiscard]] int number() const { return number_; }
  bool is(const std::string& expected) { return next() && line_ == expected; }
  template <std::size_t N>
  std::optional<std::array<double, N>> values(const char* word) {
    if (!next()) return std::nullopt;
    std::istringstream line(line_);
    std::string found;
    std::array<double, N> values{};
    line >> found;
    for (double& value : values)
      if (!(line >> value) || !is_possible(value)) return std::nullopt;
    if (found != word || line >> found) return std::nullopt;
    return values;
  }

 private:
  bool next() {
    ++number_;
    return static_cast<bool>(std::getline(stream_, line_));
  }
  std::istringstream stream_;
  std::string line_;
  int number_ = 0;
};

bool is_count(double value) {
  return value >= 0.0 && value <= kMostControls && value == std::floor(value);
}

std::optional<WarpField> read_field(Lines& lines) {
  WarpField field;
  const auto head = lines.values<5>("field");
  if (!head) return std::nullopt;
  const auto& [x, y, spacing, width, height] = *head;
  if (!is_count(width) || !is_count(height) || width * height > kMostControls || spacing <= 0.0)
    return std::nullopt;
  field.origin = {x, y};
  field.spacing_m = spacing;
  field.width = static_cast<int>(width);
  field.height = static_cast<int>(height);
  for (int p = 0; p < field.width * field.height; ++p) {
    const auto control = lines.values<3>("control");
    if (!control || (*control)[2] < 0.0) return std::nullopt;
    field.control_m.push_back((*control)[0]);
    field.control_m.push_back((*control)[1]);
    field.sigma_m.push_back((*control)[2]);
  }
  if (steepest_step_m(field) > 0.5 * field.spacing_m) return std::nullopt;  // folds
  return field;
}

std::optional<WarpFit> read_fit(Lines& lines, std::size_t walls) {
  const auto similarity = lines.values<4>("similarity");
  if (!similarity || (*similarity)[0] <= 0.0 || !is_possible(1.0 / (*similarity)[0])) return std::nullopt;
  const auto s = lines.values<5>("statistics");
  if (!s || (*s)[0] <= 0.0 || (*s)[1] <= 0.0 || (*s)[2] <= 0.0 || (*s)[3] <= 0.0) return std::nullopt;
  const auto found = lines.values<3>("fit");
  if (!found) return std::nullopt;
  std::optional<WarpField> field = read_field(lines);
  if (!field) return std::nullopt;
  WarpFit fit;
  fit.residual_m = (*found)[0];
  fit.evidence_nats = (*found)[1];
  fit.walls_seen = (*found)[2];
  fit.warp = DrawingWarp({(*similarity)[0], (*similarity)[1], (*similarity)[2], (*similarity)[3]},
                         std::move(*field), {(*s)[0], (*s)[1], (*s)[2], (*s)[3], (*s)[4]});
  for (std::size_t i = 0; i < walls; ++i) {
    const auto w = lines.values<8>("wall");
    if (!w || (*w)[1] < 0.0 || (*w)[2] < 0.0 || (*w)[5] < 0.0 || (*w)[6] < 0.0) return std::nullopt;
    fit.walls.push_back({{{{(*w)[0], (*w)[1], (*w)[2], (*w)[3]}, {(*w)[4], (*w)[5], (*w)[6], (*w)[7]}}}});
  }
  return fit;
}

}  // namespace

std::string warp_text(const WarpFit& fit, const mapping::Walls& drawn) {
  std::string text(kHeader);
  text += "\nwalls " + mapping::walls_fingerprint(drawn) + '\n';
  const WarpSimilarity& s = fit.warp.similarity();
  const WarpStatistics& t = fit.warp.statistics();
  const WarpField& f = fit.warp.field();
  append(text, "similarity", std::array{s.scale, s.yaw_rad, s.x_m, s.y_m});
  append(text, "statistics", std::array{t.amplitude_m, t.range_m, t.offset_m, t.residual_m, t.inliers});
  append(text, "fit", std::array{fit.residual_m, fit.evidence_nats, fit.walls_seen});
  append(text, "field",
         std::array{f.origin.x_m, f.origin.y_m, f.spacing_m, static_cast<double>(f.width),
                    static_cast<double>(f.height)});
  for (std::size_t p = 0; p < f.sigma_m.size(); ++p)
    append(text, "control", std::array{f.control_m[2 * p], f.control_m[2 * p + 1], f.sigma_m[p]});
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const auto& [a, b] = i < fit.walls.size() ? fit.walls[i].sides : WallDeviation{}.sides;
    append(
        text, "wall",
        std::array{a.offset_m, a.sigma_m, a.seen_m, a.inliers, b.offset_m, b.sigma_m, b.seen_m, b.inliers});
  }
  return text + "end\n";
}

std::string load_warp(const std::filesystem::path& file, const mapping::Walls& drawn, WarpFit& fit) {
  if (!std::filesystem::exists(file)) return "";
  const std::string anew = " - how the building differs from the drawing is learned anew while driving";
  Lines lines(mapping::file_content(file));
  const auto damaged = [&] {
    return file.string() + ":" + std::to_string(lines.number()) + ": is damaged" + anew;
  };
  if (!lines.is(kHeader)) return damaged();
  if (!lines.is("walls " + mapping::walls_fingerprint(drawn)))
    return file.string() + ": the walls have changed since" + anew;
  std::optional<WarpFit> found = read_fit(lines, drawn.size());
  if (!found || !lines.is("end")) return damaged();
  fit = std::move(*found);
  return "";
}

void save_warp(const std::filesystem::path& file, const WarpFit& fit, const mapping::Walls& drawn) {
  std::filesystem::create_directories(file.parent_path());
  mapping::write_file_atomically(file, warp_text(fit, drawn));
}

}  // namespace madori::localization
