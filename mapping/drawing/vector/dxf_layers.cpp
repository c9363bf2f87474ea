#include "mapping/drawing/vector/dxf_layers.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace madori::mapping {
namespace {

struct Folded {
  std::string plain;   ///< lower case, accented letters without their accents (UTF-8 in, ASCII where known)
  std::string marked;  ///< and ^ where a word begins (also at a change of case), $ where one ends
};

Folded folded(std::string_view name) {
  static constexpr std::array<std::string_view, 28> kAccents{
      "ä", "ae", "ö", "oe", "ü", "ue", "Ä", "Ae", "Ö", "Oe", "Ü", "Ue", "ß", "ss",
      "é", "e",  "è", "e",  "ô", "o",  "å", "a",  "ñ", "n",  "ó", "o",  "í", "i"};
  std::string text;
  while (!name.empty()) {
    std::size_t at = 0;
    while (at < kAccents.size() && !name.starts_with(kAccents[at])) at += 2;
    const std::string_view first = at < kAccents.size() ? kAccents[at] : name.substr(0, 1);
    text += at < kAccents.size() ? kAccents[at + 1] : first;
    name.remove_prefix(first.size());
  }
  const auto is = [&](std::size_t at, char low, char high) {
    return at < text.size() && text[at] >= low && text[at] <= high;
  };
  const auto letter = [&](std::size_t at) { return is(at, 'A', 'Z') || is(at, 'a', 'z'); };
  Folded out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool capital = is(i, 'A', 'Z'), inside = i > 0 && letter(i - 1);
    const bool turns = inside && capital && (is(i - 1, 'a', 'z') || is(i + 1, 'a', 'z'));
    out.marked += turns ? "$^" : letter(i) && !inside ? "^" : "";
    out.plain += capital ? static_cast<char>(text[i] - 'A' + 'a') : text[i];
    out.marked += out.plain.back();
    if (letter(i) && !letter(i + 1)) out.marked += '$';
  }
  return out;
}

struct Word {
  std::string_view part;
  RejectReason reason;
};

/// Stronger than "wall": a hatch, a dimension or an opening of a wall is none. German joins its words and
/// Japanese parts none, so theirs count anywhere; a short one stands in too many others (infill, indoor,
/// textile) and counts where it begins or ends a word.
constexpr std::array<Word, 41> kNever{
    {{"hatch", RejectReason::Hatch},         {"schraff", RejectReason::Hatch},
     {"^patt", RejectReason::Hatch},         {"pattern", RejectReason::Hatch},
     {"^fill", RejectReason::Hatch},         {"wallfill", RejectReason::Hatch},
     {"dim$", RejectReason::Dimension},      {"dims$", RejectReason::Dimension},
     {"dimlin", RejectReason::Dimension},    {"dimension", RejectReason::Dimension},
     {"bemass", RejectReason::Dimension},    {"^cota", RejectReason::Dimension},
     {"acota", RejectReason::Dimension},     {"^cote$", RejectReason::Dimension},
     {"^cotes$", RejectReason::Dimension},   {"寸法", RejectReason::Dimension},
     {"text$", RejectReason::Text},          {"texts$", RejectReason::Text},
     {"texte$", RejectReason::Text},         {"txt", RejectReason::Text},
     {"^anno", RejectReason::Text},          {"note$", RejectReason::Text},
     {"notes$", RejectReason::Text},         {"^iden", RejectReason::Text},
     {"文字", RejectReason::Text},           {"^door", RejectReason::DoorArc},
     {"tuer", RejectReason::DoorArc},        {"opening", RejectReason::DoorArc},
     {"window", RejectReason::DoorArc},      {"fenster", RejectReason::DoorArc},
     {"glaz", RejectReason::DoorArc},        {"ドア", RejectReason::DoorArc},
     {"title", RejectReason::TitleBlock},    {"titel", RejectReason::TitleBlock},
     {"^border$", RejectReason::TitleBlock}, {"^borders$", RejectReason::TitleBlock},
     {"rahmen", RejectReason::TitleBlock},   {"ttlb", RejectReason::TitleBlock},
     {"図枠", RejectReason::TitleBlock},     {"defpoint", RejectReason::Other},
     {"viewport", RejectReason::Other}}};

constexpr std::array<std::string_view, 18> kWalls{
    "wall",   "wand", "waend", "mauer", "mur",   "muur",  "cloison",   "pared", "parede",
    "parete", "vegg", "vaegg", "seina", "scian", "stena", "partition", "壁",    "facade"};
constexpr std::array<std::string_view, 10> kColumns{"column", "s-cols", "a-cols",       "stuetz", "saeul",
                                                    "pillar", "pilar",  "stahltraeger", "poteau", "柱"};

constexpr std::array<Word, 36> kOthers{
    {{"furn", RejectReason::Furniture},    {"moeb", RejectReason::Furniture},
     {"^mobil", RejectReason::Furniture},  {"couch", RejectReason::Furniture},
     {"bench", RejectReason::Furniture},   {"^table", RejectReason::Furniture},
     {"^tisch", RejectReason::Furniture},  {"chair", RejectReason::Furniture},
     {"^shelf", RejectReason::Furniture},  {"^shelv", RejectReason::Furniture},
     {"regal", RejectReason::Furniture},   {"^rack", RejectReason::Furniture},
     {"equip", RejectReason::Furniture},   {"^mach", RejectReason::Furniture},
     {"maschin", RejectReason::Furniture}, {"^case", RejectReason::Furniture},
     {"fixt", RejectReason::Furniture},    {"plumb", RejectReason::Furniture},
     {"sanit", RejectReason::Furniture},   {"stair", RejectReason::Furniture},
     {"trepp", RejectReason::Furniture},   {"機械", RejectReason::Furniture},
     {"^axis", RejectReason::Dimension},   {"^axes", RejectReason::Dimension},
     {"achse", RejectReason::Dimension},   {"grid", RejectReason::Dimension},
     {"raster", RejectReason::Dimension},  {"^crane", RejectReason::Other},
     {"kran$", RejectReason::Other},       {"^lane", RejectReason::Other},
     {"luft", RejectReason::Other},        {"^elec", RejectReason::Other},
     {"^light", RejectReason::Other},      {"hvac", RejectReason::Other},
     {"kranbahn", RejectReason::Other},    {"querbalken", RejectReason::Other}}};

bool holds(const Folded& name, std::string_view part) {
  const bool whole = part.find_first_of("^$") != std::string_view::npos;
  return (whole ? name.marked : name.plain).find(part) != std::string::npos;
}

}  // namespace

LayerMeaning layer_meaning(const std::string& name) {
  const Folded words = folded(std::string_view(name).substr(name.find_last_of("$|") + 1));
  const bool wall = std::ranges::any_of(kWalls, [&](auto part) { return holds(words, part); });
  for (const auto& [part, reason] : kNever)
    if (holds(words, part)) return {LayerKind::NoWall, reason, wall};
  if (wall) return {LayerKind::Wall};
  for (const auto& part : kColumns)
    if (holds(words, part)) return {LayerKind::Column};
  for (const auto& [part, reason] : kOthers)
    if (holds(words, part)) return {LayerKind::NoWall, reason};
  return {};
}

}  // namespace madori::mapping
