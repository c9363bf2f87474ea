#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Counts what one thread asks of the heap: malloc, calloc, realloc, aligned_alloc and posix_memalign of the
/// whole program (operator new comes down to them). To link it in is to count.
namespace madori::allocations {

/// Where memory was asked for: the innermost return addresses, and how often.
struct Site {
  std::vector<void*> frames;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;
};

/// The calling thread's requests count from here on, or no longer.
void count_here(bool on);
/// Requests of the threads that counted, since the program began or forget().
[[nodiscard]] std::uint64_t counted();
void forget();
/// The most frequent first. Not while anybody counts.
[[nodiscard]] std::vector<Site> sites();
/// The functions of the program's own on the way to a site, the innermost first, `most` of them.
[[nodiscard]] std::string named(const Site& site, int most);

}  // namespace madori::allocations
