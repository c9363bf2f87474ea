#include "app/runner/service_unit.hpp"

#include <fmt/format.h>

#include <string_view>

#include "core/result.hpp"

namespace madori::app {

namespace {

/// `doubled`: what would be replaced if it stood alone: % a specifier everywhere, $ a variable in a command.
std::string escaped(const std::string& word, std::string_view doubled) {
  std::string text;
  for (const char c : word) {
    if (static_cast<unsigned char>(c) < 0x20)
      throw Error("'" + word + "'", "holds a line break or another control character", "name it otherwise");
    if (c == '"' || c == '\\') text += '\\';
    if (doubled.find(c) != std::string_view::npos) text += c;
    text += c;
  }
  return text;
}

}  // namespace

std::string quoted_for_systemd(const std::string& word) {
  return '"' + escaped(word, "%$") + '"';
}

std::string service_unit(const ServiceOptions& options) {
  std::string command = quoted_for_systemd(options.program) + " run " + quoted_for_systemd(options.site);
  for (const std::string& word : options.run_options) command += " " + quoted_for_systemd(word);
  return fmt::format(R"([Unit]
Description=Madori drives the vehicle of {name}
After=network.target
StartLimitIntervalSec=0

[Service]
Type=notify
ExecStart={command}
User={user}
SupplementaryGroups=dialout video
Restart=always
RestartSec=2
WatchdogSec=5
TimeoutStopSec=30
LimitRTPRIO=20
LimitMEMLOCK=infinity
UMask=0027
ReadWritePaths={site}
ProtectSystem=strict
ProtectHome=read-only
PrivateTmp=yes
NoNewPrivileges=yes
CapabilityBoundingSet=
DevicePolicy=closed
DeviceAllow=char-ttyUSB rw
DeviceAllow=char-ttyACM rw
DeviceAllow=char-ttyS rw
DeviceAllow=char-pts rw
DeviceAllow=char-video4linux rw
ProtectClock=yes
ProtectHostname=yes
ProtectKernelTunables=yes
ProtectKernelModules=yes
ProtectKernelLogs=yes
ProtectControlGroups=yes
ProtectProc=invisible
RestrictNamespaces=yes
RestrictSUIDSGID=yes
RestrictAddressFamilies=AF_INET AF_INET6 AF_UNIX
LockPersonality=yes
SystemCallArchitectures=native
SystemCallFilter=@system-service

[Install]
WantedBy=multi-user.target
)",
                     fmt::arg("name", escaped(options.site.filename(), "%")), fmt::arg("command", command),
                     fmt::arg("user", options.user),
                     fmt::arg("site", '"' + escaped(options.site, "%") + '"'));
}

}  // namespace madori::app
