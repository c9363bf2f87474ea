#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/site_backup.hpp"
#include "hmi/server/site_snapshot.hpp"
#include "hmi/server/tar_stream.hpp"
#include "hmi/server/uploaded_file.hpp"

namespace madori::hmi {
namespace {

/// The same as `madori import BACKUP --force`: what is now remains among the versions.
nlohmann::json restored(const std::filesystem::path& site, const Request& request) {
  const UploadedFile file(".tar", request.body);
  try {
    return {{"files", read_backup(file.path(), site, true)}};
  } catch (const Error& e) {
    throw Error(file.in_words(e.what(), "the backup"));
  }
}

}  // namespace

void add_backup_routes(Router& router, ApiContext& context) {
  const std::filesystem::path site = context.editor.folder();
  // The same file as `madori export --backup` makes.
  router.add(
      "GET", "/api/site/download", Role::Operator,
      [site](const Request&) { return tar_response(site_snapshot(site), "site.tar"); }, Work::Worker);
  router.add("POST", "/api/site/backup", Role::Integrator,
             changing(context.vehicle, [site](const Request& request) { return restored(site, request); }),
             Work::Upload);
}

}  // namespace madori::hmi
