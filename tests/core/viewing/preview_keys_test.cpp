#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "viewing/preview.hpp"

namespace hypotrack {
namespace {

TEST(PreviewKeys, SpacePausesAndGoesOn) {
  RunControls controls;
  press(controls, preview_key(' '));
  EXPECT_TRUE(controls.paused());
  press(controls, preview_key(' '));
  EXPECT_FALSE(controls.paused());
}

TEST(PreviewKeys, NAndDotLetOneFramePass) {
  for (const char key : {'n', '.'}) {
    RunControls controls;
    press(controls, preview_key(key));
    controls.wait_while_paused([] { return ADD_FAILURE(), false; });
    bool waited = false;
    controls.wait_while_paused([&] { return waited = true, false; });
    EXPECT_TRUE(waited) << key;
  }
}

TEST(PreviewKeys, LettersOfEitherCaseAskForTheSame) {
  for (const bool upper : {false, true}) {
    RunControls controls;
    for (const char key : {'r', 's', 'v', 'q'})
      press(controls, preview_key(static_cast<char>(upper ? std::toupper(key) : key)));
    EXPECT_TRUE(controls.take_restart());
    EXPECT_TRUE(controls.take_snapshot());
    EXPECT_TRUE(controls.recording_wanted());
    EXPECT_TRUE(controls.end_wanted());
  }
}

TEST(PreviewKeys, EscapeEndsTheRunAndOtherKeysDoNothing) {
  RunControls controls;
  for (const char key : {'x', 'h', '\r', '\xe1'}) press(controls, preview_key(key));
  EXPECT_FALSE(controls.end_wanted() || controls.paused() || controls.recording_wanted());
  press(controls, preview_key(27));
  EXPECT_TRUE(controls.end_wanted());
}

TEST(PreviewKeys, TheHelpNamesEveryKey) {
  for (const PreviewKeyHelp& help : preview_key_help()) {
    const char key = help.keys == std::string("space") ? ' ' : help.keys[0];
    EXPECT_NE(preview_key(key), PreviewKey::none) << help.keys;
  }
}

}  // namespace
}  // namespace hypotrack
