#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "app/commands.hpp"
#include "core/failure_words.hpp"
#include "core/result.hpp"

namespace {

/// Whether everything that was printed has gone out. Throws Error where it has not: a full disk, a closed
/// pipe.
void finish_stdout() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return;
  throw madori::Error("standard output",
                      std::string("could not be written to its end: ") + std::strerror(errno),
                      "make room where it goes, or let it be read to its end");
}

/// What a library says on several lines.
std::string on_one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}

}  // namespace

/// Exit status: 0 done, 1 failed (one line says what, where and how to mend it), 2 wrong usage.
int main(int argc, char** argv) {
  CLI::App app("Madori: a factory vehicle drives from the drawing of the factory", "madori");
  app.require_subcommand(0, 1);  // else it asked for one instead of naming the word that is none
  madori::app::add_braking_test(app);
  madori::app::add_demo(app);
  madori::app::add_evaluate(app);
  madori::app::add_landmarks(app);
  madori::app::add_localize(app);
  madori::app::add_map(app);
  madori::app::add_diff(app);
  madori::app::add_export(app);
  madori::app::add_versions(app);
  madori::app::add_import(app);
  madori::app::add_relocalize(app);
  madori::app::add_route(app);
  madori::app::add_order(app);
  madori::app::add_pin(app);
  madori::app::add_replay(app);
  madori::app::add_run(app);
  madori::app::add_scale(app);
  madori::app::add_service(app);
  madori::app::add_sim(app);
  madori::app::add_tiles(app);
  madori::app::add_doctor(app);
  madori::app::add_record(app);
  madori::app::add_version(app);
  // A file that has reached its limit is a write that fails, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  // So is a pipe that nobody reads any more: what the command did until then has to be said.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    try {
      app.parse(argc, argv);
      if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    } catch (const CLI::ParseError& e) {
      const auto words = app.remaining();
      if (app.get_subcommands().empty() && !words.empty()) {
        std::fprintf(stderr, "madori: %s: is no command - madori --help lists them\n", words.front().c_str());
        return 2;
      }
      if (app.exit(e) != 0) return 2;
    }
    finish_stdout();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "madori: %s\n", on_one_line(madori::failure_words(e)).c_str());
    return 1;
  }
  return 0;
}
