#include "mapping/drawing/vector/dxf_units.hpp"

#include <array>
#include <cmath>
#include <sstream>

#include "core/median.hpp"

namespace madori::mapping {
namespace {

struct Unit {
  int insunits;
  double metres;
  const char* name;
  const char* word;
  bool metric;
};
constexpr std::array<Unit, 7> kUnits{{{4, 0.001, "millimetres", "mm", true},
                                      {5, 0.01, "centimetres", "cm", true},
                                      {14, 0.1, "decimetres", "dm", true},
                                      {6, 1.0, "metres", "m", true},
                                      {1, 0.0254, "inches", "in", false},
                                      {2, 0.3048, "feet", "ft", false},
                                      {10, 0.9144, "yards", "yd", false}}};

constexpr double kShortestBuildingM = 3, kLongestBuildingM = 2000;

/// How well a unit explains the drawing; negative where it cannot.
int score(const Unit& unit, const DxfUnitEvidence& evidence) {
  const double length_m = evidence.extent * unit.metres;
  if (!(length_m >= kShortestBuildingM && length_m <= kLongestBuildingM)) return -1;
  int points = unit.insunits == 14 || unit.insunits == 10 ? -1 : 0;  // hardly anybody draws in them
  points += length_m >= 8.0 && length_m <= 300.0 ? 1 : 0;
  if (evidence.insunits == unit.insunits) points += 4;
  if (evidence.measurement && (*evidence.measurement == 1) == unit.metric) points += 1;
  if (evidence.imperial_texts) points += unit.metric ? -4 : unit.insunits == 1 ? 5 : 4;
  std::vector<double> radii = evidence.door_radii;
  if (!radii.empty()) {
    const double door_m = median_of(radii) * unit.metres;
    points += door_m >= 0.55 && door_m <= 1.5 ? 3 : -3;
  }
  return points;
}

std::string note_of(const Unit& unit, const DxfUnitEvidence& evidence) {
  std::ostringstream note;
  note << "drawing units are " << unit.name << ": ";
  if (evidence.insunits == unit.insunits)
    note << "$INSUNITS says so";
  else if (evidence.insunits && *evidence.insunits != 0)
    note << "$INSUNITS says otherwise, but no building comes out of it";
  else
    note << "the file does not say, this is the most plausible";
  note << "; the drawing is " << std::round(evidence.extent * unit.metres * 10.0) / 10.0
       << " m long. Check one length.";
  return note.str();
}

}  // namespace

std::optional<DxfUnit> choose_unit(const DxfUnitEvidence& evidence) {
  const Unit* best = nullptr;
  int most = -1;
  for (const Unit& unit : kUnits) {
    const int points = score(unit, evidence);
    if (points == most) best = nullptr;  // nothing tells the two apart
    if (points <= most) continue;
    most = points;
    best = &unit;
  }
  if (best == nullptr) return std::nullopt;
  return DxfUnit{best->metres, note_of(*best, evidence)};
}

std::optional<DxfUnit> named_unit(const std::string& word) {
  for (const Unit& unit : kUnits)
    if (word == unit.word)
      return DxfUnit{unit.metres, std::string("drawing units are ") + unit.name + ": --unit"};
  return std::nullopt;
}

}  // namespace madori::mapping
