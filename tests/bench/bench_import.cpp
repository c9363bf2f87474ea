// What an import costs beside OpenCV's HoughLinesP alone, medians of one run on one core:
//   bench_import [LARGE_DRAWING]
// A 4000 x 3000 drawing (the sample factory, resized) is imported whole (load, detect, sample, voxel grid,
// exports) and, in turn, HoughLinesP runs on its Otsu-binarized picture. With a second drawing (the 9600 x
// 6784 one) its import is compared with that of the first, and the peak memory is printed.
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "mapping/drawing/import_drawing.hpp"
#include "mapping/drawing/raster/load_image.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr int kRepeats = 7;

/// Processor time, so that a busy machine does not count.
double milliseconds(const std::function<void()>& work) {
  const auto now = [] {
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void import_into(const std::filesystem::path& drawing, const std::filesystem::path& site, double m_per_px) {
  madori::mapping::ImportOptions options;
  options.drawing = drawing;
  options.site = site;
  options.m_per_px = m_per_px;
  options.date = "2024-01-01T00:00:00Z";
  options.force = true;
  madori::mapping::import_drawing(options);
}

int run(int argc, char** argv) {
  cv::setNumThreads(1);
  const madori::test::TemporaryFolder folder;
  const auto picture = folder.path() / "factory.png";
  cv::Mat grey = cv::imread(std::string(MADORI_SOURCE_DIR) + "/data/sample_factory/factory_scan.png", 0), ink;
  cv::resize(grey, grey, {4000, 3000}, 0, 0, cv::INTER_AREA);
  cv::imwrite(picture.string(), grey);
  cv::threshold(grey, ink, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  std::vector<double> hough, small, large;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<cv::Vec4i> lines;
    hough.push_back(milliseconds([&] { cv::HoughLinesP(ink, lines, 1, CV_PI / 180, 80, 40, 5); }));
    small.push_back(milliseconds([&] { import_into(picture, folder.path() / "small", 0.026); }));
    if (argc > 1)
      large.push_back(milliseconds([&] { import_into(argv[1], folder.path() / "large", 0.005); }));
  }
  const double h = median(hough), s = median(small);
  std::printf("HoughLinesP alone   %7.1f ms\nimport 4000 x 3000  %7.1f ms = %.2f x HoughLinesP\n", h, s,
              s / h);
  if (argc > 1)
    std::printf("import of %s  %7.1f ms = %.2f x the 4000 x 3000 one\n", argv[1], median(large),
                median(large) / s);
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory %.0f MB\n", static_cast<double>(usage.ru_maxrss) / 1024);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const madori::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
