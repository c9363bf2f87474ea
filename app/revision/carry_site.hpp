#pragma once

#include <filesystem>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/georeference/similarity_fit.hpp"
#include "mapping/picture/gray_image.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

[[nodiscard]] mapping::Similarity inverse(const mapping::Similarity& by);

/// What is drawn on a site's sheet, wall or not.
class DrawnInk {
 public:
  explicit DrawnInk(const std::filesystem::path& site);

  /// Whether something as bold as `piece` in `own` is drawn along `here` too: then one import took for a wall
  /// what the other did not, and nothing has changed. Both are of the same length but for the scale.
  [[nodiscard]] bool is_bold_along(const Segment2<Map>& here, const DrawnInk& own,
                                   const Segment2<Map>& piece) const;

 private:
  [[nodiscard]] double cover(const Segment2<Map>& piece, double share, double half_width) const;

  mapping::GrayImage picture_;
  double unit_ = 1.0;        ///< of the Map a pixel
  double half_width_ = 0.0;  ///< looked at across a piece, in the Map's unit
  int ink_below_ = 128;
};

/// The drawing of the site `beside` becomes that of `site`, in one step: in the scale of the old one, else in
/// its own where it has one, with routes and georeference carried to where it lies now. `walls`: in the Map
/// of the old one.
void carry_site(const std::filesystem::path& site, const std::filesystem::path& beside,
                const mapping::Similarity& old_from_new, const mapping::Walls& walls);

}  // namespace madori::app
