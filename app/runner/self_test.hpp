#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/cycle/site_config.hpp"

namespace madori::app {

/// What one look at a site came to.
struct Finding {
  std::string what;  ///< site, routes, sight, floor, field, orders, disk
  std::string text;  ///< what is there; or what is missing, and the mend
  bool missing = false;
};

/// What `at` came to: its words, or those of what it threw.
[[nodiscard]] Finding look(const char* what, const std::function<std::string()>& at);

struct SelfTest {
  std::vector<Finding> findings;
  std::unique_ptr<SiteForDriving> site;  ///< null where it cannot be loaded
};

/// Everything that can be known of a site before it is driven, but for its devices. Never throws.
[[nodiscard]] SelfTest look_at_site(const std::filesystem::path& site);

}  // namespace madori::app
