#include "localization/landmarks/descriptor.hpp"

#include "localization/landmarks/bare_math.hpp"

namespace madori::localization::landmarks {
namespace {

constexpr double kSteps = 65536.0;
constexpr double kTurn_rad = 2.0 * kHalfTurn_rad;

}  // namespace

void Descriptor::add(double x_m, double y_m) {
  const double range_mm = 1000.0 * square_root(x_m * x_m + y_m * y_m) + 0.5;
  if (size_ == kMost || !(range_mm >= 1.0 && range_mm < kSteps)) return;
  range_mm_[size_] = static_cast<uint16_t>(range_mm);
  angle_[size_] = static_cast<uint16_t>(whole_below(arctangent(y_m, x_m) / kTurn_rad * kSteps + 0.5));
  ++size_;
}

double Descriptor::angle_rad(int i) const {
  return wrapped(angle_[i] / kSteps * kTurn_rad);
}

double Descriptor::median_range_m() const {
  int low = 0, high = 65535;
  while (low < high) {  // the smallest range that half of all do not pass
    const int middle = (low + high) / 2;
    int within = 0;
    for (int i = 0; i < size_; ++i) within += range_mm_[i] <= middle ? 1 : 0;
    if (2 * within >= size_) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return 1e-3 * low;
}

}  // namespace madori::localization::landmarks
