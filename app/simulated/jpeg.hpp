#pragma once

#include <string>

#include "simulation/camera/camera_model.hpp"

namespace madori::app {

[[nodiscard]] std::string to_jpeg(const simulation::CameraPicture& picture);

}  // namespace madori::app
