#include "simulation/scenario/reading.hpp"

namespace madori::simulation {

using mapping::StrictYaml;

DoorSpec read_door(StrictYaml& yaml) {
  DoorSpec d;
  d.kind = read_word<DoorKind>(yaml, "kind", {{"sliding", DoorKind::Sliding}, {"lift", DoorKind::Lift}});
  d.name = yaml.text_or("name", yaml.text("kind") + " door");
  d.line = read_line(yaml, "line");
  d.height_m = yaml.number_or("height_m", d.height_m, 0.5, 100.0);
  d.opening_s = yaml.number_or("opening_s", d.opening_s, 0.1, 600.0);
  d.trigger_m = yaml.number_or("trigger_m", d.trigger_m, 0.0, 100.0);
  d.hold_s = yaml.number_or("hold_s", d.hold_s, 0.0, 3600.0);
  d.period_s = yaml.number_or("period_s", d.period_s, 1.0, 86'400.0);
  d.stuck_at = yaml.number_or("stuck_at", d.stuck_at, 0.0, 1.0);
  d.stuck_until_s = yaml.number_or("stuck_until_s", d.stuck_until_s, 0.0, 1e7);
  yaml.refuse_unknown_keys();
  return d;
}

MoverSpec read_mover(StrictYaml& yaml) {
  MoverSpec m;
  m.kind = read_word<MoverKind>(yaml, "kind",
                                {{"person", MoverKind::Person},
                                 {"forklift", MoverKind::Forklift},
                                 {"cart", MoverKind::Cart},
                                 {"pallet", MoverKind::Pallet},
                                 {"upright_body", MoverKind::UprightBody},
                                 {"lying_body", MoverKind::LyingBody}});
  m.name = yaml.text_or("name", yaml.text("kind"));
  m.path = read_points(yaml, "path", 1);
  m.speed_mps = yaml.number_or("speed_mps", m.speed_mps, 0.01, 10.0);
  m.loop = yaml.boolean_or("loop", m.loop);
  m.pause_s = yaml.number_or("pause_s", m.pause_s, 0.0, 86'400.0);
  m.start_s = yaml.number_or("start_s", m.start_s, 0.0, 1e7);
  m.polite_m = yaml.number_or("polite_m", m.polite_m, 0.0, 20.0);
  m.patience_s = yaml.number_or("patience_s", m.patience_s, 0.0, 86'400.0);
  m.yaw_deg = yaml.number_or("yaw_deg", m.yaw_deg, -360.0, 360.0);
  yaml.refuse_unknown_keys();
  return m;
}

VehicleSpec read_vehicle_spec(StrictYaml yaml) {
  VehicleSpec v;
  v.left_radius_error_percent = yaml.number_or("left_radius_error_percent", 0.0, -20.0, 20.0);
  v.right_radius_error_percent = yaml.number_or("right_radius_error_percent", 0.0, -20.0, 20.0);
  v.separation_error_percent = yaml.number_or("separation_error_percent", 0.0, -20.0, 20.0);
  v.as_recorded = yaml.boolean_or("as_recorded", false);
  v.dead_time_s = yaml.number_or("dead_time_s", v.dead_time_s, 0.0, 5.0);
  v.motor_lag_s = yaml.number_or("motor_lag_s", v.motor_lag_s, 0.0, 5.0);
  v.acceleration_mps2 = yaml.number_or("acceleration_mps2", v.acceleration_mps2, 0.05, 50.0);
  v.braking_mps2 = yaml.number_or("braking_mps2", v.braking_mps2, 0.05, 50.0);
  v.slip_percent = yaml.number_or("slip_percent", v.slip_percent, 0.0, 99.0);
  v.slip_noise = yaml.number_or("slip_noise", v.slip_noise, 0.0, 0.2);
  v.empty_mass_kg = yaml.number_or("empty_mass_kg", v.empty_mass_kg, 1.0, 1e5);
  v.load_kg = yaml.number_or("load_kg", v.load_kg, 0.0, 1e5);
  v.squat_percent_per_100kg = yaml.number_or("squat_percent_per_100kg", v.squat_percent_per_100kg, 0.0, 5.0);
  v.ground_clearance_m = yaml.number_or("ground_clearance_m", v.ground_clearance_m, 0.0, 1.0);
  v.battery_mv = yaml.integer_or("battery_mv", v.battery_mv, 0, 65'535);
  yaml.refuse_unknown_keys();
  return v;
}

namespace {

void read_errors(StrictYaml& yaml, LidarErrors& e) {
  e.noise_m = yaml.number_or("noise_m", e.noise_m, 0.0, 1.0);
  e.dropout = yaml.number_or("dropout", e.dropout, 0.0, 1.0);
  e.bias_m = yaml.number_or("bias_m", e.bias_m, 0.0, 1.0);
  e.rain = yaml.number_or("rain", e.rain, 0.0, 1.0);
  e.beam_m = yaml.number_or("beam_m", e.beam_m, 0.0, 0.1);
  e.beam_spread_rad = 1e-3 * yaml.number_or("beam_spread_mrad", 1e3 * e.beam_spread_rad, 0.0, 100.0);
  e.pitch_deg = yaml.number_or("pitch_deg", e.pitch_deg, -30.0, 30.0);
  e.roll_deg = yaml.number_or("roll_deg", e.roll_deg, -30.0, 30.0);
}

}  // namespace

Vlp16Spec read_vlp16(StrictYaml yaml) {
  Vlp16Spec v;
  read_errors(yaml, v);
  v.range_max_m = yaml.number_or("range_max_m", v.range_max_m, 1.0, 131.0);
  v.rate_hz = yaml.number_or("rate_hz", v.rate_hz, 5.0, 20.0);
  v.dual_return = yaml.boolean_or("dual_return", v.dual_return);
  v.keep_every_firing = yaml.integer_or("keep_every_firing", v.keep_every_firing, 1, 24);
  yaml.refuse_unknown_keys();
  return v;
}

Lms1xxSpec read_lms1xx(StrictYaml yaml) {
  Lms1xxSpec l;
  read_errors(yaml, l);
  l.range_max_m = yaml.number_or("range_max_m", l.range_max_m, 1.0, 65.0);
  l.binary = yaml.boolean_or("binary", l.binary);
  yaml.refuse_unknown_keys();
  return l;
}

S300Spec read_s300(StrictYaml yaml) {
  S300Spec s;
  read_errors(yaml, s);
  s.range_max_m = yaml.number_or("range_max_m", s.range_max_m, 1.0, 29.9);
  s.protective_m = yaml.number_or("protective_m", s.protective_m, 0.0, 5.0);
  s.warning_m = yaml.number_or("warning_m", s.warning_m, 0.0, 10.0);
  s.side_m = yaml.number_or("side_m", s.side_m, 0.0, 2.0);
  yaml.refuse_unknown_keys();
  return s;
}

namespace {

void check_fault(const StrictYaml& yaml, const FaultSpec& fault) {
  const bool of_drive = fault.kind == FaultKind::StuckEncoder || fault.kind == FaultKind::Slip ||
                        fault.kind == FaultKind::EmergencyStop || fault.kind == FaultKind::DriveFault;
  if (of_drive && fault.device != Device::Drive)
    throw yaml.error("device", "this fault is one of the drive", "write device: drive");
  if (fault.kind == FaultKind::Checksum && fault.device == Device::Vlp16)
    throw yaml.error("kind", "packets of a VLP-16 carry no checksum", "use corrupt");
  if (fault.kind == FaultKind::Standby && fault.device != Device::S300)
    throw yaml.error("device", "only the S300 has a standby", "write device: s300");
}

}  // namespace

FaultSpec read_fault(StrictYaml& yaml) {
  using enum FaultKind;
  FaultSpec f;
  f.kind = read_word<FaultKind>(yaml, "kind",
                                {{"silence", Silence},
                                 {"drop", Drop},
                                 {"corrupt", Corrupt},
                                 {"checksum", Checksum},
                                 {"delay", Delay},
                                 {"duplicate", Duplicate},
                                 {"standby", Standby},
                                 {"stuck_encoder", StuckEncoder},
                                 {"slip", Slip},
                                 {"emergency_stop", EmergencyStop},
                                 {"drive_fault", DriveFault},
                                 {"kidnap", Kidnap}});
  if (f.kind == Kidnap) {
    f.pose = read_pose<Plan, Base>(yaml.section("to"));
  } else {
    f.device = read_word<Device>(yaml, "device",
                                 {{"vlp16", Device::Vlp16},
                                  {"lms1xx", Device::Lms1xx},
                                  {"s300", Device::S300},
                                  {"drive", Device::Drive}});
    f.for_s = yaml.number_or("for_s", f.for_s, 0.0, 1e7);
  }
  f.at_s = yaml.number("at_s", 0.0, 1e7);
  f.share = yaml.number_or("share", f.share, 0.0, 1.0);
  f.delay_s = yaml.number_or("delay_s", f.delay_s, 0.0, 60.0);
  if (yaml.has("wheel"))
    f.wheel = read_word<Wheel>(yaml, "wheel",
                               {{"left", Wheel::Left}, {"right", Wheel::Right}, {"both", Wheel::Both}});
  yaml.refuse_unknown_keys();
  check_fault(yaml, f);
  return f;
}

}  // namespace madori::simulation
