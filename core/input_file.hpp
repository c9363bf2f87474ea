#pragma once

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>

#include "core/failure_words.hpp"
#include "core/result.hpp"

/// How readers of text open what an operator gives them: with limits that no honest file comes near, and one
/// line that says which one was passed.
namespace madori {

/// The ending of its name, ".pdf", also of one in capitals.
inline std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Throws Error unless `file` is a regular file (links are followed) of at most `most_bytes` that may be
/// read. `mend`: where there is none.
inline void require_readable(const std::filesystem::path& file, std::uintmax_t most_bytes,
                             const std::string& mend = "check the path and its permissions") {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(file.string(), "cannot be opened", mend);
  if (!error && ::access(file.c_str(), R_OK) != 0) error.assign(errno, std::generic_category());
  if (error) throw Error(file.string(), "cannot be read: " + error.message(), remedy_of(error));
  if (std::filesystem::is_directory(status)) throw Error(file.string(), "is a folder, not a file", mend);
  if (!std::filesystem::is_regular_file(status))
    throw Error(file.string(), "is no regular file", "give a file on a disk");
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) throw Error(file.string(), "cannot be read: " + error.message(), mend);
  if (bytes > most_bytes)
    throw Error(file.string(),
                "has " + std::to_string(bytes) + " bytes, more than " + std::to_string(most_bytes),
                "is it the right file?");
}

/// A text file line by line, as std::getline does. Throws Error, with the line, where one is longer than
/// `most_bytes`.
inline bool next_line(std::istream& stream, std::string& line, const std::string& file, int number,
                      std::size_t most_bytes = 1'000'000) {
  line.clear();
  for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
    if (c == '\n') return true;
    if (line.size() == most_bytes)
      throw Error(file + ":" + std::to_string(number),
                  "the line is longer than " + std::to_string(most_bytes) + " bytes",
                  "is it the right file?");
    line.push_back(static_cast<char>(c));
  }
  if (line.empty()) return false;
  stream.clear(stream.rdstate() & ~std::ios::failbit);  // the last line has no end
  return true;
}

}  // namespace madori
