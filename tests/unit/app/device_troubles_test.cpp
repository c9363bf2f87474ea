#include <gtest/gtest.h>

#include "app/orders/order_store.hpp"
#include "app/runner/transport_run.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

// What a device says of itself is on the panel while it lasts, and an event for whoever looks later.
namespace madori::app {
namespace {

class TroubledLink final : public VehicleLink {
 public:
  explicit TroubledLink(const std::string& trouble) : trouble_(trouble) {}
  void collect(CycleInput& /*input*/) override {}
  void send(const CycleOutput& /*output*/) override {}
  [[nodiscard]] std::string problem() const override { return trouble_; }

 private:
  const std::string& trouble_;
};

class DeviceTroubles : public testing::Test {
 protected:
  void tick_for(double seconds) {
    for (const double end_s = now_s_ + seconds; now_s_ < end_s;)
      run_.tick(stamp_from_seconds(now_s_ += test::ToyVehicle::kStep_s));
  }
  [[nodiscard]] int told(const std::string& text) const {
    int count = 0;
    for (const EventRecord& event : OrderStore(folder_.path() / "madori.db").events(1000))
      count += event.kind == "device" && event.text == text ? 1 : 0;
    return count;
  }

  std::string trouble_;

 private:
  test::TemporaryFolder folder_;
  std::unique_ptr<test::ToyVehicle> toy_ = test::corridor_vehicle();
  double now_s_ = 1000.0;
  TransportRun run_{toy_->config,
                    std::make_unique<test::TruePose>(toy_->rolling),
                    std::make_unique<TroubledLink>(trouble_),
                    {.site = folder_.path(), .lock_step = true, .store_poll_s = 0.1}};
};

TEST_F(DeviceTroubles, AreToldOnceHoweverLongTheyLast) {
  const std::string error = "lidar: the scanner reports a device error";
  trouble_ = error;
  tick_for(300.0);
  EXPECT_EQ(told(error), 1);
  for (int k = 0; k < 20; ++k) {  // it flickers
    trouble_ = k % 2 == 0 ? "" : error;
    tick_for(5.0);
  }
  EXPECT_EQ(told(error), 1);
  trouble_ = "";
  tick_for(61.0);
  trouble_ = error;
  tick_for(1.0);
  EXPECT_EQ(told(error), 2) << "it was gone";
}

TEST_F(DeviceTroubles, ThatAreOthersEachTimeAreNotMoreThanEightAMinute) {
  for (int k = 0; k < 100; ++k) {
    trouble_ = "drive: " + std::to_string(k) + " frames were damaged";
    tick_for(0.1);
  }
  int all = 0;
  for (int k = 0; k < 100; ++k) all += told("drive: " + std::to_string(k) + " frames were damaged");
  EXPECT_EQ(all, 8);
}

}  // namespace
}  // namespace madori::app
