#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "mapping/drawing/import_drawing.hpp"
#include "mapping/georeference/similarity_fit.hpp"

namespace madori::hmi {

/// A new revision of the site's drawing, imported beside the site and laid on its walls: what it would
/// change, before it does.
class DrawingPreview {
 public:
  virtual ~DrawingPreview() = default;

  /// RevisionPreview of hmi/schema.
  [[nodiscard]] virtual nlohmann::json report() const = 0;
  /// A person moves it on the old drawing: a similarity of the old drawing's Map. Throws Error.
  virtual void move(const mapping::Similarity& by) = 0;
  /// The new drawing becomes the site's in one step. Throws Error.
  virtual void apply() = 0;
};

/// Imports the drawing of the options and lays it on the site that they name; nothing of the site changes.
/// Throws Error.
using MakeDrawingPreview =
    std::function<std::unique_ptr<DrawingPreview>(const mapping::ImportOptions&, const mapping::Progress&)>;

}  // namespace madori::hmi
