#include "app/cycle/notice.hpp"

#include <cstddef>
#include <utility>

#include "core/fill_in.hpp"

namespace madori::app {
namespace {

static_assert(kCauses.size() == static_cast<std::size_t>(Cause::FoundElsewhere) + 1);
static_assert(kRemedies.size() == static_cast<std::size_t>(Remedy::LookAtPlaceAndResume) + 1);

}  // namespace

const CatalogueEntry& entry(Cause cause) {
  return kCauses.at(static_cast<std::size_t>(cause));
}

const CatalogueEntry& entry(Remedy remedy) {
  return kRemedies.at(static_cast<std::size_t>(remedy));
}

Notice notice(const CatalogueEntry& entry, std::map<std::string, std::string> values) {
  std::string text = fill_in(entry.english, values);
  return {entry.code, std::move(values), std::move(text)};
}

Notice notice(Cause cause, std::map<std::string, std::string> values) {
  return notice(entry(cause), std::move(values));
}

Notice notice(Remedy remedy, std::map<std::string, std::string> values) {
  return notice(entry(remedy), std::move(values));
}

}  // namespace madori::app
