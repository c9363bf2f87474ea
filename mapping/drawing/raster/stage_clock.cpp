#include "mapping/drawing/raster/stage_clock.hpp"

namespace madori::mapping {

void StageClock::begin(const std::string& name, double share) {
  if (progress_) progress_(name, share);
  name_ = name;
  start_ = std::chrono::steady_clock::now();
}

void StageClock::end(std::size_t count) {
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start_;
  found_.stages.push_back({name_, spent.count(), count});
}

}  // namespace madori::mapping
