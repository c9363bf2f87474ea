#include "localization/health/health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "localization/health/reasons.hpp"
#include "localization/health/wall_fit.hpp"

namespace madori::localization {
namespace {

using ::testing::HasSubstr;

HealthEvidence sound() {
  HealthEvidence e;
  e.looked = true;
  e.here = 0.99;
  e.walls_seen = 100.0;
  e.position_sigma_m = 0.03;
  return e;
}

TEST(Health, ASoundPoseIsLocalizedWithoutAReason) {
  EXPECT_EQ(judge(sound()).state, LocalizationState::Localized);
  EXPECT_EQ(judge(sound()).reason, "");
}

TEST(Health, APlaceThatTheDrawingHardlyExplainsIsNotBelievedAltogether) {
  HealthEvidence e = sound();
  e.inliers = 0.29;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
  e.inliers = 0.2;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("explains only 20 %"));
  e.has_drawing = false;  // mapping
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
}

TEST(Health, StatesAreThresholdsOnTheShareOfTheBelief) {
  HealthEvidence e = sound();
  e.here = 0.951;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
  e.here = 0.949;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("certain to 95 %"));
  e.here = 0.59;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
  EXPECT_EQ(judge(e).reason, reason::kNoneSure.english);
  e.inliers = 0.2;
  EXPECT_EQ(judge(e).reason, reason::kNoPlace.english);
}

TEST(Health, AMirroredDrawingIsNamed) {
  HealthEvidence e = sound();
  e.here = 0.2;
  e.mirrored = 0.8;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
  EXPECT_THAT(judge(e).reason, HasSubstr("mirror"));
}

/// The mirror image is one of the places that share what is not believed here.
TEST(Health, AMirroredDrawingIsNamedWhereItIsMostOfTheDoubt) {
  HealthEvidence e = sound();
  e.here = 0.96;
  e.mirrored = 0.04;
  EXPECT_EQ(judge(e).state, LocalizationState::Localized);
  e.here = 0.9;
  e.mirrored = 0.08;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("mirror"));
  e.mirrored = 0.02;
  EXPECT_THAT(judge(e).reason, HasSubstr("certain to 90 %"));
}

TEST(Health, ARivalPlaceIsAmbiguousABetterOneIsLost) {
  HealthEvidence e = sound();
  e.here = 0.5;
  e.rival = 0.45;
  EXPECT_EQ(judge(e).state, LocalizationState::Ambiguous);
  e.here = 0.2;
  e.rival = 0.75;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
  EXPECT_EQ(judge(e).reason, reason::kMovedByHand.english);
}

TEST(Health, WherePlacesSideBySideAreAlikeItIsKnownToAMetre) {
  auto e = sound();
  e.here = 0.5;
  e.rival = 0.49;
  e.around = 0.99;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_EQ(judge(e).place, e.around) << "within a metre of there it is, for sure";
  e.around = 0.94;
  EXPECT_EQ(judge(e).state, LocalizationState::Ambiguous);
}

TEST(Health, WhereNoPlaceStandsOutItIsLost) {
  HealthEvidence e = sound();
  e.here = 0.1;
  e.rival = 0.1;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

TEST(Health, AStretchBesideTheDrawingIsDegraded) {
  HealthEvidence e = sound();
  e.off_walls = true;
  EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
  EXPECT_THAT(judge(e).reason, HasSubstr("fit the drawing much less than usual"));
}

/// `metres` of driving with a scan every `step_m`, each with the same share on drawn walls.
void drive(WallFit& fit, double metres, double step_m, double on_walls) {
  const long scans = std::lround(metres / step_m);
  for (long i = 0; i < scans; ++i) fit.add(on_walls, step_m, 0.0);
}

TEST(WallFit, TheSameAtAnyScanRate) {
  for (const double step_m : {0.05, 0.5, 1.0, 2.0}) {
    WallFit fit;
    drive(fit, 60.0, step_m, 0.7);
    EXPECT_NEAR(fit.recent(), 0.7, 1e-3) << step_m;
    EXPECT_FALSE(fit.is_poor());
    drive(fit, 2.0, step_m, 0.1);
    EXPECT_FALSE(fit.is_poor()) << step_m;
    drive(fit, 4.0, step_m, 0.1);
    EXPECT_TRUE(fit.is_poor()) << step_m;
    EXPECT_NEAR(fit.recent(), 0.1 + 0.6 * std::exp(-6.0 / 5.0), 1e-3) << step_m;
  }
}

TEST(WallFit, WhoStandsLearnsNothingNew) {
  WallFit fit;
  drive(fit, 30.0, 0.5, 0.7);
  for (int i = 0; i < 10000; ++i) fit.add(0.0, 0.0, 0.0);
  EXPECT_FALSE(fit.is_poor());
}

TEST(WallFit, APoorStretchBecomesUsualInTheEnd) {
  WallFit fit;
  drive(fit, 30.0, 0.5, 0.7);
  drive(fit, 10.0, 0.5, 0.1);
  EXPECT_TRUE(fit.is_poor());
  drive(fit, 500.0, 0.5, 0.1);
  EXPECT_FALSE(fit.is_poor());
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

TEST(Health, WhoHasNotLookedIsLost) {
  HealthEvidence e = sound();
  e.looked = false;
  EXPECT_EQ(judge(e).state, LocalizationState::Lost);
}

/// Whatever is known, less sure evidence never lets the vehicle drive, or drive faster, where it might not.
TEST(Health, WorseEvidenceIsNeverABetterState) {
  const auto danger = [](const HealthEvidence& e) {
    const auto state = judge(e).state;
    return state == LocalizationState::Localized ? 0 : state == LocalizationState::Degraded ? 1 : 2;
  };
  std::mt19937 random(9);
  const auto any = [&](double most) { return std::uniform_real_distribution<double>(0.0, most)(random); };
  int degraded = 0;
  for (int run = 0; run < 5000; ++run) {
    HealthEvidence e = sound();
    e.here = run % 2 == 0 ? 1.0 - any(0.1) : any(1.0);
    e.around = std::max(e.here, run % 3 == 0 ? 1.0 - any(0.1) : any(1.0));
    e.rival = any(1.0 - e.here);
    e.mirrored = any(1.0 - e.here);
    e.inliers = 0.2 + any(0.3);
    e.position_sigma_m = any(0.7);
    e.blind_scans = static_cast<int>(random() % 5);
    e.blind_m = any(4.0);
    e.blind_s = any(3.0);
    e.off_walls = random() % 4 == 0;
    std::vector<HealthEvidence> worse(9, e);
    worse[0].here = any(e.here);
    worse[1].around = std::max(e.here, any(e.around));
    worse[2].inliers = any(e.inliers);
    worse[3].position_sigma_m += any(1.0);
    worse[4].blind_scans += 3;
    worse[5].blind_m += any(4.0);
    worse[6].blind_s += any(3.0);
    worse[7].off_walls = true;
    worse[8].looked = false;
    for (std::size_t i = 0; i < worse.size(); ++i) EXPECT_GE(danger(worse[i]), danger(e)) << i;
    degraded += danger(e) == 1 ? 1 : 0;
  }
  EXPECT_GT(degraded, 500);
}

/// Each alone.
TEST(Health, WhatMakesASurePlaceDegraded) {
  const std::vector<std::function<void(HealthEvidence&)>> doubts{
      [](HealthEvidence& e) { e.blind_scans = 2, e.blind_s = 1.0; },
      [](HealthEvidence& e) { e.position_sigma_m = 0.6; },
      [](HealthEvidence& e) { e.here = 0.5, e.around = 0.99; },
      [](HealthEvidence& e) { e.here = 0.9; },
      [](HealthEvidence& e) { e.inliers = 0.2; },
      [](HealthEvidence& e) { e.off_walls = true; },
  };
  std::set<std::string> reasons;
  for (const auto& doubt : doubts) {
    HealthEvidence e = sound();
    doubt(e);
    EXPECT_EQ(judge(e).state, LocalizationState::Degraded);
    EXPECT_TRUE(reasons.insert(judge(e).reason).second) << judge(e).reason;
  }
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
