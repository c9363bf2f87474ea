#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/drawing/labelling/label_sheet.hpp"

namespace madori::training {

/// One drawing to train on: where it is, what its truth is. Truth: faces, lines or contours.
struct ListRow {
  std::string name, source, drawing, walls, truth;
  double weight = 1, tolerance_px = 4;
  std::vector<double> ignore;  ///< boxes u1 v1 u2 v2
};

/// Rows of a CSV file name,source,weight,drawing,walls,tolerance_px,truth,ignore. Throws Error.
[[nodiscard]] std::vector<ListRow> read_list(const std::string& file);

inline constexpr std::size_t kGroups = 6;

/// What the trees see of a drawing: a row an edge.
struct ExampleSheet {
  std::string name, source, truth;
  float weight = 1;
  std::vector<std::string> features;
  std::vector<float> values;    ///< row-major
  std::vector<float> segments;  ///< u1 v1 u2 v2, pixels of the drawing
  std::vector<float> near,
      far;                  ///< share of an edge that lies beside a wall of the truth, closely and widely
  std::vector<int> used;    ///< 0 where the truth says nothing
  std::vector<int> groups;  ///< kGroups a row: style, look, chain, cluster, partners over dark and bright
  [[nodiscard]] std::size_t rows() const { return near.size(); }
};

[[nodiscard]] ExampleSheet measure(const ListRow& row);
void save(const ExampleSheet& sheet, const std::filesystem::path& file);
[[nodiscard]] ExampleSheet load_sheet(const std::filesystem::path& file);

}  // namespace madori::training
