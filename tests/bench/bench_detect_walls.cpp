// Detects the walls of one drawing and writes walls.csv (metres, y up); --method otsu-hough and lsd are the
// baselines.
//   bench_detect_walls DRAWING --scale M_PER_PX --out walls.csv [--method madori|otsu-hough|lsd]
//   [--model FILE] [--lines FILE] [--debug FOLDER]
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/result.hpp"
#include "mapping/drawing/read_drawing.hpp"
#include "mapping/picture/load_image.hpp"

namespace {

using madori::mapping::GrayImage;
using madori::mapping::PixelSegment;

cv::Mat view(const GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())};
}

std::vector<PixelSegment> otsu_hough(const GrayImage& image) {
  cv::Mat ink;
  cv::threshold(view(image), ink, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  std::vector<cv::Vec4i> lines;
  cv::HoughLinesP(ink, lines, 1, CV_PI / 180, 80, 40, 5);
  std::vector<PixelSegment> walls;
  for (const auto& l : lines) walls.push_back({l[0] + 0.5, l[1] + 0.5, l[2] + 0.5, l[3] + 0.5});
  return walls;
}

std::vector<PixelSegment> lsd(const GrayImage& image) {
  std::vector<cv::Vec4f> lines;
  cv::createLineSegmentDetector()->detect(view(image), lines);
  std::vector<PixelSegment> walls;
  for (const auto& l : lines)
    if (std::hypot(l[2] - l[0], l[3] - l[1]) >= 40)
      walls.push_back({l[0] + 0.5, l[1] + 0.5, l[2] + 0.5, l[3] + 0.5});
  return walls;
}

void write_csv(const std::string& file, const std::vector<PixelSegment>& walls, double scale, int height) {
  std::ofstream out(file);
  out << "id,x1,y1,x2,y2\n";
  int id = 0;
  for (const auto& w : walls)
    out << id++ << ',' << w.u1 * scale << ',' << (height - w.v1) * scale << ',' << w.u2 * scale << ','
        << (height - w.v2) * scale << '\n';
}

/// Every line of the drawing, pixels, and how probable a wall it is.
void write_lines(const std::string& file, const madori::mapping::DetectedWalls& found) {
  std::ofstream out(file);
  out << "u1,v1,u2,v2,wall,probability\n";
  const auto row = [&](const PixelSegment& s, int wall, double probability) {
    out << s.u1 << ',' << s.v1 << ',' << s.u2 << ',' << s.v2 << ',' << wall << ',' << probability << '\n';
  };
  for (std::size_t i = 0; i < found.walls.size(); ++i) row(found.walls[i], 1, found.probabilities[i]);
  for (const auto& r : found.rejected) row(r.segment, 0, r.probability);
}

void write_pgm(const std::string& file, const GrayImage& image) {
  std::ofstream out(file, std::ios::binary);
  out << "P5\n" << image.width_px << ' ' << image.height_px << "\n255\n";
  out.write(reinterpret_cast<const char*>(image.pixels.data()),
            static_cast<std::streamsize>(image.pixels.size()));
}

int run(const std::string& drawing, std::map<std::string, std::string>& flags) {
  cv::setNumThreads(1);
  const GrayImage image = madori::mapping::load_image(drawing);
  const std::string method = flags["--method"];
  std::vector<PixelSegment> walls;
  if (method == "otsu-hough") {
    walls = otsu_hough(image);
  } else if (method == "lsd") {
    walls = lsd(image);
  } else {
    madori::mapping::StageSink sink;
    if (const auto folder = flags["--debug"]; !folder.empty())
      sink = [folder](const auto& stage, const auto& picture) {
        write_pgm(folder + "/" + stage + ".pgm", picture);
      };
    madori::mapping::DetectionOptions options;
    options.model = flags["--model"];
    const auto found = madori::mapping::read_drawing(image, options, sink);
    for (const auto& stage : found.stages)
      std::printf("%-14s %8.1f ms %8zu\n", stage.name.c_str(), stage.milliseconds, stage.count);
    std::printf("skew %.2f deg, %zu walls, %zu rejected\n", found.skew_deg, found.walls.size(),
                found.rejected.size());
    walls = found.walls;
    if (const auto file = flags["--lines"]; !file.empty()) write_lines(file, found);
  }
  if (flags.contains("--out")) {
    const double scale = flags.contains("--scale") ? std::stod(flags["--scale"]) : 1.0;
    write_csv(flags["--out"], walls, scale, image.height_px);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> flags;
  for (int i = 2; i + 1 < argc; i += 2) flags[argv[i]] = argv[i + 1];
  if (argc < 2)
    return std::puts("usage: bench_detect_walls DRAWING [--scale S] [--out CSV] [--method M] [--debug DIR]"),
           2;
  try {
    return run(argv[1], flags);
  } catch (const madori::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
