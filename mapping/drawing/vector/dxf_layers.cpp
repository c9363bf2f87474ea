#include "mapping/drawing/vector/dxf_layers.hpp"

#include <array>
#include <string_view>

namespace madori::mapping {
namespace {

/// Lower case; the accented letters of layer names without their accents (UTF-8 in, ASCII out where known).
std::string folded(std::string_view name) {
  static constexpr std::array<std::string_view, 28> kAccents{
      "ä", "ae", "ö", "oe", "ü", "ue", "Ä", "ae", "Ö", "oe", "Ü", "ue", "ß", "ss",
      "é", "e",  "è", "e",  "ô", "o",  "å", "a",  "ñ", "n",  "ó", "o",  "í", "i"};
  std::string out;
  while (!name.empty()) {
    std::size_t at = 0;
    while (at < kAccents.size() && !name.starts_with(kAccents[at])) at += 2;
    const bool accent = at < kAccents.size();
    const char c = name.front();
    if (accent) out += kAccents[at + 1];
    if (!accent) out.push_back(c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
    name.remove_prefix(accent ? kAccents[at].size() : 1);
  }
  return out;
}

struct Word {
  std::string_view part;
  RejectReason reason;
};

/// Stronger than "wall": a hatch, a dimension or an opening of a wall is none.
constexpr std::array<Word, 30> kNever{
    {{"hatch", RejectReason::Hatch},       {"schraff", RejectReason::Hatch},
     {"patt", RejectReason::Hatch},        {"fill", RejectReason::Hatch},
     {"dim", RejectReason::Dimension},     {"bemass", RejectReason::Dimension},
     {"cota", RejectReason::Dimension},    {"cote", RejectReason::Dimension},
     {"寸法", RejectReason::Dimension},    {"text", RejectReason::Text},
     {"txt", RejectReason::Text},          {"anno", RejectReason::Text},
     {"note", RejectReason::Text},         {"iden", RejectReason::Text},
     {"文字", RejectReason::Text},         {"door", RejectReason::DoorArc},
     {"tuer", RejectReason::DoorArc},      {"opening", RejectReason::DoorArc},
     {"window", RejectReason::DoorArc},    {"fenster", RejectReason::DoorArc},
     {"glaz", RejectReason::DoorArc},      {"ドア", RejectReason::DoorArc},
     {"title", RejectReason::TitleBlock},  {"titel", RejectReason::TitleBlock},
     {"border", RejectReason::TitleBlock}, {"rahmen", RejectReason::TitleBlock},
     {"ttlb", RejectReason::TitleBlock},   {"図枠", RejectReason::TitleBlock},
     {"defpoint", RejectReason::Other},    {"viewport", RejectReason::Other}}};

constexpr std::array<std::string_view, 16> kWalls{"wall",   "wand",   "waend",     "mauer", "mur",   "pared",
                                                  "parede", "parete", "vegg",      "vaegg", "seina", "scian",
                                                  "stena",  "壁",     "partition", "facade"};
constexpr std::array<std::string_view, 10> kColumns{"column", "s-cols", "a-cols",       "stuetz", "saeul",
                                                    "pillar", "pilar",  "stahltraeger", "poteau", "柱"};

constexpr std::array<Word, 34> kOthers{
    {{"furn", RejectReason::Furniture},  {"moeb", RejectReason::Furniture},
     {"mobil", RejectReason::Furniture}, {"couch", RejectReason::Furniture},
     {"bench", RejectReason::Furniture}, {"table", RejectReason::Furniture},
     {"tisch", RejectReason::Furniture}, {"chair", RejectReason::Furniture},
     {"shel", RejectReason::Furniture},  {"regal", RejectReason::Furniture},
     {"rack", RejectReason::Furniture},  {"equip", RejectReason::Furniture},
     {"mach", RejectReason::Furniture},  {"masch", RejectReason::Furniture},
     {"case", RejectReason::Furniture},  {"fixt", RejectReason::Furniture},
     {"plumb", RejectReason::Furniture}, {"sanit", RejectReason::Furniture},
     {"stair", RejectReason::Furniture}, {"trepp", RejectReason::Furniture},
     {"機械", RejectReason::Furniture},  {"axis", RejectReason::Dimension},
     {"axes", RejectReason::Dimension},  {"achs", RejectReason::Dimension},
     {"grid", RejectReason::Dimension},  {"raster", RejectReason::Dimension},
     {"crane", RejectReason::Other},     {"kran", RejectReason::Other},
     {"lane", RejectReason::Other},      {"luft", RejectReason::Other},
     {"elec", RejectReason::Other},      {"light", RejectReason::Other},
     {"hvac", RejectReason::Other},      {"querbalken", RejectReason::Other}}};

bool holds(const std::string& name, std::string_view part) {
  return name.find(part) != std::string::npos;
}

}  // namespace

LayerMeaning layer_meaning(const std::string& name) {
  const std::string plain = folded(std::string_view(name).substr(name.find_last_of("$|") + 1));
  for (const auto& [part, reason] : kNever)
    if (holds(plain, part)) return {LayerKind::NoWall, reason};
  for (const auto& part : kWalls)
    if (holds(plain, part)) return {LayerKind::Wall, RejectReason::Other};
  for (const auto& part : kColumns)
    if (holds(plain, part)) return {LayerKind::Column, RejectReason::Other};
  for (const auto& [part, reason] : kOthers)
    if (holds(plain, part)) return {LayerKind::NoWall, reason};
  return {};
}

}  // namespace madori::mapping
