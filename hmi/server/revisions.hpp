#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "mapping/site/file_identity.hpp"

namespace madori::hmi {

/// Short names of what a site's files hold (BLAKE2b): they change with every save, whoever saves, and survive
/// a restart.
struct SiteRevisions {
  std::string drawing;  ///< file, pixel grid and scale
  std::string walls;
  std::string routes;
  std::string vehicle;  ///< and sensors

  friend bool operator==(const SiteRevisions&, const SiteRevisions&) = default;
};

[[nodiscard]] std::string walls_revision(const std::filesystem::path& site);
[[nodiscard]] std::string routes_revision(const std::filesystem::path& site);
/// Of site.yaml; equal for sites without one. Throws Error on a malformed one.
[[nodiscard]] std::string drawing_revision(const std::filesystem::path& site);
[[nodiscard]] std::string vehicle_revision(const std::filesystem::path& site);

/// All of them, worked out again only when a file was touched: cheap enough for every message of the live
/// socket, and waits for nobody: in the middle of a change they are those of before. May be called from any
/// thread. A malformed site.yaml has the revision "unreadable".
class RevisionWatch {
 public:
  explicit RevisionWatch(std::filesystem::path site) : site_(std::move(site)) {}
  [[nodiscard]] SiteRevisions now() const;

 private:
  std::filesystem::path site_;
  mutable std::mutex mutex_;
  mutable std::optional<mapping::SiteIdentity> touched_;
  mutable SiteRevisions last_;
};

}  // namespace madori::hmi
