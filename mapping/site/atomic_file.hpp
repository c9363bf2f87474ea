#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace madori::mapping {

/// Writes the whole file or leaves the old one: temporary file beside it, fsync, rename, fsync of the folder.
/// A symbolic link stays: the file that it leads to is replaced. What is no regular file (a device, a pipe)
/// is never replaced: it is written into. Who may read and write it may still; a secret is its owner's from
/// its first byte on. Throws Error (disk full, no permission) and leaves no temporary file.
enum class Secrecy { None, OwnerOnly };
void write_file_atomically(const std::filesystem::path& file, std::string_view content,
                           Secrecy secrecy = Secrecy::None);
void write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> content);

/// Throws the Error that write_file_atomically() would throw of a path that cannot be written; writes
/// nothing.
void expect_writable(const std::filesystem::path& file);

/// Writes a file that nobody reads yet; neither atomic nor synced. Throws Error as above, with nothing left.
void write_new_file(const std::filesystem::path& file, std::string_view content);

/// All bytes of a file; empty where there is none. Throws Error where it cannot be read.
[[nodiscard]] std::string file_content(const std::filesystem::path& file);

}  // namespace madori::mapping
