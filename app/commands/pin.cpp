#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "core/result.hpp"
#include "hmi/server/access.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct PinArguments {
  std::string site;
  std::string role;
};

/// What is typed is not shown, as long as it lives.
class HiddenTyping {
 public:
  HiddenTyping() : terminal_(::isatty(STDIN_FILENO) == 1 && ::tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!terminal_) return;
    termios hidden = before_;
    hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &hidden);
  }
  ~HiddenTyping() {
    if (terminal_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  }
  HiddenTyping(const HiddenTyping&) = delete;
  HiddenTyping& operator=(const HiddenTyping&) = delete;

  [[nodiscard]] bool at_terminal() const { return terminal_; }

 private:
  termios before_{};
  bool terminal_;
};

/// Read from stdin: an argument would stand in the list of processes and in the shell's history.
std::string ask(const char* prompt) {
  const HiddenTyping typing;
  if (typing.at_terminal()) std::fputs(prompt, stderr);
  std::string pin;
  std::getline(std::cin, pin);
  if (typing.at_terminal()) std::fputc('\n', stderr);
  return pin;
}

void set_pin(const PinArguments& arguments) {
  const auto role = hmi::role_from(arguments.role);
  if (!role) throw Error("role " + arguments.role, "is not known", "use viewer, operator or integrator");
  fs::create_directories(arguments.site);
  hmi::Access access(fs::path(arguments.site) / "pins", true,
                     [] { return std::chrono::steady_clock::now(); });
  const std::string pin = ask("PIN: ");
  if (::isatty(STDIN_FILENO) == 1 && ask("once more: ") != pin)
    throw Error("PIN", "was typed in two ways", "try again");
  access.set_pin(*role, pin);
  std::printf("the PIN of the %s is set; a panel that is served already takes it after a restart\n",
              arguments.role.c_str());
}

}  // namespace

void add_pin(CLI::App& app) {
  auto arguments = std::make_shared<PinArguments>();
  CLI::App* command = app.add_subcommand("pin", "set a role's PIN of the touch panel, read from stdin");
  command->add_option("DIR", arguments->site, "site folder")->required();
  command->add_option("ROLE", arguments->role, "viewer, operator or integrator")->required();
  command->callback([arguments] { set_pin(*arguments); });
}

}  // namespace madori::app
