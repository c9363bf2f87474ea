#include "mapping/drawing/labelling/wall_model.hpp"

#include <xgboost/c_api.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "core/result.hpp"

// The model file becomes read-only data of the library.
asm(".pushsection .rodata\n"
    ".balign 16\n"
    "madori_wall_model: .incbin \"" MADORI_WALL_MODEL
    "\"\n"
    "madori_wall_model_end: .byte 0\n"
    ".popsection\n");
extern "C" const char madori_wall_model[];
extern "C" const char madori_wall_model_end[];

namespace madori::mapping {
namespace {

void check(int status, const std::string& name) {
  if (status != 0) throw Error(name, XGBGetLastError(), "train it again: train_walls");
}

}  // namespace

struct WallModel::Trees {
  Trees() = default;
  Trees(const Trees&) = delete;
  Trees& operator=(const Trees&) = delete;
  ~Trees() { XGBoosterFree(booster); }
  std::string name;
  BoosterHandle booster = nullptr;
  std::vector<std::string> features;
};

WallModel::Judge WallModel::judge_from(const std::string& name, const char* bytes, std::size_t size) {
  auto trees = std::make_shared<Trees>();
  trees->name = name;
  check(XGBoosterCreate(nullptr, 0, &trees->booster), name);
  check(XGBoosterLoadModelFromBuffer(trees->booster, bytes, size), name);
  check(XGBoosterSetParam(trees->booster, "nthread", "1"), name);  // the same sums in the same order
  bst_ulong count = 0;
  const char** names = nullptr;
  check(XGBoosterGetStrFeatureInfo(trees->booster, "feature_name", &count, &names), name);
  trees->features.assign(names, names + count);
  return trees;
}

/// A line with the sizes of both judges, then both.
WallModel WallModel::from_bytes(const std::string& name, const char* bytes, std::size_t size) {
  const char* const end = std::find(bytes, bytes + std::min<std::size_t>(size, 64), '\n');
  std::istringstream header(std::string(bytes, end));
  std::string kind;
  std::size_t first = 0, second = 0;
  header >> kind >> first >> second;
  const std::size_t begin = static_cast<std::size_t>(end - bytes) + 1;
  if (kind != "madori-walls-2" || begin + first + second != size)
    throw Error(name, "is no wall model of this version", "train it again: train_walls");
  return {judge_from(name, bytes + begin, first), judge_from(name, bytes + begin + first, second)};
}

WallModel WallModel::load(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string(), "cannot be opened", "name a model that train_walls wrote");
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  return from_bytes(file.string(), bytes.data(), bytes.size());
}

const WallModel& WallModel::shipped() {
  // Never destroyed: at the end of the program xgboost's own statics are gone before it.
  static const WallModel& model =
      *new WallModel(from_bytes("the wall model", madori_wall_model,
                                static_cast<std::size_t>(madori_wall_model_end - madori_wall_model)));
  return model;
}

std::vector<float> WallModel::judged(const Trees& trees, const FeatureTable& features) {
  if (features.names() != trees.features)
    throw Error(trees.name, "was trained on other features than this version measures",
                "train it again: train_walls");
  if (features.rows() == 0) return {};
  std::vector<float> values;
  for (std::size_t i = 0; i < features.rows(); ++i) {
    const auto row = features.row(i);
    values.insert(values.end(), row.begin(), row.end());
  }
  DMatrixHandle matrix = nullptr;
  check(XGDMatrixCreateFromMat(values.data(), features.rows(), features.names().size(), -1e9F, &matrix),
        trees.name);
  const std::unique_ptr<void, int (*)(DMatrixHandle)> owner(matrix, XGDMatrixFree);
  bst_ulong count = 0;
  const float* result = nullptr;
  check(XGBoosterPredict(trees.booster, matrix, 0, 0, 0, &count, &result), trees.name);
  return {result, result + count};
}

std::vector<float> WallModel::first(const FeatureTable& features) const {
  return judged(*first_, features);
}
std::vector<float> WallModel::second(const FeatureTable& context) const {
  return judged(*second_, context);
}

}  // namespace madori::mapping
