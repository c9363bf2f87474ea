#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "localization/localizer/options.hpp"
#include "localization/placement/known_building.hpp"
#include "localization/placement/placement.hpp"
#include "localization/warp/bent_drawing.hpp"

namespace madori::localization {

/// A drawing, and what is known of how the memory lies on it.
struct OnDrawing {
  explicit OnDrawing(const mapping::Walls& drawn) : walls(drawn), belief(drawn) {}

  BendingDrawing walls;
  PlaceBelief belief;
  /// What was remembered where the place was sure: by earlier drives, and by this one until the vehicle was
  /// carried off. The place is sought by it.
  std::shared_ptr<const Memory> earlier;
  std::shared_ptr<const KnownBuilding> known;  ///< by `earlier`; null: not yet asked

  /// What the places are weighed by.
  [[nodiscard]] const DrawingFit& to_find_by() const { return known ? known->walls : walls.drawn(); }
  void set_earlier(std::shared_ptr<const Memory> memory);
};

/// The memory and how it lies on the drawing: all that the slow work reads and changes. A copy is cheap.
struct MapState {
  Memory memory;
  std::optional<OnDrawing> drawing;  ///< absent: mapping without a drawing
  std::optional<StartPrior> told;    ///< by whoever gave the start pose, on the drawing; absent: nobody did
  std::optional<StartPrior> start;   ///< ... where that stood in the building when the memory began
  bool placed = false;               ///< the memory lies where it is believed to lie
  HealthEvidence evidence;
  std::size_t unconfirmed_size = 0;  ///< of the memory when it was last moved to another place
  double next_survey_walls = 0.0;    ///< walls seen when all places are looked at again

  /// The slow work, in the worker: closes loops, lays the memory on the drawing, solves the graph.
  void think(const LocalizerOptions& options);
  /// Becomes `thought`, a copy made when this map had `known` keyframes and changed since, and what the scans
  /// have said since then; `thought` is of no use afterwards. Returns what moves this map's newest
  /// surroundings there.
  Transform2<Map, Map> take_in(MapState& thought, std::size_t known);
  /// Does the drawing explain what is seen, so that walls that are missed say something?
  [[nodiscard]] bool drawing_fits(const LocalizerOptions& options) const;
  /// Is the drawing exact enough to tell drift of centimetres?
  [[nodiscard]] bool drawing_is_exact(const LocalizerOptions& options) const;

 private:
  void place(const LocalizerOptions& options);
  /// Whether the memory lies in the middle of several ways to lie at one place: then it settles on none.
  bool weigh_places(const MemoryCloud& cloud, const LocalizerOptions& options);
  void settle(MemoryCloud& cloud, const LocalizerOptions& options);
  void lay_on_drawing(MemoryCloud& cloud, const LocalizerOptions& options);
  void move(const Transform2<Map, Map>& by);
  [[nodiscard]] WarpPrior told_of_warp() const;
  bool correct_recent_drift(const LocalizerOptions& options);
  [[nodiscard]] AlignmentWindow drift_window(const MemoryCloud& recent, std::size_t first,
                                             const LocalizerOptions& options) const;
};

}  // namespace madori::localization
