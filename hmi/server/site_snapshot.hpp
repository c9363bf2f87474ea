#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hmi/server/tar_stream.hpp"

namespace madori::hmi {

/// Where a backup has the site's files.
inline constexpr const char* kBackupFolder = "site/";
/// Whether a file of a site, by its name there, belongs into a backup: what its versions keep, what follows
/// from that, and what was learned.
[[nodiscard]] bool is_in_backup(const std::string& name);

/// The files of a site that belong into a backup: all that was set up and learned, and every version. Not
/// PINs, orders, recordings and what this computer's devices are.
[[nodiscard]] std::vector<TarStream::Entry> site_entries(const std::filesystem::path& site);

/// The same, and all of one state of the site, whatever is saved while they are read: what a save replaces is
/// held open. Throws Error on what no backup can be made of.
[[nodiscard]] std::vector<TarStream::Entry> site_snapshot(const std::filesystem::path& site);

}  // namespace madori::hmi
