#pragma once

#include <xgboost/c_api.h>

#include "mapping/drawing/labelling/forest.hpp"

namespace madori::training {

/// The trees that were grown, as the import reads them: the places where they divide a feature are the steps
/// of its scale. The booster knows the names of its features. Throws Error.
[[nodiscard]] mapping::Forest forest_of(BoosterHandle booster);

}  // namespace madori::training
