#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace madori::mapping {

/// A mapping of a YAML file that is read key by key. Unknown keys, wrong types and values out of range are
/// refused with file and line; nothing is replaced by a default in silence.
class StrictYaml {
 public:
  /// The top mapping of a file. Throws Error when it cannot be read or is no mapping.
  static StrictYaml load(const std::filesystem::path& file);
  StrictYaml(std::string file, std::string name, const YAML::Node& node);

  [[nodiscard]] bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }
  [[nodiscard]] const YAML::Node& node() const { return node_; }

  /// A required number in [low, high]; throws Error.
  double number(const std::string& key, double low, double high);
  /// The same with the documented default where the key is absent.
  double number_or(const std::string& key, double fallback, double low, double high);
  int integer(const std::string& key, int low, int high);
  int integer_or(const std::string& key, int fallback, int low, int high);
  bool boolean_or(const std::string& key, bool fallback);
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& fallback);
  /// A required mapping below this one.
  StrictYaml section(const std::string& key);
  /// The items of a list of mappings; empty where the key is absent.
  std::vector<StrictYaml> list(const std::string& key);
  /// The items of a list, the pairs of a mapping; none where the key is absent.
  std::vector<std::string> texts(const std::string& key);
  std::vector<double> numbers(const std::string& key);
  std::map<std::string, std::string> pairs(const std::string& key);
  /// A raw value, marked as known.
  YAML::Node raw(const std::string& key);

  /// Throws Error on the first key that nobody asked for.
  void refuse_unknown_keys() const;
  /// The error of a value of this mapping: "file:line: section.key: what - mend".
  [[nodiscard]] Error error(const std::string& key, const std::string& what,
                            const std::string& mend = "") const;

 private:
  template <class T>
  T get(const std::string& key, const char* kind);

  std::string file_;
  std::string name_;
  YAML::Node node_;
  std::set<std::string> known_;
};

}  // namespace madori::mapping
