#pragma once

namespace CLI {
class App;
}

/// Every sub-command of `madori` adds itself; its callback throws Error on failure (exit 1).
namespace madori::app {

struct SocketOptions;
/// The options that name the vehicle's devices, the same for every command.
void add_device_options(CLI::App& command, SocketOptions& devices);

void add_braking_test(CLI::App& app);
void add_demo(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_landmarks(CLI::App& app);
void add_localize(CLI::App& app);
void add_export(CLI::App& app);
void add_import(CLI::App& app);
void add_relocalize(CLI::App& app);
void add_route(CLI::App& app);
void add_map(CLI::App& app);
void add_order(CLI::App& app);
void add_pin(CLI::App& app);
void add_replay(CLI::App& app);
void add_run(CLI::App& app);
void add_scale(CLI::App& app);
void add_tiles(CLI::App& app);
void add_service(CLI::App& app);
void add_sim(CLI::App& app);
void add_diff(CLI::App& app);
void add_doctor(CLI::App& app);
void add_record(CLI::App& app);
void add_version(CLI::App& app);
void add_versions(CLI::App& app);

}  // namespace madori::app
