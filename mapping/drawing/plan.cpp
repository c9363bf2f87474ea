#include "mapping/drawing/plan.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "core/result.hpp"
#include "mapping/drawing/raster/load_image.hpp"
#include "mapping/drawing/vector/load_dxf.hpp"
#include "mapping/drawing/vector/load_pdf.hpp"
#include "mapping/drawing/vector/load_svg.hpp"

namespace madori::mapping {

Plan load_plan(const std::filesystem::path& file, const PlanOptions& options) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::filesystem::is_directory(file))
    throw Error(file.string(), "is a folder", "name the drawing file in it");
  if (!std::filesystem::exists(file)) throw Error(file.string(), "does not exist", "check the path");
  if (!std::filesystem::is_regular_file(file))
    throw Error(file.string(), "is no regular file", "save the drawing to a file first");
  if (!std::ifstream(file)) throw Error(file.string(), "cannot be read", "check its permissions");
  if (extension == ".dwg")
    throw Error(file.string(), "is a DWG drawing, which only CAD programs can open",
                "save it as DXF there and import that");
  if (extension == ".dxf") return load_dxf(file, options);
  Plan plan;
  if (extension == ".pdf")
    plan.picture = load_pdf(file, options.page, options.dpi);
  else if (extension == ".svg")
    plan.picture = load_svg(file, options.dpi);
  else
    plan.picture = load_image(file);
  return plan;
}

}  // namespace madori::mapping
