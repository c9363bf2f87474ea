#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/commands.hpp"

namespace madori::app {

void add_version(CLI::App& app) {
  app.add_subcommand("version", "print the version")->callback([] { std::puts("madori " MADORI_VERSION); });
}

}  // namespace madori::app
