#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace madori::app {

/// `madori run` as a service of systemd.
struct ServiceOptions {
  std::filesystem::path site;            ///< absolute
  std::filesystem::path program;         ///< absolute
  std::string user;                      ///< who it runs as; needs to be able to write the site
  std::vector<std::string> run_options;  ///< of `madori run`, handed on as they are
};

/// The unit file. Started again when it ends or hangs (5 s), before ordinary work, with nothing of the
/// computer to write but its site and nothing to open but its devices (systemd.exec(5), systemd.service(5)).
[[nodiscard]] std::string service_unit(const ServiceOptions& options);

/// The same word in a command of systemd's: quoted, and nothing in it replaced.
[[nodiscard]] std::string quoted_for_systemd(const std::string& word);

}  // namespace madori::app
