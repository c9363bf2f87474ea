// Trains the wall model.
//   train_walls SHEETS --out MODEL [--without SOURCE,...]
// SHEETS is a folder that measure_sheets wrote. With --without the model sees no drawing of those sources.
// One thread, a fixed seed: the same sheets give the same bytes. tests/bench/train_walls.py runs it all.
#include <xgboost/c_api.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "tests/bench/wall_training/calibration_fit.hpp"
#include "tests/bench/wall_training/chance.hpp"
#include "tests/bench/wall_training/example_sheet.hpp"
#include "tests/bench/wall_training/forest_of.hpp"

namespace {

using namespace madori::training;

constexpr int kTrees = 300, kSecondTrees = 200;
constexpr const char *kDepth = "6", *kSecondDepth = "5";
constexpr std::size_t kFolds = 5;
constexpr std::size_t kMostOfHome = 20000, kMostOfReal = 1800,
                      kMostOfDrawn = 300;  // edges of a sheet that are looked at
constexpr double kSheetWeight = 1000;

struct Examples {
  std::vector<std::string> names;
  std::vector<float> values, labels, weights;  // values row-major
  std::vector<double> lengths;                 // of walls and others, of which a probability speaks

  void add(const Examples& more) {
    names = more.names;
    values.insert(values.end(), more.values.begin(), more.values.end());
    labels.insert(labels.end(), more.labels.begin(), more.labels.end());
    weights.insert(weights.end(), more.weights.begin(), more.weights.end());
    lengths.insert(lengths.end(), more.lengths.begin(), more.lengths.end());
  }
};

void check(int status) {
  if (status != 0) throw madori::Error("training", XGBGetLastError(), "look at the measured sheets");
}

double length_of(const ExampleSheet& sheet, std::size_t row) {
  const float* s = &sheet.segments[4 * row];
  return std::hypot(s[2] - s[0], s[3] - s[1]);
}

/// At most `most` edges, long ones rather than short ones (P. Efraimidis, P. Spirakis 2006), in their order.
std::vector<std::size_t> sample(const ExampleSheet& sheet, std::size_t most) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < sheet.rows(); ++i)
    if (sheet.used[i] != 0) rows.push_back(i);
  if (rows.size() <= most) return rows;
  Chance chance(1);
  std::vector<std::pair<double, std::size_t>> keys;
  for (const std::size_t i : rows)
    keys.emplace_back(-std::log(chance.between(1e-9, 1)) / std::sqrt(length_of(sheet, i)), i);
  std::sort(keys.begin(), keys.end());
  rows.clear();
  for (std::size_t k = 0; k < most; ++k) rows.push_back(keys[k].second);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Every sheet weighs the same for its kind, however many edges it has; an edge by the root of its length, on
/// the older drawings, which must be known by heart, by its length.
void append(Examples& examples, const ExampleSheet& sheet) {
  const bool drawn = sheet.source == "synthetic", home = sheet.source == "home";
  const auto rows = sample(sheet, drawn ? kMostOfDrawn : home ? kMostOfHome : kMostOfReal);
  const std::size_t columns = sheet.features.size();
  const bool sampled = rows.size() < static_cast<std::size_t>(std::count_if(
                                         sheet.used.begin(), sheet.used.end(), [](int u) { return u != 0; }));
  const bool complete = !drawn && !home && sheet.truth != "contours";
  std::vector<double> weights, lengths;
  for (const std::size_t i : rows) {
    const double length = length_of(sheet, i), often = sampled ? std::sqrt(length) : 1;
    lengths.push_back(length / often);
    // walls are long, what is no wall must count too
    weights.push_back((home ? length : std::sqrt(length)) / often);
    const auto from = sheet.values.begin() + static_cast<std::ptrdiff_t>(i * columns);
    examples.values.insert(examples.values.end(), from, from + static_cast<std::ptrdiff_t>(columns));
    examples.labels.push_back(sheet.near[i] > 0.5F ? 1 : 0);
  }
  const auto sum = [](const std::vector<double>& all) {
    return std::max(1.0, std::accumulate(all.begin(), all.end(), 0.0));
  };
  const double whole_weight = sum(weights), whole_length = sum(lengths);
  for (const double weight : weights)
    examples.weights.push_back(static_cast<float>(kSheetWeight * sheet.weight * weight / whole_weight));
  for (const double length : lengths)
    examples.lengths.push_back(complete ? sheet.weight * length / whole_length : 0.0);
  examples.names = sheet.features;
}

/// Trees that judge edges.
class Judge {
 public:
  Judge(const Examples& examples, int trees, const char* depth) {
    const std::size_t rows = examples.labels.size();
    DMatrixHandle matrix = nullptr;
    check(XGDMatrixCreateFromMat(examples.values.data(), rows, examples.names.size(), -1e9F, &matrix));
    check(XGDMatrixSetFloatInfo(matrix, "label", examples.labels.data(), rows));
    check(XGDMatrixSetFloatInfo(matrix, "weight", examples.weights.data(), rows));
    check(XGBoosterCreate(&matrix, 1, &booster_));
    const std::vector<std::pair<const char*, const char*>> settings{{"objective", "binary:logistic"},
                                                                    {"tree_method", "hist"},
                                                                    {"max_bin", "64"},
                                                                    {"max_depth", depth},
                                                                    {"eta", "0.06"},
                                                                    {"subsample", "0.7"},
                                                                    {"lambda", "1"},
                                                                    {"colsample_bytree", "0.4"},
                                                                    {"min_child_weight", "3"},
                                                                    {"nthread", "1"},
                                                                    {"seed", "1"}};
    for (const auto& [name, value] : settings) check(XGBoosterSetParam(booster_, name, value));
    for (int round = 0; round < trees; ++round) check(XGBoosterUpdateOneIter(booster_, round, matrix));
    std::vector<const char*> texts;
    for (const std::string& name : examples.names) texts.push_back(name.c_str());
    check(XGBoosterSetStrFeatureInfo(booster_, "feature_name", texts.data(), texts.size()));
    XGDMatrixFree(matrix);
  }
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;
  ~Judge() { XGBoosterFree(booster_); }

  [[nodiscard]] std::vector<float> probabilities(const std::vector<float>& values, std::size_t rows) const {
    if (rows == 0) return {};
    DMatrixHandle matrix = nullptr;
    check(XGDMatrixCreateFromMat(values.data(), rows, values.size() / rows, -1e9F, &matrix));
    bst_ulong count = 0;
    const float* result = nullptr;
    check(XGBoosterPredict(booster_, matrix, 0, 0, 0, &count, &result));
    std::vector<float> copy(result, result + count);
    XGDMatrixFree(matrix);
    return copy;
  }

  [[nodiscard]] madori::mapping::Forest forest() const { return forest_of(booster_); }

 private:
  BoosterHandle booster_ = nullptr;
};

/// Drawings of one source are in one fold, plans of the draughtsman one after the other.
std::vector<std::size_t> folds_of(const std::vector<ExampleSheet>& sheets) {
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> folds;
  std::size_t plans = 0;
  for (const ExampleSheet& sheet : sheets) {
    if (sheet.source == "synthetic") {
      folds.push_back(plans++ % kFolds);
    } else {
      folds.push_back(numbers.try_emplace(sheet.source, numbers.size()).first->second % kFolds);
    }
  }
  return folds;
}

/// The sheet as the second judge sees it.
ExampleSheet in_context(const ExampleSheet& sheet, const std::vector<float>& first) {
  ExampleSheet second = sheet;
  std::vector<madori::mapping::PixelSegment> segments;
  madori::mapping::EdgeGroups groups;
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    const float* s = &sheet.segments[4 * i];
    segments.push_back({s[0], s[1], s[2], s[3]});
    for (std::size_t k = 0; k < 4; ++k) groups.together[k].push_back(sheet.groups[kGroups * i + k]);
    for (std::size_t k = 0; k < 2; ++k) groups.partner[k].push_back(sheet.groups[kGroups * i + 4 + k]);
  }
  const auto context = madori::mapping::sheet_context(segments, groups, first);
  second.features = context.names();
  second.features.insert(second.features.end(), sheet.features.begin(), sheet.features.end());
  second.values.clear();
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    const auto row = context.row(i);
    second.values.insert(second.values.end(), row.begin(), row.end());
    const auto own = sheet.values.begin() + static_cast<std::ptrdiff_t>(i * sheet.features.size());
    second.values.insert(second.values.end(), own, own + static_cast<std::ptrdiff_t>(sheet.features.size()));
  }
  return second;
}

/// `contexts` are one a fold; of all folds where `fold` is none of theirs.
Examples without_fold(const std::vector<Examples>& contexts, std::size_t fold) {
  Examples examples;
  for (std::size_t k = 0; k < contexts.size(); ++k)
    if (k != fold) examples.add(contexts[k]);
  return examples;
}

Examples without_fold(const std::vector<ExampleSheet>& sheets, const std::vector<std::size_t>& folds,
                      std::size_t fold) {
  Examples examples;
  for (std::size_t k = 0; k < sheets.size(); ++k)
    if (folds[k] != fold) append(examples, sheets[k]);
  return examples;
}

/// How the log odds of drawings that were not seen become those of what is said of them: by length, where the
/// trees learned by its root, and as sure as they were right.
madori::mapping::Calibration calibrate(const std::vector<Examples>& folds) {
  CalibrationFit fit;
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    const Examples& unseen = folds[fold];
    const auto said = Judge(without_fold(folds, fold), kSecondTrees, kSecondDepth)
                          .probabilities(unseen.values, unseen.labels.size());
    for (std::size_t i = 0; i < said.size(); ++i) fit.add(said[i], unseen.labels[i] > 0, unseen.lengths[i]);
  }
  return fit.fitted();
}

/// The second judge learns from first judgements of drawings that the first one has not seen.
void train(const std::vector<ExampleSheet>& sheets, const std::string& file) {
  const auto folds = folds_of(sheets);
  std::vector<Examples> contexts(kFolds);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Judge judge(without_fold(sheets, folds, fold), kTrees, kDepth);
    for (std::size_t k = 0; k < sheets.size(); ++k)
      if (folds[k] == fold)
        append(contexts[fold],
               in_context(sheets[k], judge.probabilities(sheets[k].values, sheets[k].rows())));
  }
  const auto calibration = calibrate(contexts);
  const madori::mapping::WallModel model(
      Judge(without_fold(sheets, folds, kFolds), kTrees, kDepth).forest(),
      Judge(without_fold(contexts, kFolds), kSecondTrees, kSecondDepth).forest(), calibration);
  const std::string bytes = model.bytes();
  std::ofstream stream(file, std::ios::binary);
  if (!(stream << bytes)) throw madori::Error(file, "cannot be written", "name another --out");
  std::printf("%s: %zu sheets, %zu bytes, log odds %.3f x + %.3f\n", file.c_str(), sheets.size(),
              bytes.size(), calibration.slope, calibration.offset);
}

}  // namespace

int main(int count, char** words) try {
  const std::vector<std::string> arguments(words + 1, words + count);
  std::string sheets, out, without;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--out" && i + 1 < arguments.size()) {
      out = arguments[++i];
    } else if (arguments[i] == "--without" && i + 1 < arguments.size()) {
      without = arguments[++i];
    } else {
      sheets = arguments[i];
    }
  }
  if (sheets.empty() || out.empty()) {
    std::fprintf(stderr, "train_walls SHEETS --out MODEL [--without SOURCE,...]\n");
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(sheets))
    if (entry.path().extension() == ".sheet") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<ExampleSheet> kept;
  for (const auto& file : files) {
    ExampleSheet sheet = load_sheet(file);
    if (("," + without + ",").find("," + sheet.source + ",") == std::string::npos)
      kept.push_back(std::move(sheet));
  }
  train(kept, out);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "train_walls: %s\n", error.what());
  return 1;
}
