#pragma once

#include <memory>
#include <vector>

#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/warp/warp_fit.hpp"

namespace madori::localization {

/// The drawing as it is believed to stand. Immutable, shared.
struct BentDrawing {
  WarpFit fit;            ///< of the drawn walls
  mapping::Walls stands;  ///< the walls where they stand, Building metres
  /// Where a place is drawn, and where it lies between what was seen around it: place_by_clearances().
  struct Place {
    Point2<Map> drawn;
    Point2<Map> stands;
  };
  std::vector<Place> places;  ///< by where they are drawn, x before y

  /// One of the places where it stands, any other where the warp carries it.
  [[nodiscard]] Point2<Map> place(const Point2<Map>& on_drawing) const;
  /// A pose carried over; both typed Map, the building's metres being laid rigidly on the drawing.
  [[nodiscard]] Transform2<Map, Base> in_building(const Transform2<Map, Base>& on_drawing) const;
  [[nodiscard]] Transform2<Map, Base> on_drawing(const Transform2<Map, Base>& in_building) const;
  /// How likely it is that a vehicle there is within so much, on the drawing, of where on_drawing() has it:
  /// its surroundings were not taken for what is drawn beside them. By the ends of all fits that were tried.
  [[nodiscard]] double share_within(const Transform2<Map, Base>& in_building, double m) const;
};

/// Learns by and by how the drawing lies in the building, and holds both: the walls as drawn, which say where
/// the vehicle is, and as they stand, on which the memory is laid. As drawn until the marginal likelihood
/// says otherwise. A copy is cheap.
class BendingDrawing {
 public:
  explicit BendingDrawing(const mapping::Walls& walls) : drawn_(walls), standing_(drawn_) {}

  /// Before it is bent.
  void set_places(const std::vector<Point2<Map>>& drawn) { places_ = drawn; }
  [[nodiscard]] const DrawingFit& drawn() const { return drawn_; }
  [[nodiscard]] const DrawingFit& standing() const { return standing_; }
  /// What neighbouring walls are off by together: the field of the warp.
  [[nodiscard]] SharedError shared_error() const;
  /// Null: as drawn.
  [[nodiscard]] const std::shared_ptr<const BentDrawing>& bent() const { return bent_; }
  [[nodiscard]] Transform2<Map, Base> in_building(const Transform2<Map, Base>& on_drawing) const;
  [[nodiscard]] Transform2<Map, Base> on_drawing(const Transform2<Map, Base>& in_building) const;

  /// Bends to a memory that lies right, the vehicle being at `at` (the building's metres), where it has grown
  /// enough since the last time. Takes tenths of a second. `told`: as fit_warp's.
  void bend(const MemoryCloud& cloud, const Point2<Map>& at, const WarpPrior& told);
  /// As drawn again: it was bent to a memory that lay elsewhere.
  void straighten();
  /// Of how exactly each of the two describes the memory.
  void learn(const MemoryCloud& cloud);

 private:
  void take(const WarpFit& fit, const MemoryCloud& cloud);

  DrawingFit drawn_;
  std::vector<Point2<Map>> places_;  ///< on the drawing
  DrawingFit standing_;
  std::shared_ptr<const BentDrawing> bent_;
  DrawingWarp start_;        ///< where the next fit's association begins; the statistics learned
  double next_walls_ = 0.0;  ///< seen when it bends again
};

}  // namespace madori::localization
