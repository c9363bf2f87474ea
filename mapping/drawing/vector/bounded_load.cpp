#include "mapping/drawing/vector/bounded_load.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>
#include <string>
#include <type_traits>

#include "core/result.hpp"
#include "mapping/drawing/vector/plan_bytes.hpp"

namespace madori::mapping {
namespace {

using Steady = std::chrono::steady_clock;

constexpr char kPlan = 'P', kRefused = 'E', kMemory = 'M';
constexpr auto kMend = "export it as PNG or PDF from the program that drew it, without what nobody sees";

/// What this process has for data already: the budget comes on top.
std::size_t data_bytes() {
  std::size_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    std::size_t size = 0, resident = 0, shared = 0, text = 0, library = 0;
    if (std::fscanf(file, "%zu %zu %zu %zu %zu %zu", &size, &resident, &shared, &text, &library, &pages) != 6)
      pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// The other process: says one thing and ends, without the destructors of what it shares with its parent.
[[noreturn]] void answer(int descriptor, const std::function<Plan()>& load, const LoadBudget& budget,
                         std::size_t data) {
  const rlimit processor{budget.processor_s, budget.processor_s + 1};
  const rlimit memory{data + budget.bytes, data + budget.bytes};
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CPU, &processor);
  ::setrlimit(RLIMIT_DATA, &memory);
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP, SIGXCPU})
    std::signal(signal, SIG_DFL);
  const int silence = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (silence >= 0) ::dup2(silence, STDERR_FILENO);  // libraries say there what breaks them
  try {
    write_all(descriptor, kPlan + plan_bytes(load()));
  } catch (const std::bad_alloc&) {
    write_all(descriptor, {&kMemory, 1});
  } catch (const std::exception& e) {
    write_all(descriptor, kRefused + std::string(e.what()));
  }
  ::_exit(0);
}

/// Everything that the other process says until it ends or the time is over; false for the latter.
bool hear(int descriptor, double wall_s, std::string& said) {
  const auto end = Steady::now() + std::chrono::duration<double>(wall_s);
  std::array<char, 1 << 16> buffer;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Steady::now()).count();
    pollfd ready{descriptor, POLLIN, 0};
    const int events = left > 0 ? ::poll(&ready, 1, static_cast<int>(left)) : 0;
    if (events < 0 && errno == EINTR) continue;
    if (events <= 0) return false;
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    said.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::string too_long(double seconds) {
  return "takes more than " + std::to_string(static_cast<int>(seconds)) + " s to read";
}

/// Why it ended without a word.
std::string broke_down(int status, const LoadBudget& budget, bool in_time) {
  if (!in_time) return too_long(budget.wall_s);
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return too_long(budget.processor_s);
  return "takes more than " + std::to_string(budget.bytes / 1'000'000) +
         " MB to read, or breaks the library that reads it";
}

}  // namespace

Plan load_bounded(const std::filesystem::path& file, const std::function<Plan()>& load,
                  const LoadBudget& budget) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw Error(file.string(), "cannot be read: too many open files", "");
  const std::size_t data = data_bytes();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe[0]);
    answer(pipe[1], load, budget, data);
  }
  ::close(pipe[1]);
  std::string said;
  const bool in_time = child > 0 && hear(pipe[0], budget.wall_s, said);
  ::close(pipe[0]);
  if (child < 0)
    throw Error(file.string(), "cannot be read: no process can be begun", "close other programs");
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool whole = in_time && WIFEXITED(status) && WEXITSTATUS(status) == 0 && !said.empty();
  if (whole && said.front() == kRefused) throw Error(said.substr(1));
  if (!whole || said.front() != kPlan) throw Error(file.string(), broke_down(status, budget, in_time), kMend);
  return plan_of(std::string_view(said).substr(1));
}

}  // namespace madori::mapping
