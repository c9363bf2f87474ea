// Trains the wall model.
//   train_walls LIST --out MODEL [--leave-out FOLDER]
// LIST is a CSV file with a row a drawing: name,source,weight,drawing,walls,tolerance_px,truth,ignore
// (truth: faces, lines or contours; ignore: boxes u1 v1 u2 v2 separated by spaces). With --leave-out a model
// FOLDER/SOURCE.ubj that saw no drawing of that source is trained beside, for every source but "synthetic"
// and "home". One thread, a fixed seed: the same list and files give the same bytes.
// tests/bench/train_walls.py writes lists.
#include <xgboost/c_api.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "mapping/drawing/raster/detect_walls.hpp"
#include "mapping/drawing/raster/load_image.hpp"

namespace {

using madori::mapping::PixelSegment;

constexpr int kTrees = 110;
constexpr double kAngleSine = 0.17;  // 10 degrees, as the scores have it
constexpr double kUnknownReach = 3;  // tolerances: contours leave out the other face of a wall

struct Row {
  std::string name, source, drawing, walls, truth;
  double weight = 1, tolerance_px = 4;
  std::vector<double> ignore;
};

struct Example {
  std::string source;
  std::vector<float> values, labels, weights;  // values row-major
};

void check(int status) {
  if (status != 0) throw madori::Error("training", XGBGetLastError(), "look at the list of drawings");
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<Row> read_list(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw madori::Error(file, "cannot be opened", "name a list of drawings");
  std::vector<Row> rows;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    auto parts = fields(line);
    if (parts.size() < 7)
      throw madori::Error(file, "has a row with less than 7 fields: " + line, "complete it");
    Row row{parts[0], parts[1], parts[3], parts[4], parts[6], std::stod(parts[2]), std::stod(parts[5]), {}};
    std::stringstream boxes(parts.size() > 7 ? parts[7] : "");
    for (double value = 0; boxes >> value;) row.ignore.push_back(value);
    rows.push_back(row);
  }
  return rows;
}

std::vector<PixelSegment> read_truth(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw madori::Error(file, "cannot be opened", "correct the list");
  std::string line;
  std::getline(stream, line);
  const auto header = fields(line);
  const auto first = std::find(header.begin(), header.end(), "u1") - header.begin();
  std::vector<PixelSegment> truth;
  while (std::getline(stream, line)) {
    const auto parts = fields(line);
    if (parts.size() < static_cast<std::size_t>(first) + 4) continue;
    const auto at = [&](std::ptrdiff_t k) { return std::stod(parts[static_cast<std::size_t>(first + k)]); };
    truth.push_back({at(0), at(1), at(2), at(3)});
  }
  return truth;
}

/// The share of a segment that lies beside a parallel one of the truth.
double true_share(const PixelSegment& s, const std::vector<PixelSegment>& truth, double tolerance) {
  const double length = s.length_px();
  const int places = std::clamp(static_cast<int>(length / 2), 2, 60);
  std::vector<bool> right(static_cast<std::size_t>(places));
  for (const PixelSegment& t : truth) {
    if (std::max(s.u1, s.u2) < std::min(t.u1, t.u2) - tolerance ||
        std::min(s.u1, s.u2) > std::max(t.u1, t.u2) + tolerance ||
        std::max(s.v1, s.v2) < std::min(t.v1, t.v2) - tolerance ||
        std::min(s.v1, s.v2) > std::max(t.v1, t.v2) + tolerance)
      continue;
    const double whole = std::max(1e-9, t.length_px());
    const double du = (t.u2 - t.u1) / whole, dv = (t.v2 - t.v1) / whole;
    if (std::abs(du * (s.v2 - s.v1) - dv * (s.u2 - s.u1)) > kAngleSine * length) continue;
    for (int k = 0; k < places; ++k) {
      const double f = (k + 0.5) / places, u = std::lerp(s.u1, s.u2, f) - t.u1,
                   v = std::lerp(s.v1, s.v2, f) - t.v1;
      const double along = std::clamp(u * du + v * dv, 0.0, whole);
      if (std::hypot(u - along * du, v - along * dv) <= tolerance) right[static_cast<std::size_t>(k)] = true;
    }
  }
  return static_cast<double>(std::count(right.begin(), right.end(), true)) / places;
}

Example example_of(const Row& row, std::vector<std::string>& names) {
  const auto sheet = madori::mapping::training_sheet(madori::mapping::load_image(row.drawing));
  const auto truth = read_truth(row.walls);
  names = sheet.features.names();
  Example example{row.source, {}, {}, {}};
  double total = 0;
  for (std::size_t i = 0; i < sheet.features.rows(); ++i) {
    const PixelSegment& e = sheet.edges.edges[i].segment;
    const double k = sheet.edges.factor;
    const PixelSegment s{e.u1 / k, e.v1 / k, e.u2 / k, e.v2 / k};
    const double mu = 0.5 * (s.u1 + s.u2), mv = 0.5 * (s.v1 + s.v2);
    bool use = true;
    for (std::size_t b = 0; b + 3 < row.ignore.size(); b += 4)
      use = use && !(mu >= row.ignore[b] && mu <= row.ignore[b + 2] && mv >= row.ignore[b + 1] &&
                     mv <= row.ignore[b + 3]);
    const bool wall = true_share(s, truth, row.tolerance_px) > 0.5;
    if (!wall && row.truth == "contours" && true_share(s, truth, kUnknownReach * row.tolerance_px) > 0.5)
      use = false;
    if (!use) continue;
    const auto values = sheet.features.row(i);
    example.values.insert(example.values.end(), values.begin(), values.end());
    example.labels.push_back(wall ? 1 : 0);
    example.weights.push_back(static_cast<float>(s.length_px()));
    total += s.length_px();
  }
  for (float& weight : example.weights)
    weight *= static_cast<float>(1000 * row.weight / std::max(1.0, total));
  std::printf("%s: %zu edges\n", row.name.c_str(), example.labels.size());
  std::fflush(stdout);
  return example;
}

/// Boosted trees on all examples but those of one source.
void train(const std::vector<Example>& examples, const std::vector<std::string>& names,
           const std::string& without, const std::string& file) {
  std::vector<float> values, labels, weights;
  for (const Example& e : examples) {
    if (e.source == without) continue;
    values.insert(values.end(), e.values.begin(), e.values.end());
    labels.insert(labels.end(), e.labels.begin(), e.labels.end());
    weights.insert(weights.end(), e.weights.begin(), e.weights.end());
  }
  DMatrixHandle matrix = nullptr;
  check(XGDMatrixCreateFromMat(values.data(), labels.size(), names.size(), -1e9F, &matrix));
  check(XGDMatrixSetFloatInfo(matrix, "label", labels.data(), labels.size()));
  check(XGDMatrixSetFloatInfo(matrix, "weight", weights.data(), weights.size()));
  BoosterHandle booster = nullptr;
  check(XGBoosterCreate(&matrix, 1, &booster));
  const std::vector<std::pair<const char*, const char*>> settings{{"objective", "binary:logistic"},
                                                                  {"tree_method", "hist"},
                                                                  {"max_bin", "64"},
                                                                  {"max_depth", "5"},
                                                                  {"eta", "0.12"},
                                                                  {"subsample", "0.7"},
                                                                  {"lambda", "1"},
                                                                  {"colsample_bytree", "0.4"},
                                                                  {"min_child_weight", "3"},
                                                                  {"nthread", "1"},
                                                                  {"seed", "1"}};
  for (const auto& [name, value] : settings) check(XGBoosterSetParam(booster, name, value));
  for (int round = 0; round < kTrees; ++round) check(XGBoosterUpdateOneIter(booster, round, matrix));
  std::vector<const char*> texts;
  for (const std::string& name : names) texts.push_back(name.c_str());
  check(XGBoosterSetStrFeatureInfo(booster, "feature_name", texts.data(), texts.size()));
  bst_ulong size = 0;
  const char* bytes = nullptr;
  check(XGBoosterSaveModelToBuffer(booster, "{\"format\": \"ubj\"}", &size, &bytes));
  std::ofstream(file, std::ios::binary).write(bytes, static_cast<std::streamsize>(size));
  std::printf("%s: %zu edges, %zu bytes\n", file.c_str(), labels.size(), static_cast<std::size_t>(size));
  std::fflush(stdout);
  XGBoosterFree(booster);
  XGDMatrixFree(matrix);
}

}  // namespace

int main(int count, char** words) try {
  const std::vector<std::string> arguments(words + 1, words + count);
  std::string list, out, leave_out;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--out" && i + 1 < arguments.size()) {
      out = arguments[++i];
    } else if (arguments[i] == "--leave-out" && i + 1 < arguments.size()) {
      leave_out = arguments[++i];
    } else {
      list = arguments[i];
    }
  }
  if (list.empty() || out.empty()) {
    std::fprintf(stderr, "train_walls LIST --out MODEL [--leave-out FOLDER]\n");
    return 2;
  }
  std::vector<Example> examples;
  std::vector<std::string> names;
  std::set<std::string> sources;
  for (const Row& row : read_list(list)) {
    examples.push_back(example_of(row, names));
    if (row.source != "synthetic" && row.source != "home") sources.insert(row.source);
  }
  train(examples, names, "", out);
  if (!leave_out.empty())
    for (const std::string& source : sources)
      train(examples, names, source, leave_out + "/" + source + ".ubj");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "train_walls: %s\n", error.what());
  return 1;
}
