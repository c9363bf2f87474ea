#pragma once

#include "mapping/site/site.hpp"

namespace madori::app {

/// Where the reference vehicle carries its VLP-16: what the set-up proposes.
inline const mapping::SensorRecord kReferenceLidar{"top", "vlp16", 0.3, 0.0, 1.2, 0.0};

}  // namespace madori::app
