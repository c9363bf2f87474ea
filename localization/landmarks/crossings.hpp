#pragma once

#include <cstddef>
#include <vector>

#include "localization/landmarks/place_proposals.hpp"
#include "localization/memory/memory.hpp"

namespace madori::localization::landmarks {

/// The crossings and turning points of a memory that lay right, each with what was seen there: whoever no
/// longer knows the place asks them ("the crossing seen before"). Immutable once made.
class Crossings {
 public:
  /// In the order in which they were driven; none nearer to another than a corridor's width.
  explicit Crossings(const Memory& memory);

  [[nodiscard]] std::size_t size() const { return all_.size(); }
  /// Where a scan may have been taken, the best fitting first; any heading, up to a corridor's width beside a
  /// crossing. Milliseconds a crossing.
  [[nodiscard]] std::vector<Transform2<madori::Map, Base>> where(const SurfaceScan& scan) const;

 private:
  struct Crossing {
    Transform2<madori::Map, Base> at;
    double width_m = 0.0;
    Descriptor descriptor;
  };
  void keep(const Crossing& crossing);

  std::vector<Crossing> all_;
};

}  // namespace madori::localization::landmarks
