#pragma once

#include <array>
#include <string>
#include <string_view>

namespace madori::localization {

/// Why the place is not known, in an operator's words; panels know each by its code.
struct Reason {
  const char* code;
  const char* english;
};

namespace reason {
inline constexpr Reason kNoScan{"no-scan-yet", "no scan yet"};
inline constexpr Reason kNothingToSearch{"nothing-to-search", "the scan has no points, or the map no places"};
inline constexpr Reason kNoPlace{"no-place", "no place on the drawing explains the scan"};
inline constexpr Reason kNoneSure{"none-sure",
                                  "several places on the drawing explain what is seen, none of them surely"};
inline constexpr Reason kThroughWalls{"through-walls",
                                      "the best place would have the lidar look through drawn walls"};
inline constexpr Reason kTwoAlike{"two-alike", "two places look alike"};
inline constexpr Reason kMuchUndrawn{"much-undrawn",
                                     "much of what is seen is not drawn, and no place stands out"};
inline constexpr Reason kThroughSomeWalls{
    "through-some-walls", "the likeliest place would have the lidar look through some drawn walls"};
inline constexpr Reason kComparing{"comparing", "comparing what is seen with the place that was given"};
inline constexpr Reason kSearching{"searching", "looking for the place on the drawing"};
inline constexpr Reason kOnceMore{"once-more", "found, looking once more"};
inline constexpr Reason kSeesNothing{"sees-nothing", "the lidar sees next to nothing"};
inline constexpr Reason kLittleDrawn{"little-drawn", "too little of what is seen is drawn"};
inline constexpr Reason kWallsAndWheels{"walls-and-wheels", "walls and wheels do not agree"};
inline constexpr Reason kMovedByHand{
    "moved-by-hand", "another place on the drawing fits better: was the vehicle moved by hand?"};
inline constexpr Reason kOtherSurroundings{
    "other-surroundings", "all at once the lidar sees other surroundings: was the vehicle moved by hand?"};
inline constexpr Reason kChangedAndAlike{
    "changed-and-alike",
    "what the lidar sees has changed, and another place looks alike: was the vehicle moved by hand?"};
/// Followed by the reason of the comparison.
inline constexpr Reason kGivenRefuted{"given-refuted",
                                      "what is seen does not fit the place that was given: "};
}  // namespace reason

inline constexpr std::array kReasons{
    reason::kNoScan,         reason::kNothingToSearch, reason::kNoPlace,           reason::kThroughWalls,
    reason::kTwoAlike,       reason::kMuchUndrawn,     reason::kThroughSomeWalls,  reason::kComparing,
    reason::kSearching,      reason::kOnceMore,        reason::kSeesNothing,       reason::kLittleDrawn,
    reason::kWallsAndWheels, reason::kMovedByHand,     reason::kOtherSurroundings, reason::kChangedAndAlike,
    reason::kGivenRefuted,   reason::kNoneSure};

/// The codes of a LocalizationHealth's reason, the outer one first, joined by '+'; empty for one that is not
/// in kReasons.
[[nodiscard]] std::string reason_codes(std::string_view english);

}  // namespace madori::localization
