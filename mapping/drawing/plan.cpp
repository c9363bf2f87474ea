#include "mapping/drawing/plan.hpp"

#include <fstream>
#include <utility>

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "mapping/drawing/vector/bounded_load.hpp"
#include "mapping/drawing/vector/load_dxf.hpp"
#include "mapping/drawing/vector/load_pdf.hpp"
#include "mapping/drawing/vector/load_svg.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::mapping {
namespace {

Plan picture_alone(GrayImage picture) {
  Plan plan;
  plan.picture = std::move(picture);
  return plan;
}

}  // namespace

Plan load_plan(const std::filesystem::path& file, const PlanOptions& options) {
  const std::string extension = lower_extension(file);
  if (std::filesystem::is_directory(file))
    throw Error(file.string(), "is a folder", "name the drawing file in it");
  if (!std::filesystem::exists(file)) throw Error(file.string(), "does not exist", "check the path");
  if (!std::filesystem::is_regular_file(file))
    throw Error(file.string(), "is no regular file", "save the drawing to a file first");
  if (!std::ifstream(file)) throw Error(file.string(), "cannot be read", "check its permissions");
  if (extension == ".dwg")
    throw Error(file.string(), "is a DWG drawing, which only CAD programs can open",
                "save it as DXF there and import that");
  if (extension == ".dxf") return load_bounded(file, [&] { return load_dxf(file, options); });
  if (extension == ".pdf") return load_bounded(file, [&] { return load_pdf(file, options); });
  if (extension == ".svg")
    return load_bounded(file, [&] { return picture_alone(load_svg(file, options.dpi)); });
  return picture_alone(load_image(file));
}

}  // namespace madori::mapping
