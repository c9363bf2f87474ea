#include "localization/health/health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "localization/health/reasons.hpp"

namespace madori::localization {
namespace {

using ::testing::HasSubstr;

HealthEvidence sound() {
  HealthEvidence e;
  e.walls_seen = 100.0;
  e.fit_nats = 150.0;
  e.inliers = 0.6;
  e.sigma_m = 0.05;
  e.position_sigma_m = 0.03;
  return e;
}

TEST(Health, ASoundPoseIsLocalizedWithoutAReason) {
  EXPECT_EQ(judge(sound()).state, LocalizationState::Localized);
  EXPECT_EQ(judge(sound()).reason, "");
}

TEST(Health, AFreshStartIsNotBelievedYet) {
  HealthEvidence e = sound();
  e.walls_seen = 10.0;
  e.fit_nats = 15.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("start pose"));
}

TEST(Health, AMirroredDrawingIsNamed) {
  HealthEvidence e = sound();
  e.mirrored_nats = 30.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
  EXPECT_THAT(judge(e).reason, HasSubstr("mirror"));
}

TEST(Health, WhatDoesNotFitIsLost) {
  HealthEvidence e = sound();
  e.fit_nats = 20.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Health, ARivalPlaceIsAmbiguousABetterOneIsLost) {
  HealthEvidence e = sound();
  e.elsewhere_nats = -2.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Ambiguous);
  e.elsewhere_nats = 20.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Health, ScansBesideTheDrawingAreDegraded) {
  HealthEvidence e = sound();
  e.off_walls_scans = 2;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
  e.off_walls_scans = 3;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("fit the drawing much less than usual"));
}

TEST(Health, OneBadScanIsNoLossManyAre) {
  HealthEvidence e = sound();
  e.blind_scans = 1;
  e.blind_s = 5.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
  e.blind_scans = 6;
  e.blind_s = 1.5;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Health, MappingWithoutADrawingNeedsNoFit) {
  HealthEvidence e;
  e.has_drawing = false;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
}

TEST(Health, ABadFitIsNoLossWhereNoOtherPlaceComesNear) {
  HealthEvidence e = sound();
  e.walls_seen = 100.0;
  e.fit_nats = 30.0;
  e.elsewhere_nats = HealthEvidence::kNotLooked;  // nobody looked: it may be a wrong place
  e.mirrored_nats = -40.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
  e.elsewhere_nats = -40.0;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  e.mirrored_nats = -5.0;  // the mirror image comes near
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Health, SearchingIsLost) {
  HealthEvidence e = sound();
  e.searching = true;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Reasons, EveryOneHasACodeOfItsOwnAndIsFoundByItsWords) {
  std::set<std::string> codes;
  for (const Reason& known : kReasons) {
    EXPECT_TRUE(codes.insert(known.code).second) << known.code;
    EXPECT_EQ(reason_codes(known.english), known.code);
  }
  EXPECT_EQ(reason_codes(std::string(reason::kGivenRefuted.english) + reason::kTwoAlike.english),
            "given-refuted+two-alike");
  EXPECT_EQ(reason_codes(std::string(reason::kGivenRefuted.english) + "something else"), "");
  EXPECT_EQ(reason_codes("something else"), "");
}

}  // namespace
}  // namespace madori::localization
