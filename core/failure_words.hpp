#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "core/result.hpp"

/// How a failure of the system leaves the house: everything that shows an exception to a person asks here.
namespace madori {

/// What a person can do about what the system refused.
[[nodiscard]] inline std::string remedy_of(const std::error_code& why) {
  const auto is = [&](std::errc kind) { return why == kind; };
  if (is(std::errc::permission_denied) || is(std::errc::operation_not_permitted))
    return "give the user who runs this the right to it, or run this as its owner";
  if (is(std::errc::read_only_file_system))
    return "make the disk writable, or choose a folder on another one";
  if (is(std::errc::no_space_on_device)) return "free some disk space and try again";
  if (is(std::errc::io_error)) return "look at the disk: it fails";
  if (is(std::errc::too_many_files_open) || is(std::errc::too_many_files_open_in_system))
    return "end programs that hold many files open, or allow more of them (ulimit -n)";
  if (is(std::errc::resource_unavailable_try_again) || is(std::errc::not_enough_memory))
    return "end other programs: this computer has no more memory or threads to give";
  return "check the path and its permissions";
}

/// Any exception in one line that a person can act on: of a file, which one, what could not be done with it
/// and what to do; an Error says that itself.
[[nodiscard]] inline std::string failure_words(const std::exception& failure) {
  const std::string said = failure.what();
  if (dynamic_cast<const std::bad_alloc*>(&failure) != nullptr)
    return Error("memory", "this computer has not enough of it", "end other programs and try again").what();
  const auto* system = dynamic_cast<const std::system_error*>(&failure);
  if (system == nullptr) return said;
  const std::string why = system->code().message(), remedy = remedy_of(system->code());
  const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&failure);
  if (file == nullptr) return said + " - " + remedy;
  // The library: "filesystem error: cannot remove: Permission denied [file]", or only "status: ..."
  const auto verb = said.find("cannot "), end = said.find(": " + why);
  const bool tells = verb != std::string::npos && verb < end && end != std::string::npos;
  const std::string what = tells ? said.substr(verb, end - verb) : "cannot be looked at";
  const std::string where = file->path1().empty() ? "the current folder" : file->path1().string();
  return Error(where, what + ": " + why, remedy).what();
}

}  // namespace madori
