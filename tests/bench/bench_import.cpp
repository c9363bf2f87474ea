// What an import costs beside OpenCV's HoughLinesP alone, medians of one run, and the least of each (what
// other work on the machine disturbs least):
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
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr int kRepeats = 7;

double now_ms(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// What a user waits (other work on the machine counts, too), and processor time.
struct Cost {
  double waited_ms = 0, processor_ms = 0;
};

Cost cost_of(const std::function<void()>& work) {
  const Cost before{now_ms(CLOCK_MONOTONIC), now_ms(CLOCK_PROCESS_CPUTIME_ID)};
  work();
  return {now_ms(CLOCK_MONOTONIC) - before.waited_ms, now_ms(CLOCK_PROCESS_CPUTIME_ID) - before.processor_ms};
}

/// The cost that so many others fall below, of either kind.
Cost of_rank(std::vector<Cost> costs, std::size_t rank) {
  const auto ranked = [&](double Cost::*of) {
    const auto at = costs.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(costs.begin(), at, costs.end(),
                     [&](const Cost& a, const Cost& b) { return a.*of < b.*of; });
    return (*at).*of;
  };
  return {ranked(&Cost::waited_ms), ranked(&Cost::processor_ms)};
}

Cost median(const std::vector<Cost>& costs) {
  return of_rank(costs, costs.size() / 2);
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
  const madori::test::TemporaryFolder folder;
  const auto picture = folder.path() / "factory.png";
  cv::Mat grey = cv::imread(std::string(MADORI_SOURCE_DIR) + "/data/sample_factory/factory_scan.png", 0), ink;
  cv::resize(grey, grey, {4000, 3000}, 0, 0, cv::INTER_AREA);
  cv::imwrite(picture.string(), grey);
  cv::threshold(grey, ink, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  std::vector<Cost> hough, small, large;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<cv::Vec4i> lines;
    hough.push_back(cost_of([&] { cv::HoughLinesP(ink, lines, 1, CV_PI / 180, 80, 40, 5); }));
    small.push_back(cost_of([&] { import_into(picture, folder.path() / "small", 0.026); }));
    if (argc > 1) large.push_back(cost_of([&] { import_into(argv[1], folder.path() / "large", 0.005); }));
  }
  const Cost h = median(hough), s = median(small);
  std::printf("HoughLinesP alone   waited %7.1f ms, processor %7.1f ms\n", h.waited_ms, h.processor_ms);
  std::printf("import 4000 x 3000  waited %7.1f ms, processor %7.1f ms = %.2f x and %.2f x HoughLinesP\n",
              s.waited_ms, s.processor_ms, s.waited_ms / h.waited_ms, s.processor_ms / h.processor_ms);
  const Cost least_h = of_rank(hough, 0), least_s = of_rank(small, 0);
  std::printf("least of both       waited %7.1f ms, processor %7.1f ms = %.2f x and %.2f x HoughLinesP\n",
              least_s.waited_ms, least_s.processor_ms, least_s.waited_ms / least_h.waited_ms,
              least_s.processor_ms / least_h.processor_ms);
  if (argc > 1) {
    const Cost l = median(large);
    std::printf("import of %s  waited %7.1f ms, processor %7.1f ms = %.2f x and %.2f x the smaller one\n",
                argv[1], l.waited_ms, l.processor_ms, l.waited_ms / s.waited_ms,
                l.processor_ms / s.processor_ms);
  }
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
