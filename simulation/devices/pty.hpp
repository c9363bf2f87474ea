#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace madori::simulation {

/// The device's end of a pseudo-terminal: a serial port to whoever opens link(). Raw, non-blocking. What
/// nobody reads is lost, as on a wire.
class Pty {
 public:
  /// `link` becomes a symbolic link to the port (an older link is replaced) and is removed at the end.
  /// Throws Error.
  explicit Pty(std::filesystem::path link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  void write(std::span<const std::uint8_t> bytes);
  /// Appends what has arrived; returns how much.
  std::size_t read(std::vector<std::uint8_t>& into);
  [[nodiscard]] const std::filesystem::path& link() const { return link_; }

 private:
  std::filesystem::path link_;
  int master_ = -1;
  int slave_ = -1;  ///< held open, so that the settings stay and closing the other side is no error
};

}  // namespace madori::simulation
