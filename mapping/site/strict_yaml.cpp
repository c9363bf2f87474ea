#include "mapping/site/strict_yaml.hpp"

#include <yaml-cpp/eventhandler.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "core/input_file.hpp"

namespace madori::mapping {

namespace {

/// Hears whether anything stands in a document, and where it begins.
class Content : public YAML::EventHandler {
 public:
  std::optional<YAML::Mark> begun;

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { hear(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    hear(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {
    hear(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    hear(mark);
  }
  void OnMapEnd() override {}

 private:
  void hear(const YAML::Mark& mark) {
    if (!begun) begun = mark;
  }
};

/// The line, from 1, on which a second document begins; nothing where there is none. YAML::LoadAll would
/// never end on a stray comma, which the parser takes for a document without end.
std::optional<int> second_document(const std::string& text) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  Content first, second;
  if (!parser.HandleNextDocument(first) || !parser.HandleNextDocument(second) || !second.begun)
    return std::nullopt;
  return second.begun->line + 1;
}

}  // namespace

StrictYaml::StrictYaml(std::string file, std::string name, const YAML::Node& node)
    : file_(std::move(file)), name_(std::move(name)), node_(node) {
  if (!node_.IsMap())
    throw Error(file_ + ":" + std::to_string(node_.Mark().line + 1), name_ + " is no list of `key: value`",
                "");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const bool plain = entry.first.IsScalar();
    if (plain && seen.insert(entry.first.Scalar()).second) continue;
    throw Error(file_ + ":" + std::to_string(entry.first.Mark().line + 1),
                plain ? entry.first.Scalar() + ": stands twice" : "a key is no plain word",
                plain ? "remove one of them" : "mend that line");
  }
}

StrictYaml StrictYaml::load(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes =
      1'000'000;  // what YAML of this size takes in memory is a hundred times more
  require_readable(file, kMostBytes);
  try {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error(file.string(), "cannot be opened", "check the path and its permissions");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    if (const auto line = second_document(text))
      throw Error(file.string() + ":" + std::to_string(*line),
                  "begins a second document, which nobody would read", "remove it, or the --- before it");
    return {file.string(), "", YAML::Load(text)};
  } catch (const YAML::Exception& e) {
    throw Error(file.string() + ":" + std::to_string(e.mark.line + 1), "is no valid YAML: " + e.msg,
                "mend that line");
  }
}

Error StrictYaml::error(const std::string& key, const std::string& what, const std::string& mend) const {
  const YAML::Node value = node_[key];
  const int line = (value ? value.Mark().line : node_.Mark().line) + 1;
  return {file_ + ":" + std::to_string(line), (name_.empty() ? key : name_ + "." + key) + ": " + what, mend};
}

template <class T>
T StrictYaml::get(const std::string& key, const char* kind) {
  known_.insert(key);
  const YAML::Node value = node_[key];
  if (!value) throw error(key, "is missing", std::string("add ") + kind);
  try {
    return value.as<T>();
  } catch (const YAML::BadConversion&) {
    throw error(key, std::string("is not ") + kind, "");
  }
}

double StrictYaml::number(const std::string& key, double low, double high) {
  const auto value = get<double>(key, "a number");
  if (!(value >= low && value <= high)) {
    std::ostringstream range;
    range << "must lie between " << low << " and " << high;
    throw error(key, range.str(), "");
  }
  return value;
}

double StrictYaml::number_or(const std::string& key, double fallback, double low, double high) {
  known_.insert(key);
  return has(key) ? number(key, low, high) : fallback;
}

int StrictYaml::integer(const std::string& key, int low, int high) {
  const auto value = get<int>(key, "a whole number");
  if (value < low || value > high)
    throw error(key, "must lie between " + std::to_string(low) + " and " + std::to_string(high), "");
  return value;
}

int StrictYaml::integer_or(const std::string& key, int fallback, int low, int high) {
  known_.insert(key);
  return has(key) ? integer(key, low, high) : fallback;
}

bool StrictYaml::boolean_or(const std::string& key, bool fallback) {
  known_.insert(key);
  return has(key) ? get<bool>(key, "true or false") : fallback;
}

std::string StrictYaml::text(const std::string& key) {
  return get<std::string>(key, "a text");
}

std::string StrictYaml::text_or(const std::string& key, const std::string& fallback) {
  known_.insert(key);
  return has(key) ? text(key) : fallback;
}

StrictYaml StrictYaml::section(const std::string& key) {
  known_.insert(key);
  if (!has(key)) throw error(key, "is missing", "add this section");
  return {file_, name_.empty() ? key : name_ + "." + key, node_[key]};
}

std::vector<StrictYaml> StrictYaml::list(const std::string& key) {
  known_.insert(key);
  std::vector<StrictYaml> items;
  if (!has(key)) return items;
  const YAML::Node value = node_[key];
  if (!value.IsSequence()) throw error(key, "is no list", "begin each item with `- `");
  for (const auto& item : value)
    items.emplace_back(file_, key + "[" + std::to_string(items.size()) + "]", item);
  return items;
}

std::vector<std::string> StrictYaml::texts(const std::string& key) {
  known_.insert(key);
  return has(key) ? get<std::vector<std::string>>(key, "a list of texts") : std::vector<std::string>{};
}

std::vector<double> StrictYaml::numbers(const std::string& key) {
  known_.insert(key);
  return has(key) ? get<std::vector<double>>(key, "a list of numbers") : std::vector<double>{};
}

std::map<std::string, std::string> StrictYaml::pairs(const std::string& key) {
  known_.insert(key);
  if (!has(key)) return {};
  return get<std::map<std::string, std::string>>(key, "a mapping of names to texts");
}

YAML::Node StrictYaml::raw(const std::string& key) {
  known_.insert(key);
  return node_[key];
}

void StrictYaml::refuse_unknown_keys() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (!known_.contains(key)) throw error(key, "is not a known setting", "check its spelling or remove it");
  }
}

}  // namespace madori::mapping
