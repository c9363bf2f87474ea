#include "hmi/server/revisions.hpp"

#include <sodium.h>

#include <array>
#include <initializer_list>
#include <string_view>

#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_transaction.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

std::string hash_of(std::initializer_list<std::string_view> parts) {
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, 16);
  constexpr unsigned char kEnd = 0;
  for (const auto& part : parts) {
    crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(part.data()), part.size());
    crypto_generichash_update(&state, &kEnd, 1);
  }
  std::array<unsigned char, 16> hash{};
  crypto_generichash_final(&state, hash.data(), hash.size());
  std::array<char, 33> text{};
  sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
  return text.data();
}

std::string content_of(const fs::path& file) {
  std::error_code missing;
  return fs::exists(file, missing) ? mapping::file_content(file) : std::string();
}

/// site.yaml with only the part that counts, as text.
template <class Reduce>
std::string part_of_site(const fs::path& folder, Reduce reduce) {
  std::error_code missing;
  if (!fs::exists(folder / "site.yaml", missing)) return "";
  mapping::Site site = mapping::read_site_file(folder / "site.yaml");  // waits for no change
  reduce(site);
  return mapping::site_yaml(site);
}

}  // namespace

std::string walls_revision(const fs::path& site) {
  return hash_of({content_of(site / "walls.csv")});
}

std::string routes_revision(const fs::path& site) {
  return hash_of({content_of(site / "routes/tree.csv"), content_of(site / "routes/path.csv")});
}

std::string drawing_revision(const fs::path& site) {
  return hash_of({part_of_site(site, [](mapping::Site& s) {
    s.vehicle = {};
    s.sensors.clear();
  })});
}

std::string vehicle_revision(const fs::path& site) {
  return hash_of({part_of_site(site, [](mapping::Site& s) {
    s.name = "-";
    s.drawing = {"-", 1, 1, 1, 0.0};
    s.scale.reset();
    s.georeference.reset();
  })});
}

SiteRevisions RevisionWatch::now() const {
  const std::scoped_lock lock(mutex_);
  const auto touched = mapping::site_identity(site_);
  if (touched == touched_ || mapping::is_being_changed(site_)) return last_;
  last_ = {"unreadable", "unreadable", "unreadable", "unreadable"};
  try {
    last_.walls = walls_revision(site_);
    last_.routes = routes_revision(site_);
    last_.drawing = drawing_revision(site_);
    last_.vehicle = vehicle_revision(site_);
  } catch (const std::exception&) {
    // The panel asks for the site itself then, and is told what is wrong with it.
  }
  touched_ = touched;
  return last_;
}

}  // namespace madori::hmi
