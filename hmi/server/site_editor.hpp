#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace madori::hmi {

/// Somebody else saved first: the revision that an edit is based on is no longer the newest.
class Conflict : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "somebody else changed this meanwhile"; }
};

/// The site folder as the panel edits it, in the wire types of hmi/schema. A revision is a hash of the files,
/// so that it survives a restart. Every save is one atomic step. All members may be called from any thread;
/// they throw Error and Conflict.
class SiteEditor {
 public:
  explicit SiteEditor(std::filesystem::path folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] nlohmann::json site() const;
  [[nodiscard]] nlohmann::json walls() const;
  /// WallsEdit -> Saved
  nlohmann::json save_walls(const nlohmann::json& edit);
  /// PNG bytes; kept until the drawing changes.
  [[nodiscard]] std::string drawing_png();

  [[nodiscard]] nlohmann::json routes() const;
  /// RoutesEdit -> Routes with findings, nothing is saved.
  [[nodiscard]] nlohmann::json check_routes(const nlohmann::json& edit) const;
  nlohmann::json save_routes(const nlohmann::json& edit);
  /// RoutesCsv: the two published files, kept byte for byte when they can be read.
  nlohmann::json import_routes(const nlohmann::json& csv);
  /// "tree.csv" or "path.csv" as they lie on the disk.
  [[nodiscard]] std::string routes_file(const std::string& name) const;

 private:
  [[nodiscard]] std::string walls_revision() const;
  [[nodiscard]] std::string routes_revision() const;
  void require_revision(const nlohmann::json& edit, const std::string& newest) const;

  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::string drawing_of_;  ///< the revision that drawing_ shows
  std::string drawing_;
};

}  // namespace madori::hmi
