#pragma once

#include <optional>

#include "localization/global/global_localizer.hpp"
#include "localization/registration/point_map.hpp"
#include "localization/registration/rdnm.hpp"

namespace madori::localization {

/// The localization strategies of Kis, Csemesz, Csáji (2021), against the drawing as the map.
struct StrategyOptions {
  double most_e_psr_m = 0.10;       ///< e_max: a registration of a larger error has failed
  double candidate_radius_m = 0.3;  ///< of the six local candidates around the assumed position
  double view_radius_m = 30.0;      ///< the map's points within it make the candidates' views
  RdnOptions rdn;
};

enum class Strategy { Rdnm, Cpd, Absolute };
[[nodiscard]] const char* to_string(Strategy strategy);

struct StrategyResult {
  RegistrationResult fit;
  Strategy strategy = Strategy::Rdnm;  ///< the one that succeeded
};

/// Algorithm 2: the whole map's places by RDNM, then ICP; nothing when e_psr stays above the limit.
[[nodiscard]] std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan,
                                                                const GlobalLocalizer& global,
                                                                const StrategyOptions& options = {});

/// Algorithm 3: RDNM around the assumed pose and ICP; failing that CPD and ICP; failing that Algorithm 2.
[[nodiscard]] std::optional<StrategyResult> localize_relatively(const ScanPoints& scan,
                                                                const GlobalLocalizer& global,
                                                                const PointMap& map,
                                                                const Transform2<Map, Base>& assumed,
                                                                const StrategyOptions& options = {});

}  // namespace madori::localization
