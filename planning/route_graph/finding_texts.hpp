#pragma once

#include <array>
#include <map>
#include <string>

#include "planning/route_graph/route_csv.hpp"

namespace madori::planning {

/// What can be wrong, or worth knowing, about routes; each has its line in kFindingTexts, in the same order.
enum class Fault {
  UnknownColumn,
  MissingColumn,
  NumberOutOfRange,
  UnknownAction,
  BadStation,
  BadId,
  RepeatedId,
  NoNode,
  UnknownNeighbour,
  BadNeighbour,
  TooManyColumns,
  SurplusField,
  OwnNeighbour,
  RepeatedNeighbour,
  RepeatedRow,
  ThroughWall,
  NarrowAtWall,
  NoWayBack,
  OutOfReach,
  ShortLeg,
  OneWay,
  OpenQuote,
  NotText,
  TightCorner,
  NoTurnAbout,
};

/// The panel's catalogues know a finding by its code; `english` holds {placeholders}.
struct FindingText {
  const char* code;
  const char* english;
};

inline constexpr std::array kFindingTexts{
    FindingText{
        "unknown-column",
        "column \"{column}\" is not known - use ID, x, y, name, station, heading_deg, speed_mps, action"},
    FindingText{"missing-column", "column {column} is missing"},
    FindingText{"number-out-of-range", "{column} \"{text}\" must be a number from {low} to {high}"},
    FindingText{"unknown-action", "action \"{text}\" is not known - use load, unload, door or lift"},
    FindingText{"bad-station", "station \"{text}\" must be 1 or 0"},
    FindingText{"bad-id", "ID \"{text}\" must be a whole number from 0"},
    FindingText{"repeated-id", "ID {node} stands already on line {earlier} - give one of them another ID"},
    FindingText{"no-node", "holds no node"},
    FindingText{"unknown-neighbour",
                "node {text} is not in path.csv - add its position there or remove it here"},
    FindingText{"bad-neighbour", "\"{text}\" is no node ID - separate neighbours by spaces"},
    FindingText{"too-many-columns", "has more than two columns - separate neighbours by spaces"},
    FindingText{"surplus-field",
                "\"{text}\" stands in no column - where numbers have decimal commas, separate the fields by "
                "semicolons"},
    FindingText{"own-neighbour", "node {node} is its own neighbour - left out"},
    FindingText{"repeated-neighbour", "neighbour {node} stands twice - counted once"},
    FindingText{"repeated-row", "node {node} stands already on line {earlier} - join the two lines"},
    FindingText{"through-wall",
                "leg {from} -> {to} goes through a drawn wall - move a node or erase the wall"},
    FindingText{"narrow-at-wall",
                "leg {from} -> {to} passes a drawn wall at {distance} m, less than half the vehicle's width "
                "of {half} m"},
    FindingText{"no-way-back", "from node {node} no way leads back to the other nodes"},
    FindingText{"out-of-reach", "node {node} cannot be reached from the other nodes"},
    FindingText{"short-leg", "leg {from} -> {to} is only {length} m long"},
    FindingText{"one-way", "leg {from} -> {to} is one-way: node {to} does not list node {from}"},
    FindingText{"open-quote", "a double quote begins and does not end - close it or remove it"},
    FindingText{
        "not-text",
        "is no text in UTF-8 (another code page, UTF-16, or no text at all) - save it as CSV in UTF-8 "
        "(Excel: \"CSV UTF-8\")"},
    FindingText{"tight-corner",
                "a vehicle of {length} m does not get round node {node} from {from} to {to}: a drawn wall is "
                "in its way - move the node, or drive with a shorter vehicle"},
    FindingText{"no-turn-about",
                "a vehicle of {length} m cannot turn about at node {node}: a drawn wall is in its way"},
};

/// A finding with its English text. Precondition: `values` names every placeholder of the fault's text.
[[nodiscard]] RouteFinding finding(Fault fault, Severity severity, std::string file, int line,
                                   std::map<std::string, std::string> values = {});

}  // namespace madori::planning
