#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/drawing/import_drawing.hpp"
#include "mapping/revision/register_walls.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {

/// What a new revision of a site's drawing changes. Pieces are in the Map frame of the old drawing.
struct DrawingRevision {
  mapping::WallRegistration laid;
  std::vector<Segment2<Map>> gone, added;
  mapping::Walls walls;                          ///< the site's from now on: the old ones, gone and added
  std::vector<planning::RouteFinding> findings;  ///< of the routes, that the old drawing did not have
  std::vector<std::string> stations_lost;        ///< too near to a wall now, or no longer to be reached
};

/// A new drawing, imported into a folder of its own beside the site and laid on the site's walls. Nothing of
/// the site changes before `apply`.
class RevisedDrawing {
 public:
  /// `options.site` names the site. Throws Error where the drawing cannot be read, or is no revision of the
  /// site's.
  explicit RevisedDrawing(const mapping::ImportOptions& options, const mapping::Progress& progress = {});
  ~RevisedDrawing();
  RevisedDrawing(const RevisedDrawing&) = delete;
  RevisedDrawing& operator=(const RevisedDrawing&) = delete;

  [[nodiscard]] const DrawingRevision& found() const { return found_; }
  /// All walls of the new drawing where they lie now.
  [[nodiscard]] const std::vector<Segment2<Map>>& drawn() const { return drawn_; }
  /// Somebody moves the new drawing on the old one: it settles on the walls near there, and is compared anew.
  void move(const mapping::Similarity& by);
  /// The new drawing becomes the site's in one step: in the scale of the old one, with routes and
  /// georeference carried to where it lies now.
  void apply() const;

 private:
  void compare(const mapping::WallRegistration& laid);

  std::filesystem::path site_;
  class Beside;
  std::unique_ptr<const Beside> beside_;
  mapping::Walls before_;
  std::vector<Segment2<Map>> drawn_;
  DrawingRevision found_;
};

/// DrawingRevision of docs/reference/command-line.md (`madori diff --json`) and hmi/schema.
[[nodiscard]] nlohmann::json revision_json(const DrawingRevision& revision, bool applied);

/// x1, y1, x2, y2 of each, metres.
[[nodiscard]] nlohmann::json segment_rows(const std::vector<Segment2<Map>>& pieces);

}  // namespace madori::app
