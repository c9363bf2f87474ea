#pragma once

namespace madori::test {

/// Hears of every figure: what it is, as computed, as it should be, and by how much it may differ.
using VectorReport = void (*)(const char* name, double computed, double expected, double tolerance);

/// The test vectors of the landmark core, without any library: run on the host and on a bare controller.
void landmark_vectors(VectorReport report);

}  // namespace madori::test
