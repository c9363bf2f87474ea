#include "mapping/dxf_text/dxf_text.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>

#include "core/result.hpp"
#include "core/utf8.hpp"
#include "mapping/dxf_text/dxf_groups.hpp"

namespace madori::mapping {
namespace {

constexpr std::string_view kByteOrderMarkOfDxf = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r\n\x1A";
constexpr std::string_view kAgain = "save it again as ASCII DXF (R2000 or newer)";

/// The file's end without blanks.
std::string without_blanks(std::string text) {
  return text.erase(text.find_last_not_of(kBlanks) + 1);
}

/// What a person reads as the name of an attached file; one in a code page without what is no ASCII.
std::string shown(std::string path) {
  path.erase(0, path.find_last_of("\\/") + 1);
  if (utf8_end(path) == path.size()) return path;
  std::ranges::replace_if(
      path, [](char c) { return static_cast<unsigned char>(c) > 0x7E; }, '?');
  return path;
}

}  // namespace

DxfText read_dxf_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string(), "cannot be read", "check its permissions");
  DxfGroups groups;
  std::string tail, lines, chunk(1U << 18U, '\0');
  while (stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || stream.gcount() > 0) {
    const std::string_view text(chunk.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.find('\0') != std::string_view::npos)
      throw Error(file.string(), "is a binary DXF or damaged", std::string(kAgain));
    if (tail.empty() && text.starts_with(kByteOrderMarkOfDxf))
      lines = text.substr(kByteOrderMarkOfDxf.size());
    else
      lines += text;
    const std::size_t whole = lines.rfind('\n') + 1;
    groups.add(std::string_view(lines).substr(0, whole));
    lines.erase(0, whole);
    tail += text.substr(text.size() - std::min<std::size_t>(text.size(), 64));
    tail.erase(0, tail.size() - std::min<std::size_t>(tail.size(), 64));
  }
  groups.add(lines);
  if (!without_blanks(tail).ends_with("EOF"))
    throw Error(file.string(), "is no DXF or is cut off", "copy it again, or save it again as ASCII DXF");
  return groups.text();
}

std::vector<std::string> unread_notes(const DxfText& text) {
  std::vector<std::string> notes;
  for (const auto& [kind, count] : text.unread) {
    const bool attached = kind == "IMAGE" || kind.ends_with("UNDERLAY");
    notes.push_back(std::to_string(count) + " " + kind + (count == 1 ? " was" : " were") + " not read: " +
                    (attached ? "import the attached file itself if the walls stand in it"
                              : "explode them, or export to AutoCAD 2000 DXF"));
  }
  for (const auto& reference : text.references)
    notes.push_back("the attached drawing " + shown(reference) +
                    " was not read: bind it (XREF, Bind) and export again");
  return notes;
}

}  // namespace madori::mapping
