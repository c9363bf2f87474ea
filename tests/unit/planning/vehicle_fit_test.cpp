#include "planning/route_graph/vehicle_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/route_graph/route_check.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::planning {
namespace {

/// An L: 8 m east along the x axis, then 8 m north, aisles of this width; node 1 is the corner.
struct Aisle {
  explicit Aisle(double width_m) {
    const double h = width_m / 2.0;
    walls = {{{-3, -h}, {8 + h, -h}},
             {{8 + h, -h}, {8 + h, 11}},
             {{-3, h}, {8 - h, h}},
             {{8 - h, h}, {8 - h, 11}}};
  }
  [[nodiscard]] std::vector<TightCorner> tight(const VehicleOutline& vehicle) const {
    return tight_corners(routes, WallGrid(walls), vehicle);
  }
  RouteGraph routes =
      parse_routes("ID,EDA\n0,1\n1,0 2\n2,1\n", "ID,x,y,station\n0,0,0,1\n1,8,0,0\n2,8,8,1\n").graph;
  std::vector<Segment2<Map>> walls;
};

constexpr VehicleOutline kUsual{0.8, 0.2, 0.3, 0.8};
constexpr VehicleOutline kLong{1.7, 0.3, 0.3, 0.8};  ///< 2 m, turns about its rear

TEST(VehicleFit, ALongVehicleDoesNotGetRoundANarrowCorner) {
  const auto found = Aisle(1.6).tight(kLong);
  const auto corners = std::ranges::count_if(found, [](const auto& c) { return c.from != c.to; });
  EXPECT_EQ(corners, 2) << "both ways round";
  for (const auto& corner : found) {
    if (corner.from != corner.to) {
      EXPECT_EQ(corner.node, 1U);
    }
  }
}

TEST(VehicleFit, WideAislesAndShortVehiclesAreFree) {
  EXPECT_TRUE(Aisle(4.2).tight(kLong).empty());
  EXPECT_TRUE(Aisle(2.0).tight(kUsual).empty());
  EXPECT_TRUE(tight_corners({}, WallGrid(), kLong).empty());
}

TEST(VehicleFit, ADeadEndInWhichItCannotTurnAboutIsFound) {
  const auto found = Aisle(1.6).tight({0.9, 0.1, 0.3, 0.8});
  for (const std::size_t end : {0U, 2U})
    EXPECT_TRUE(std::ranges::any_of(found, [&](const auto& c) { return c.node == end && c.from == c.to; }))
        << end;
}

TEST(VehicleFit, TheRouteCheckSaysItInWords) {
  const Aisle aisle(1.6);
  const auto said = [&](const VehicleOutline& vehicle, Severity severity, const std::string& text) {
    const auto findings = check_routes(aisle.routes, aisle.walls, {.vehicle = vehicle});
    return std::ranges::count_if(findings, [&](const RouteFinding& f) {
      return f.severity == severity && f.text().find(text) != std::string::npos;
    });
  };
  EXPECT_EQ(said(kLong, Severity::Error, "a vehicle of 2.00 m does not get round node 1"), 1);
  EXPECT_EQ(said(kLong, Severity::Warning, "cannot turn about at node"), 2);
  EXPECT_EQ(said({0.3, 0.3, 0.3, 0.8}, Severity::Error, "does not get round"), 0);
}

}  // namespace
}  // namespace madori::planning
