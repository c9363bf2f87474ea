// CoLa B frames and scan telegrams.
#include "tests/fuzz/fuzz_cola.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  return madori::sensors::lms1xx::fuzz_cola(madori::sensors::lms1xx::Dialect::B, {data, size});
}
