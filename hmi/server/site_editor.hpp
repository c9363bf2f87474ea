#pragma once

#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hmi/server/revisions.hpp"
#include "hmi/server/vehicle.hpp"

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
  /// SiteRevisions of hmi/schema; never waits for an edit or an import.
  [[nodiscard]] nlohmann::json revisions() const;
  /// The five steps of Setup, with what is still missing.
  [[nodiscard]] nlohmann::json setup_steps(const PoseEstimate& pose) const;
  /// VehicleEdit -> Saved
  nlohmann::json save_vehicle(const nlohmann::json& edit);
  [[nodiscard]] nlohmann::json walls() const;
  /// WallsEdit -> Saved
  nlohmann::json save_walls(const nlohmann::json& edit);
  /// PNG bytes; kept until the drawing changes.
  [[nodiscard]] std::string drawing_png();

  [[nodiscard]] nlohmann::json routes() const;
  /// RoutesEdit -> Routes with findings, nothing is saved.
  [[nodiscard]] nlohmann::json check_routes(const nlohmann::json& edit) const;
  /// RoutesEdit -> Routes with the way driven in them and findings, nothing is saved. Throws Error where too
  /// little was driven to be a route.
  [[nodiscard]] nlohmann::json teach_routes(const nlohmann::json& edit,
                                            const std::vector<planning::DrivenPose>& way) const;
  nlohmann::json save_routes(const nlohmann::json& edit);
  /// RoutesCsv: the two published files, kept byte for byte when they can be read.
  nlohmann::json import_routes(const nlohmann::json& csv);
  /// RoutesCsv, byte for byte; empty texts where there are no routes yet.
  [[nodiscard]] nlohmann::json routes_csv() const;
  /// "tree.csv" or "path.csv" as they lie on the disk.
  [[nodiscard]] std::string routes_file(const std::string& name) const;

 private:
  void require_revision(const nlohmann::json& edit, const std::string& newest) const;

  std::filesystem::path folder_;
  RevisionWatch watch_;
  mutable std::mutex mutex_;  ///< of the files
  std::mutex picture_mutex_;
  std::string drawing_of_;  ///< the revision that drawing_ shows
  std::string drawing_;
};

}  // namespace madori::hmi
