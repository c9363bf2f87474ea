#include "mapping/drawing/labelling/wall_model.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "mapping/drawing/labelling/log_odds.hpp"

// The model file becomes read-only data of the library.
asm(".pushsection .rodata\n"
    ".balign 16\n"
    "madori_wall_model: .incbin \"" MADORI_WALL_MODEL
    "\"\n"
    "madori_wall_model_end: .byte 0\n"
    ".popsection\n");
extern "C" const char madori_wall_model[];
extern "C" const char madori_wall_model_end[];

namespace madori::mapping {
namespace {

constexpr std::string_view kKind = "madori-walls-4";

WallModel from_bytes(const std::string& name, std::string_view content) {
  ModelBytes bytes(name, content);
  std::string kind;
  bytes.take_line(kind);
  bytes.demand(kind == kKind);
  Calibration calibration;
  bytes.take_line(calibration.slope, calibration.offset);
  Forest first = Forest::read(bytes);
  return {std::move(first), Forest::read(bytes), calibration};
}

}  // namespace

WallModel WallModel::load(const std::filesystem::path& file) {
  require_readable(file, 64'000'000);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string(), "cannot be opened", "name a model that train_walls wrote");
  return from_bytes(file.string(), std::string{std::istreambuf_iterator<char>(stream), {}});
}

const WallModel& WallModel::shipped() {
  static const WallModel model = from_bytes("the wall model", {madori_wall_model, madori_wall_model_end});
  return model;
}

double WallModel::told(double judged) const {
  return probability_of(calibration_.slope * log_odds(judged, 1e-9) + calibration_.offset);
}

std::string WallModel::bytes() const {
  return fmt::format("{}\n{:.4f} {:.4f}\n", kKind, calibration_.slope, calibration_.offset) + first_.bytes() +
         second_.bytes();
}

}  // namespace madori::mapping
