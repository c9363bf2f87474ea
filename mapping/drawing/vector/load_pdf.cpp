#include "mapping/drawing/vector/load_pdf.hpp"

#include <poppler-document.h>
#include <poppler-global.h>
#include <poppler-page-renderer.h>
#include <poppler-page.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::mapping {
namespace {

constexpr double kPointsPerInch = 72.0;

double choose_dpi(const poppler::rectf& page, std::optional<double> dpi) {
  if (dpi) return *dpi;
  const double inches = std::max(page.width(), page.height()) / kPointsPerInch;
  return std::clamp(kWantedPx / inches, 72.0, 600.0);
}

std::unique_ptr<poppler::document> open_pdf(const std::filesystem::path& file) {
  std::unique_ptr<poppler::document> document(poppler::document::load_from_file(file.string()));
  if (!document) throw Error(file.string(), "is no readable PDF", "open it in a viewer and export it again");
  if (document->is_locked())
    throw Error(file.string(), "is protected by a password", "save a copy without password and import that");
  return document;
}

}  // namespace

Plan load_pdf(const std::filesystem::path& file, const PlanOptions& options) {
  poppler::set_debug_error_function([](const std::string&, void*) {}, nullptr);
  const auto document = open_pdf(file);
  if (options.page < 1 || options.page > document->pages())
    throw Error(file.string(), "has no page " + std::to_string(options.page),
                "choose --page 1 to " + std::to_string(document->pages()));
  const std::unique_ptr<poppler::page> page(document->create_page(options.page - 1));
  if (!page)
    throw Error(file.string(), "page " + std::to_string(options.page) + " is damaged", "export it again");
  const double resolution = choose_dpi(page->page_rect(), options.dpi);
  const double megapixels = page->page_rect().width() * page->page_rect().height() * resolution * resolution /
                            (kPointsPerInch * kPointsPerInch) / 1e6;
  if (!(megapixels <= kMaxImageMegapixels))
    throw Error(file.string(), "would give " + std::to_string(std::lround(megapixels)) + " megapixels",
                "choose a lower --dpi");
  poppler::page_renderer renderer;
  renderer.set_image_format(poppler::image::format_gray8);
  renderer.set_paper_color(0xffffffff);
  renderer.set_render_hint(poppler::page_renderer::antialiasing, true);
  const poppler::image image = renderer.render_page(page.get(), resolution, resolution);
  if (!image.is_valid() || image.width() == 0)
    throw Error(file.string(), "page " + std::to_string(options.page) + " cannot be rendered",
                "export it as PNG instead");
  Plan plan;
  GrayImage& gray = plan.picture = {image.width(), image.height(), {}, resolution};
  gray.pixels.reserve(static_cast<std::size_t>(gray.width_px) * static_cast<std::size_t>(gray.height_px));
  for (int v = 0; v < gray.height_px; ++v) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(image.const_data()) +
                      static_cast<std::ptrdiff_t>(v) * image.bytes_per_row();
    gray.pixels.insert(gray.pixels.end(), row, row + gray.width_px);
  }
  if (document->pages() > 1)  // the first is often a title page, whose letters are lines too
    plan.notes.push_back("page " + std::to_string(options.page) + " of " + std::to_string(document->pages()) +
                         " was read; --page names another one");
  return plan;
}

}  // namespace madori::mapping
