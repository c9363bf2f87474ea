#pragma once

#include "tests/bench/wall_training/plan_layout.hpp"

namespace madori::training {

/// What stands in rooms and is no wall: furniture, machines, stairs, racks, tiles, words.
void furnish(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance);
/// What is drawn around and over a building: dimensions, axes, frames, title blocks, gardens, routes.
void annotate(PlanCanvas& canvas, const PlanStyle& style, const Box& building, Chance& chance);
/// What is drawn around the whole sheet; the canvas stands at its corner.
void frame_sheet(PlanCanvas& canvas, const PlanStyle& style, const Box& sheet, Chance& chance);

/// Bodies of light walls that stand free in a large room: a cabin with its door, a round screen, bays.
void partition(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance);
/// Around a factory's sheet: creases, frame, title block, list of parts; the canvas stands at its corner.
void frame_large_sheet(PlanCanvas& canvas, const PlanStyle& style, const Box& sheet, Chance& chance);

}  // namespace madori::training
