// Compiled as firmware is (CMakeLists.txt); drive_wire_test.cpp calls it.
#include "control/drive_link/controller.hpp"

extern "C" std::size_t madori_freestanding_stop_frame(unsigned char* out) {
  madori::control::wire::Controller controller;
  madori::control::wire::ControllerInputs inputs;
  inputs.emergency_stop = true;
  controller.tick(inputs, 1000U);
  return controller.status_frame(out);
}
