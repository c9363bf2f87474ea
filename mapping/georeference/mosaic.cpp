#include "mapping/georeference/mosaic.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr int kLegendPx = 36;

struct Frame {
  int x0 = 0;
  int y0 = 0;
  int columns = 0;
  int rows = 0;
  int zoom = 0;
};

/// Columns count on across the date line.
int column_of(const TileId& tile, const Frame& frame) {
  const int size = 1 << frame.zoom;
  return ((tile.x - frame.x0) % size + size) % size;
}

Frame frame_of(const std::vector<TileId>& tiles) {
  Frame f{tiles.front().x, tiles.front().y, 0, 0, tiles.front().zoom};
  const int size = 1 << f.zoom;
  // tiles_around lists a row from west to east; the westernmost column has no neighbour in the west.
  for (const auto& t : tiles) {
    const bool neighbour = std::any_of(tiles.begin(), tiles.end(),
                                       [&](const TileId& o) { return o.x == (t.x - 1 + size) % size; });
    if (!neighbour) f.x0 = t.x;
    f.y0 = std::min(f.y0, t.y);
  }
  for (const auto& t : tiles) {
    f.columns = std::max(f.columns, column_of(t, f) + 1);
    f.rows = std::max(f.rows, t.y - f.y0 + 1);
  }
  return f;
}

/// The longest of 1, 2, 5, 10 ... metres that fits into `most_m`.
double round_length_m(double most_m) {
  const double decade = std::pow(10.0, std::floor(std::log10(most_m)));
  return most_m >= 5.0 * decade ? 5.0 * decade : (most_m >= 2.0 * decade ? 2.0 * decade : decade);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : (c == '<' ? "&lt;" : (c == '"' ? "&quot;" : std::string(1, c)));
  return out;
}

/// A letter is about 0.6 of the font size wide, a Japanese sign (three bytes) all of it.
double font_size_for(const std::string& text, double width) {
  double letters = 0.0;
  for (const char c : text) letters += static_cast<unsigned char>(c) < 0x80U ? 0.6 : 0.34;
  return std::min(11.0, width / std::max(letters, 1.0));
}

std::string legend_svg(int width, int height, double m_per_px, const std::string& attribution) {
  const double bar_m = round_length_m(width * m_per_px / 3.0);
  const double bar = bar_m / m_per_px;
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}">)"
      R"(<rect x="0" y="{2}" width="{0}" height="{3}" fill="white"/>)"
      R"(<path d="M8 {4}v7h{5:.2f}v-7" fill="none" stroke="black" stroke-width="2"/>)"
      R"(<g font-family="DejaVu Sans, Noto Sans CJK JP" font-size="11">)"
      R"(<text x="{6:.2f}" y="{7}">{8:g} m</text><text x="{9}" y="{7}" text-anchor="end">north is up</text>)"
      R"(<text x="8" y="{10}" font-size="{11:.1f}">{12}</text></g></svg>)",
      width, height, height - kLegendPx, kLegendPx, height - 30, bar, bar + 14.0, height - 22, bar_m,
      width - 8, height - 6, font_size_for(attribution, width - 16.0), escaped(attribution));
}

/// OpenCV draws no Japanese; librsvg does.
void draw_legend(cv::Mat& picture, const std::string& svg) {
  const std::unique_ptr<RsvgHandle, decltype(&g_object_unref)> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), nullptr),
      g_object_unref);
  if (!handle) throw Error("mosaic", "its legend cannot be drawn", "check the attribution text");
  cv::Mat layer;
  cv::cvtColor(picture, layer, cv::COLOR_BGR2BGRA);
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_for_data(layer.data, CAIRO_FORMAT_ARGB32, layer.cols, layer.rows,
                                          static_cast<int>(layer.step)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo(cairo_create(surface.get()), cairo_destroy);
  const RsvgRectangle page{0.0, 0.0, static_cast<double>(layer.cols), static_cast<double>(layer.rows)};
  rsvg_handle_render_document(handle.get(), cairo.get(), &page, nullptr);
  cairo_surface_flush(surface.get());
  cv::cvtColor(layer, picture, cv::COLOR_BGRA2BGR);
}

}  // namespace

std::string mosaic_png(const TileStore& store, const std::vector<TileId>& tiles) {
  if (tiles.empty()) throw Error(store.folder().string(), "no tile was asked for", "check the radius");
  const Frame frame = frame_of(tiles);
  cv::Mat picture(frame.rows * kTilePixels + kLegendPx, frame.columns * kTilePixels, CV_8UC3,
                  cv::Scalar::all(200));
  bool any = false;
  for (const auto& tile : tiles) {
    if (!std::filesystem::exists(store.file_of(tile))) continue;
    cv::Mat image = cv::imread(store.file_of(tile).string(), cv::IMREAD_COLOR);
    if (image.empty()) continue;
    if (image.cols != kTilePixels) cv::resize(image, image, {kTilePixels, kTilePixels}, 0, 0, cv::INTER_AREA);
    image.copyTo(picture(cv::Rect(column_of(tile, frame) * kTilePixels, (tile.y - frame.y0) * kTilePixels,
                                  kTilePixels, kTilePixels)));
    any = true;
  }
  if (!any)
    throw Error(store.folder().string(), "none of these tiles is saved", "check place, zoom and source");
  const LatLon middle = place_of({static_cast<double>(frame.x0), frame.y0 + frame.rows / 2.0}, frame.zoom);
  const double m_per_px = tile_side_m(middle.latitude_deg, frame.zoom) / kTilePixels;
  draw_legend(picture, legend_svg(picture.cols, picture.rows, m_per_px, store.source().attribution));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return {png.begin(), png.end()};
}

}  // namespace madori::mapping
