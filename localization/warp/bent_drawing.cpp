#include "localization/warp/bent_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/warp/other_ways.hpp"
#include "localization/warp/place_by_clearances.hpp"

namespace madori::localization {
namespace {

/// A fit goes on from the one before, a few keyframes later (docs/explanation/warp.md): by so many walls of
/// two metres, or by so much of what is known.
constexpr double kMoreWalls = 4.0;
constexpr double kGrowth = 1.05;

/// How far a place lies beside where the warp carries it, as the walls around it do: an uncertain field,
/// walls beside it, their pieces. The field is off by half as much again as it says
/// (docs/explanation/warp.md).
double beside_m(const DrawingWarp& warp, const Point2<Map>& drawn) {
  constexpr double kMoreThanSaid = 1.5, kLeastM = 0.01;
  const WarpStatistics& known = warp.statistics();
  return std::max(kLeastM, kMoreThanSaid * std::hypot(warp.sigma_m(drawn), known.offset_m, known.residual_m));
}

std::pair<double, double> in_order(const Point2<Map>& p) {
  return {p.x_m, p.y_m};
}

}  // namespace

Transform2<Map, Base> BentDrawing::in_building(const Transform2<Map, Base>& on_drawing) const {
  const Transform2<Building, Base> pose = fit.warp.building(on_drawing);
  return {pose.x_m(), pose.y_m(), pose.yaw_rad()};
}

Transform2<Map, Base> BentDrawing::on_drawing(const Transform2<Map, Base>& in_building) const {
  return fit.warp.map(
      Transform2<Building, Base>(in_building.x_m(), in_building.y_m(), in_building.yaw_rad()));
}

double BentDrawing::share_within(const Transform2<Map, Base>& in_building, double m) const {
  const Point2<Building> place{in_building.x_m(), in_building.y_m()};
  const Point2<Map> here = fit.warp.map(place);
  double near = 1.0, all = 1.0;
  for (const OtherWay& other : fit.others) {
    all += other.odds;
    if (distance_m(other.warp.map(place), here) <= m) near += other.odds;
  }
  return near / all;
}

Point2<Map> BentDrawing::place(const Point2<Map>& on_drawing) const {
  const auto found = std::ranges::lower_bound(places, in_order(on_drawing), {},
                                              [](const Place& p) { return in_order(p.drawn); });
  if (found != places.end() && found->drawn == on_drawing) return found->stands;
  return in_building({on_drawing.x_m, on_drawing.y_m, 0.0}).translation();
}

Transform2<Map, Base> BendingDrawing::in_building(const Transform2<Map, Base>& on_drawing) const {
  return bent_ ? bent_->in_building(on_drawing) : on_drawing;
}

Transform2<Map, Base> BendingDrawing::on_drawing(const Transform2<Map, Base>& in_building) const {
  return bent_ ? bent_->on_drawing(in_building) : in_building;
}

SharedError BendingDrawing::shared_error() const {
  if (!bent_) return {};
  const WarpStatistics& known = bent_->fit.warp.statistics();
  return {known.amplitude_m, known.range_m};
}

void BendingDrawing::take(const WarpFit& fit, const MemoryCloud& cloud) {
  start_ = fit.next;
  if (fit.warp.is_identity()) {
    bent_ = nullptr;
    standing_ = drawn_;
    return;
  }
  const mapping::Walls& walls = drawn_.index().walls();
  mapping::Walls stands = walls_in_building(walls, fit);
  standing_ = DrawingFit(stands, standing_.model());
  BentDrawing bent{fit, std::move(stands), {}};
  for (const Point2<Map>& drawn : places_) {
    const Point2<Building> carried = fit.warp.building(drawn);
    bent.places.push_back({drawn, place_by_clearances(walls, cloud, drawn, {carried.x_m, carried.y_m},
                                                      beside_m(fit.warp, drawn))});
  }
  std::ranges::sort(bent.places, {}, [](const BentDrawing::Place& p) { return in_order(p.drawn); });
  bent_ = std::make_shared<const BentDrawing>(std::move(bent));
}

void BendingDrawing::bend(const MemoryCloud& cloud, const Point2<Map>& at, const WarpPrior& told) {
  const double walls = DrawingFit::walls_seen(cloud);
  if (walls < next_walls_) return;
  next_walls_ = std::max(walls + kMoreWalls, kGrowth * walls);
  const auto others = other_ways(drawn_.index(), cloud, start_, {at.x_m, at.y_m});
  take(fit_warp(drawn_.index(), cloud, start_, others, told), cloud);
}

void BendingDrawing::straighten() {
  start_ = {};
  next_walls_ = 0.0;
  bent_ = nullptr;
  standing_ = drawn_;
}

void BendingDrawing::learn(const MemoryCloud& cloud) {
  drawn_.learn(cloud);
  if (bent_)
    standing_.learn(cloud);
  else
    standing_ = drawn_;
}

}  // namespace madori::localization
