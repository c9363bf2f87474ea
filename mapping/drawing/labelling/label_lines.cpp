#include "mapping/drawing/labelling/label_lines.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/drawing/labelling/line_cover.hpp"

namespace madori::mapping {
namespace {

constexpr double kPlace = 3;        // pixels of the sheet between the places of a line that are asked
constexpr double kShortPiece = 12;  // pixels of the sheet: shorter pieces go with their neighbours
constexpr float kCovered = 0.5F;    // of an edge, by lines: it needs no line of its own

struct Piece {
  int from = 0, to = 0;  // places, the last one excluded
  bool wall = false;
};

/// Places without an edge take the probability of the nearest place that has one.
bool fill_unseen(std::vector<double>& places) {
  const auto seen = [](double p) { return p >= 0; };
  const auto first = std::find_if(places.begin(), places.end(), seen);
  if (first == places.end()) return false;
  std::fill(places.begin(), first, *first);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (!seen(places[i])) places[i] = places[i - 1];
  return true;
}

std::vector<Piece> pieces_of(const std::vector<double>& places, double wall_from, int shortest) {
  std::vector<Piece> pieces;
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    const bool wall = places[static_cast<std::size_t>(i)] >= wall_from;
    if (pieces.empty() || pieces.back().wall != wall) pieces.push_back({i, i, wall});
    pieces.back().to = i + 1;
  }
  while (pieces.size() > 1) {  // the shortest first
    const auto least = std::min_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
      return a.to - a.from < b.to - b.from;
    });
    if (least->to - least->from >= shortest) break;
    const auto k = static_cast<std::size_t>(least - pieces.begin());
    const std::size_t into = k == 0 ? 1 : k - 1;
    pieces[into] = {std::min(pieces[into].from, pieces[k].from), std::max(pieces[into].to, pieces[k].to),
                    pieces[into].wall};
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
    for (std::size_t i = pieces.size() - 1; i > 0; --i)
      if (pieces[i].wall == pieces[i - 1].wall) {
        pieces[i - 1].to = pieces[i].to;
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
      }
  }
  return pieces;
}

void append_pieces(DrawnLines& out, const DrawnLine& line, std::vector<double> places, double wall_from) {
  const auto count = static_cast<double>(places.size());
  if (!fill_unseen(places)) {
    out.push_back(line);
    out.back().probability = 0;
    return;
  }
  for (const Piece& piece : pieces_of(places, wall_from, static_cast<int>(kShortPiece / kPlace))) {
    const PixelSegment& s = line.segment;
    const double a = piece.from / count, b = piece.to / count;
    DrawnLine part = line;
    part.segment = {std::lerp(s.u1, s.u2, a), std::lerp(s.v1, s.v2, a), std::lerp(s.u1, s.u2, b),
                    std::lerp(s.v1, s.v2, b)};
    double sum = 0;
    for (int i = piece.from; i < piece.to; ++i) sum += places[static_cast<std::size_t>(i)];
    part.probability = sum / (piece.to - piece.from);
    out.push_back(part);
  }
}

}  // namespace

LabelSheet label_sheet(const GrayImage& drawing) {
  LabelSheet sheet;
  sheet.edges = find_edges(drawing);
  EdgeMeasures measures = measure_edges(sheet.edges);
  sheet.features = edge_features(sheet.edges, measures);
  auto& [styles, looks, chains, clusters] = sheet.groups.together;
  styles = std::move(measures.styles);
  looks = std::move(measures.looks);
  for (std::size_t i = 0; i < sheet.edges.edges.size(); ++i) {
    chains.push_back(static_cast<int>(measures.links[i].chain));
    clusters.push_back(static_cast<int>(measures.links[i].cluster));
    sheet.groups.partner[0].push_back(measures.views[i].dark.hits[0].edge);
    sheet.groups.partner[1].push_back(measures.views[i].bright.hits[0].edge);
  }
  return sheet;
}

std::vector<float> judge_edges(const LabelSheet& sheet, const WallModel& model) {
  std::vector<PixelSegment> segments;
  for (const Edge& edge : sheet.edges.edges) segments.push_back(edge.segment);
  FeatureTable context = sheet_context(segments, sheet.groups, model.first(sheet.features));
  context.add(sheet.features);
  return model.second(context);
}

DrawnLines label_lines(const LabelSheet& sheet, const std::vector<float>& probabilities,
                       const DrawnLines& drawn, double u_scale, double v_scale, double wall_from) {
  const double factor = sheet.edges.factor;
  const LineCover cover(drawn, sheet.edges, u_scale * factor, v_scale * factor);
  DrawnLines labelled;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double length = drawn[i].length_px() * u_scale * factor;
    std::vector<double> places(std::max<std::size_t>(1, static_cast<std::size_t>(length / kPlace)));
    for (std::size_t k = 0; k < places.size(); ++k)
      places[k] =
          cover.at(i, (static_cast<double>(k) + 0.5) / static_cast<double>(places.size()), probabilities);
    append_pieces(labelled, drawn[i], std::move(places), wall_from);
  }
  const auto covered = cover.covered(std::vector<bool>(drawn.size(), true));
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (covered[i] >= kCovered) continue;
    const PixelSegment& s = sheet.edges.edges[i].segment;
    DrawnLine line;
    line.segment = {s.u1 / factor / u_scale, s.v1 / factor / v_scale, s.u2 / factor / u_scale,
                    s.v2 / factor / v_scale};
    line.solid_face = line.pale = true;
    line.probability = probabilities[i];
    labelled.push_back(line);
  }
  return labelled;
}

}  // namespace madori::mapping
