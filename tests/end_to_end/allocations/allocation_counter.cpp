#include "tests/end_to_end/allocations/allocation_counter.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <execinfo.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

// glibc's own, beneath what is replaced here.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* at, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace madori::allocations {
namespace {

constexpr int kFrames = 24;
constexpr std::size_t kSites = 1U << 14;

struct Slot {
  std::array<void*, kFrames> frames;
  int depth;
  std::uint64_t count, bytes;
};

// No allocation of its own: tables that are always there. One thread counts at a time.
std::array<Slot, kSites> slots{};
std::uint64_t all = 0;
thread_local bool counting = false;

Slot& slot_of(const std::array<void*, kFrames>& frames, int depth) {
  std::uintptr_t hash = 0;
  for (int i = 0; i < depth; ++i)
    hash = hash * 1099511628211U ^ reinterpret_cast<std::uintptr_t>(frames[static_cast<std::size_t>(i)]);
  std::size_t at = (hash ^ (hash >> 17)) % kSites;
  for (std::size_t tried = 0; tried + 1 < kSites; ++tried, at = (at + 1) % kSites) {
    Slot& slot = slots[at];
    if (slot.count == 0) {
      slot.frames = frames;
      slot.depth = depth;
      return slot;
    }
    if (slot.depth == depth && slot.frames == frames) return slot;
  }
  return slots[at];
}

void note(std::size_t bytes) {
  if (!counting) return;
  counting = false;  // finding out who asks may itself ask
  ++all;
  std::array<void*, kFrames> frames{};
  const int depth = backtrace(frames.data(), kFrames);
  Slot& slot = slot_of(frames, depth);
  ++slot.count;
  slot.bytes += bytes;
  counting = true;
}

std::string name_of(void* address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || info.dli_sname == nullptr) return {};
  int status = 0;
  char* readable = abi::__cxa_demangle(info.dli_sname, nullptr, nullptr, &status);
  std::string name = status == 0 ? readable : info.dli_sname;
  std::free(readable);
  return name.substr(0, name.find('('));
}

}  // namespace

void count_here(bool on) {
  counting = on;
}

std::uint64_t counted() {
  return all;
}

void forget() {
  slots.fill({});
  all = 0;
}

std::vector<Site> sites() {
  std::vector<Site> found;
  for (const Slot& slot : slots)
    if (slot.count > 0)
      found.push_back({{slot.frames.begin(), slot.frames.begin() + slot.depth}, slot.count, slot.bytes});
  std::ranges::sort(found, [](const Site& a, const Site& b) { return a.count > b.count; });
  return found;
}

std::string named(const Site& site, int most) {
  std::string text;
  for (void* frame : site.frames) {
    const std::string name = name_of(frame);
    if (name.find("madori::") == std::string::npos || name.find("madori::allocations") != std::string::npos)
      continue;
    text += (text.empty() ? "" : " < ") + name;
    if (--most == 0) break;
  }
  return text;
}

}  // namespace madori::allocations

extern "C" {
void* malloc(std::size_t size) {
  madori::allocations::note(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  madori::allocations::note(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* at, std::size_t size) {
  madori::allocations::note(size);
  return __libc_realloc(at, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  madori::allocations::note(size);
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  madori::allocations::note(size);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** at, std::size_t alignment, std::size_t size) {
  madori::allocations::note(size);
  *at = __libc_memalign(alignment, size);
  return *at == nullptr ? ENOMEM : 0;
}
}
