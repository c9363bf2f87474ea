#include "mapping/drawing/vector/load_svg.hpp"

#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::mapping {
namespace {

constexpr double kCssDpi = 96.0;

template <auto Free>
struct Freer {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Handle = std::unique_ptr<RsvgHandle, Freer<g_object_unref>>;
using Surface = std::unique_ptr<cairo_surface_t, Freer<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Freer<cairo_destroy>>;

struct Size {
  double width = 0.0;
  double height = 0.0;
  double dpi = kCssDpi;  ///< 0 where no paper is stated
};

/// In CSS pixels (1/96 inch); the viewBox, in units of no length, where the file states no absolute size.
Size natural_size(RsvgHandle* svg) {
  Size size;
  if (rsvg_handle_get_intrinsic_size_in_pixels(svg, &size.width, &size.height) != 0) return size;
  gboolean has_width = 0, has_height = 0, has_box = 0;
  RsvgLength width{}, height{};
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(svg, &has_width, &width, &has_height, &height, &has_box, &box);
  return has_box != 0 ? Size{box.width, box.height, 0.0} : Size{};
}

Handle open_svg(const std::filesystem::path& file) {
  GError* error = nullptr;
  Handle svg(rsvg_handle_new_from_file(file.c_str(), &error));
  if (!svg) {
    const std::string why = error != nullptr ? error->message : "unknown reason";
    g_clear_error(&error);
    throw Error(file.string(), "is no readable SVG (" + why + ")", "export it again, or as PDF");
  }
  rsvg_handle_set_dpi(svg.get(), kCssDpi);
  return svg;
}

GrayImage to_gray(cairo_surface_t* surface, double dpi) {
  GrayImage gray{cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}, dpi};
  gray.pixels.reserve(static_cast<std::size_t>(gray.width_px) * static_cast<std::size_t>(gray.height_px));
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int v = 0; v < gray.height_px; ++v) {
    const unsigned char* pixel = data + static_cast<std::ptrdiff_t>(v) * stride;
    for (int u = 0; u < gray.width_px; ++u, pixel += 4)  // BGRX; luma of ITU-R BT.601
      gray.pixels.push_back(
          static_cast<std::uint8_t>((114 * pixel[0] + 587 * pixel[1] + 299 * pixel[2] + 500) / 1000));
  }
  return gray;
}

}  // namespace

GrayImage load_svg(const std::filesystem::path& file, std::optional<double> dpi) {
  const Handle svg = open_svg(file);
  const Size size = natural_size(svg.get());
  if (!(size.width > 0.0 && size.height > 0.0))
    throw Error(file.string(), "states no size", "save it with a width, a height or a viewBox");
  const double zoom = dpi ? *dpi / kCssDpi : kWantedPx / std::max(size.width, size.height);
  const double width = std::ceil(size.width * zoom), height = std::ceil(size.height * zoom);
  if (!(width * height <= kMaxImageMegapixels * 1e6) || width > 32000 || height > 32000)
    throw Error(file.string(), "would give too many pixels", "choose a lower --dpi");
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
  const Context context(cairo_create(surface.get()));
  cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
  cairo_paint(context.get());
  const RsvgRectangle viewport{0.0, 0.0, width, height};
  GError* error = nullptr;
  if (rsvg_handle_render_document(svg.get(), context.get(), &viewport, &error) == 0) {
    g_clear_error(&error);
    throw Error(file.string(), "cannot be rendered", "export it as PDF or PNG instead");
  }
  cairo_surface_flush(surface.get());
  return to_gray(surface.get(), zoom * size.dpi);
}

}  // namespace madori::mapping
