#include "planning/route_graph/finding_texts.hpp"

#include <cstddef>
#include <utility>

#include "core/fill_in.hpp"

namespace madori::planning {

static_assert(kFindingTexts.size() == static_cast<std::size_t>(Fault::NoTurnAbout) + 1);

RouteFinding finding(Fault fault, Severity severity, std::string file, int line,
                     std::map<std::string, std::string> values) {
  const auto& [code, english] = kFindingTexts.at(static_cast<std::size_t>(fault));
  std::string message = fill_in(english, values);
  return {severity, std::move(file), line, std::move(message), code, std::move(values)};
}

}  // namespace madori::planning
