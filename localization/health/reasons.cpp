#include "localization/health/reasons.hpp"

namespace madori::localization {

std::string reason_codes(std::string_view english) {
  for (const Reason& known : kReasons)
    if (english == known.english) return known.code;
  const std::string_view prefix = reason::kGivenRefuted.english;
  if (!english.starts_with(prefix)) return "";
  const std::string inner = reason_codes(english.substr(prefix.size()));
  return inner.empty() ? "" : std::string(reason::kGivenRefuted.code) + "+" + inner;
}

}  // namespace madori::localization
