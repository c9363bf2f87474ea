#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "hmi/server/http.hpp"

namespace madori::hmi {

/// Who may do what. On loopback without any PIN everybody is an integrator; on a network a PIN opens a
/// session. PINs are kept as Argon2id hashes (libsodium crypto_pwhash_str), sessions only in memory.
class Access {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  static constexpr std::chrono::minutes kSessionLife{480};  ///< one shift
  static constexpr int kTries = 5;                          ///< wrong PINs an address ...
  static constexpr std::chrono::minutes kTryWindow{1};      ///< ... may give in this time
  /// Wrong PINs that all unknown addresses together may give at once; then one every kTryAgain. The vehicle's
  /// own panel (loopback) and addresses that have logged in before are not held up by what others try.
  static constexpr int kTriesOfAll = 20;
  static constexpr std::chrono::minutes kTryAgain{1};

  /// `pin_file` holds "role hash" lines; absent means no PIN is set. Throws Error on a malformed file,
  /// and on one that cannot be read.
  Access(std::filesystem::path pin_file, bool open_to_network, Clock clock);

  /// The role of a session's token; None for a foreign or expired one.
  [[nodiscard]] Role role_of(const std::string& token);
  [[nodiscard]] bool needs_pin() const;

  struct Login {
    std::optional<std::string> token;
    Role role = Role::None;
    bool too_many_tries = false;
  };
  /// Takes about 0.1 s by design: call it on a worker.
  Login login(const std::string& pin, const std::string& address);
  void logout(const std::string& token);

  /// Stores the PIN of a role (4 to 64 characters). Throws Error on a bad PIN or an unwritable file; then the
  /// old one stays.
  void set_pin(Role role, const std::string& pin);

 private:
  struct Session {
    Role role;
    std::chrono::steady_clock::time_point expires;
  };
  struct Tries {
    int count = 0;
    std::chrono::steady_clock::time_point since;
  };
  bool may_try(const std::string& address);
  bool may_unknown_try();
  [[nodiscard]] bool is_known(const std::string& address) const;

  std::filesystem::path pin_file_;
  bool open_to_network_;
  Clock clock_;
  mutable std::mutex mutex_;
  std::map<Role, std::string> hashes_;
  std::map<std::string, Session> sessions_;
  std::map<std::string, Tries> tries_;
  int tries_of_all_ = kTriesOfAll;  ///< that are left
  std::chrono::steady_clock::time_point tries_of_all_since_;
  std::set<std::string> known_;  ///< addresses that have logged in
};

[[nodiscard]] const char* to_string(Role role);
[[nodiscard]] std::optional<Role> role_from(const std::string& name);

}  // namespace madori::hmi
