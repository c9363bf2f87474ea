#include "hmi/server/access.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::hmi {
namespace {

constexpr std::size_t kMostSessions = 1000;
constexpr std::size_t kMostAddresses = 10'000;

std::string new_token() {
  std::array<unsigned char, 32> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  std::array<char, 2 * 32 + 1> text{};
  sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
  return text.data();
}

std::map<Role, std::string> read_hashes(const std::filesystem::path& file) {
  std::map<Role, std::string> hashes;
  std::error_code unknown;
  if (std::filesystem::status(file, unknown).type() == std::filesystem::file_type::not_found) return hashes;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty()) continue;
    std::istringstream words(line);
    std::string name;
    std::string hash;
    words >> name >> hash;
    const auto role = role_from(name);
    if (!role || !hash.starts_with("$argon2"))
      throw Error(file.string() + ":" + std::to_string(number), "is no `role hash` line",
                  "remove the line and set the PIN again: madori pin");
    hashes[*role] = hash;
  }
  if (!stream.eof())  // without its PINs the panel would be open to everybody
    throw Error(file.string(), "cannot be read", "let the user own it that runs this program");
  return hashes;
}

}  // namespace

Access::Access(std::filesystem::path pin_file, bool open_to_network, Clock clock)
    : pin_file_(std::move(pin_file)),
      open_to_network_(open_to_network),
      clock_(std::move(clock)),
      tries_of_all_since_(clock_()) {
  if (sodium_init() < 0) throw Error("libsodium", "cannot be started", "reinstall the package libsodium23");
  hashes_ = read_hashes(pin_file_);
}

bool Access::needs_pin() const {
  const std::scoped_lock lock(mutex_);
  return open_to_network_ || !hashes_.empty();
}

Role Access::role_of(const std::string& token) {
  const std::scoped_lock lock(mutex_);
  if (!open_to_network_ && hashes_.empty()) return Role::Integrator;
  const auto found = sessions_.find(token);
  if (found == sessions_.end()) return Role::None;
  if (found->second.expires <= clock_()) {
    sessions_.erase(found);
    return Role::None;
  }
  return found->second.role;
}

bool Access::may_try(const std::string& address) {
  const auto now = clock_();
  if (tries_.size() > kMostAddresses)
    std::erase_if(tries_, [&](const auto& t) { return now - t.second.since > kTryWindow; });
  Tries& tries = tries_[address];
  if (now - tries.since > kTryWindow) tries = {0, now};
  return ++tries.count <= kTries && (is_known(address) || may_unknown_try());
}

bool Access::is_known(const std::string& address) const {
  return known_.contains(address) || address.starts_with("127.") || address == "::1";
}

/// A bucket that fills up slowly: four digits, tried from everywhere, last a week.
bool Access::may_unknown_try() {
  const auto now = clock_();
  const auto more = (now - tries_of_all_since_) / kTryAgain;
  if (more > 0) {
    tries_of_all_since_ += more * kTryAgain;
    tries_of_all_ = static_cast<int>(std::min<std::int64_t>(kTriesOfAll, tries_of_all_ + std::int64_t{more}));
  }
  if (tries_of_all_ == 0) return false;
  --tries_of_all_;
  return true;
}

Access::Login Access::login(const std::string& pin, const std::string& address) {
  std::map<Role, std::string> hashes;
  {
    const std::scoped_lock lock(mutex_);
    if (!may_try(address)) return {std::nullopt, Role::None, true};
    hashes = hashes_;
  }
  // The highest role wins where two roles were given the same PIN. Hashing is slow: no lock is held.
  Role role = Role::None;
  for (const auto& [candidate, hash] : hashes)
    if (crypto_pwhash_str_verify(hash.c_str(), pin.data(), pin.size()) == 0) role = std::max(role, candidate);
  if (role == Role::None) return {};

  const std::scoped_lock lock(mutex_);
  const auto now = clock_();
  std::erase_if(sessions_, [&](const auto& s) { return s.second.expires <= now; });
  if (sessions_.size() >= kMostSessions) return {std::nullopt, Role::None, true};
  tries_.erase(address);
  if (!is_known(address)) tries_of_all_ = std::min(kTriesOfAll, tries_of_all_ + 1);
  if (known_.size() < kMostAddresses) known_.insert(address);
  std::string token = new_token();
  sessions_[token] = {role, now + kSessionLife};
  return {std::move(token), role, false};
}

void Access::logout(const std::string& token) {
  const std::scoped_lock lock(mutex_);
  sessions_.erase(token);
}

void Access::set_pin(Role role, const std::string& pin) {
  if (pin.size() < 4 || pin.size() > 64 || role == Role::None)
    throw Error("PIN", "must have 4 to 64 characters", "choose another one");
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (crypto_pwhash_str(hash.data(), pin.data(), pin.size(), crypto_pwhash_OPSLIMIT_INTERACTIVE,
                        crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0)
    throw Error("PIN", "cannot be hashed: not enough memory", "free some memory and try again");
  const std::scoped_lock lock(mutex_);
  auto hashes = hashes_;
  hashes[role] = hash.data();
  std::string text;
  for (const auto& [r, h] : hashes) text += std::string(to_string(r)) + ' ' + h + '\n';
  mapping::write_file_atomically(pin_file_, text, mapping::Secrecy::OwnerOnly);
  hashes_ = std::move(hashes);
  std::erase_if(sessions_, [&](const auto& s) { return s.second.role == role; });
}

const char* to_string(Role role) {
  switch (role) {
    case Role::None:
      return "none";
    case Role::Viewer:
      return "viewer";
    case Role::Operator:
      return "operator";
    case Role::Integrator:
      return "integrator";
  }
  return "none";
}

std::optional<Role> role_from(const std::string& name) {
  for (const Role role : {Role::Viewer, Role::Operator, Role::Integrator})
    if (name == to_string(role)) return role;
  return std::nullopt;
}

}  // namespace madori::hmi
