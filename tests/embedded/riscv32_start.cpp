// Start-up of a bare 32-bit RISC-V on QEMU's "virt" board: a serial port to write to, a register to end with.
#include <stddef.h>
#include <stdint.h>

#include "tests/embedded/landmark_vectors.hpp"

extern "C" {
void start_here();
void run();

// What the compiler itself calls for; simple loops, compiled so that they do not become calls of themselves.
void* memset(void* to, int value, size_t size) {
  for (size_t i = 0; i < size; ++i)
    static_cast<volatile unsigned char*>(to)[i] = static_cast<unsigned char>(value);
  return to;
}
void* memcpy(void* to, const void* from, size_t size) {
  for (size_t i = 0; i < size; ++i)
    static_cast<volatile unsigned char*>(to)[i] = static_cast<const unsigned char*>(from)[i];
  return to;
}
}

asm(".section .text.start\n.globl start_here\nstart_here:\n  la sp, stack_top\n  call run\n");

namespace {

volatile uint8_t* const kSerialPort = reinterpret_cast<uint8_t*>(0x10000000);
volatile uint32_t* const kFinisher = reinterpret_cast<uint32_t*>(0x100000);
constexpr uint32_t kPassed = 0x5555, kFailed = 0x13333;

bool all_right = true;

void print(const char* text) {
  for (; *text != 0; ++text) *kSerialPort = static_cast<uint8_t>(*text);
}

void print(double value) {
  if (value < 0.0) print("-");
  auto millionths = static_cast<uint64_t>((value < 0.0 ? -value : value) * 1e6 + 0.5);
  char digits[24] = {};
  int at = 23;
  for (int i = 0; i < 7 || millionths > 0; ++i, millionths /= 10) {
    if (i == 6) digits[--at] = '.';
    digits[--at] = static_cast<char>('0' + millionths % 10);
  }
  print(digits + at);
}

void report(const char* name, double computed, double expected, double tolerance) {
  const double off = computed < expected ? expected - computed : computed - expected;
  const bool right = off <= tolerance;
  all_right = all_right && right;
  print(right ? "ok    " : "WRONG ");
  print(name);
  print(": ");
  print(computed);
  print("\n");
}

}  // namespace

void run() {
  madori::test::landmark_vectors(report);
  print(all_right ? "all right\n" : "not all right\n");
  *kFinisher = all_right ? kPassed : kFailed;
  for (;;) {
  }
}
