#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "app/commands.hpp"

/// Exit status: 0 done, 1 failed (one line says what, where and how to mend it), 2 wrong usage.
int main(int argc, char** argv) {
  CLI::App app("Madori: a factory vehicle drives from the drawing of the factory", "madori");
  app.require_subcommand(1);
  madori::app::add_demo(app);
  madori::app::add_evaluate(app);
  madori::app::add_landmarks(app);
  madori::app::add_localize(app);
  madori::app::add_map(app);
  madori::app::add_export(app);
  madori::app::add_import(app);
  madori::app::add_relocalize(app);
  madori::app::add_route(app);
  madori::app::add_order(app);
  madori::app::add_pin(app);
  madori::app::add_replay(app);
  madori::app::add_run(app);
  madori::app::add_scale(app);
  madori::app::add_sim(app);
  madori::app::add_tiles(app);
  madori::app::add_doctor(app);
  madori::app::add_record(app);
  madori::app::add_version(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "madori: %s\n", e.what());
    return 1;
  }
  return 0;
}
