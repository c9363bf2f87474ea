#pragma once

#include <filesystem>

namespace madori::hmi {

/// Writes the site as one tar file, whole or not at all. Throws Error.
void write_backup(const std::filesystem::path& site, const std::filesystem::path& file);

/// Whether a file is such a backup.
[[nodiscard]] bool is_backup(const std::filesystem::path& file);

/// Makes the site of a backup, in one atomic step; returns how many files came. A folder that is a site
/// already is refused unless `replace`: then the site becomes what the backup was, and its own versions stay
/// before the backup's. Throws Error on anything that is no whole backup, and on walls or routes that no
/// command would read, with nothing changed.
std::size_t read_backup(const std::filesystem::path& file, const std::filesystem::path& site, bool replace);

}  // namespace madori::hmi
