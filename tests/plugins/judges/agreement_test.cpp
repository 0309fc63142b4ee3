#include <gtest/gtest.h>

#include <string>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "judges.hpp"

namespace hypotrack {
namespace {

Measures agreeing(double share) {
  Measures out{.known = true};
  out.values[Measures::kAgreement] = share;
  return out;
}

TEST(AgreementJudge, IsUndecidedAtItsThresholdAndSurerBeyond) {
  const auto judge = test::make_judge("agreement", "even_at: 0.4, step: 0.1");
  EXPECT_NEAR(judge->log_odds(agreeing(0.4)), 0, 1e-12);
  EXPECT_NEAR(judge->log_odds(agreeing(0.6)), 2, 1e-12);
  EXPECT_NEAR(judge->log_odds(agreeing(0.1)), -3, 1e-12);
}

TEST(AgreementJudge, ComparesWithTheUsualAgreementOnceItIsKnown) {
  const auto judge = test::make_judge("agreement", "even_at: 0.4, usual_share: 0.5, step: 0.1");
  Measures measures = agreeing(0.3);
  measures.experienced = true;
  measures.usual[Measures::kAgreement] = 0.6;
  EXPECT_NEAR(judge->log_odds(measures), 0, 1e-12);
  measures.usual[Measures::kAgreement] = 0.8;
  EXPECT_NEAR(judge->log_odds(measures), -1, 1e-12);
}

TEST(AgreementJudge, TakesItsThresholdsFromTheScene) {
  EXPECT_EQ(test::make_judge("agreement", "uncertain_above: 0.2")->thresholds().uncertain_above,
            0.2);
}

TEST(AgreementJudge, HasNothingToFit) {
  EXPECT_THAT(test::message_of<PluginError>([] { test::make_judge("agreement")->fit({}); }),
              testing::HasSubstr("nothing to fit"));
}

}  // namespace
}  // namespace hypotrack
