#pragma once

#include <memory>
#include <string>

#include "app/cycle/pose_source.hpp"
#include "app/cycle/site_config.hpp"
#include "simulation/factory.hpp"

namespace madori::bench {

/// A name beside those of localizer_names(): the true pose drives.
inline constexpr const char* kTruth = "truth";

/// The pose source that drives, by its name and by what it looks with: "vlp16", the revolutions that the
/// cycle gets, or "scan", a 2D scanner in process (the cycle sees obstacles with its VLP-16 nevertheless).
/// The factory outlives the source. Precondition: kTruth or one of localizer_names().
[[nodiscard]] std::unique_ptr<app::PoseSource> make_pose_source(const std::string& name,
                                                                const std::string& sensor,
                                                                const app::SiteForDriving& site,
                                                                const simulation::Factory& factory);

}  // namespace madori::bench
