#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace madori {

/// A failure at start-up (files, configuration, arguments): says what, where and how to mend it.
/// The command prints it on one line and exits 1. Never thrown inside a cycle.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// `where` is a file, "file:line" or a setting; `mend` an instruction to the operator.
  Error(const std::string& where, const std::string& what, const std::string& mend)
      : std::runtime_error(where + ": " + what + (mend.empty() ? "" : " - " + mend)) {}
};

/// A value, or the reason in words why there is none. For everything inside the cycle, where nothing throws.
template <class T>
class [[nodiscard]] Result {
 public:
  struct Failure {
    std::string reason;
  };

  Result(T value) : state_(std::move(value)) {}            // NOLINT: implicit by design, as std::expected
  Result(Failure failure) : state_(std::move(failure)) {}  // NOLINT
  [[nodiscard]] static Result failure(std::string reason) { return Result(Failure{std::move(reason)}); }

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  /// Precondition: ok().
  [[nodiscard]] const T& value() const& { return std::get<T>(state_); }
  [[nodiscard]] T&& value() && { return std::get<T>(std::move(state_)); }
  /// Precondition: !ok().
  [[nodiscard]] const std::string& reason() const { return std::get<Failure>(state_).reason; }

 private:
  std::variant<T, Failure> state_;
};

}  // namespace madori
