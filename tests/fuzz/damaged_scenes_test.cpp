#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "damage.hpp"
#include "dictionary.hpp"
#include "read_scene.hpp"
#include "target.hpp"

namespace hypotrack::test {
namespace {

const std::vector<std::string>& valid_scenes() {
  static const std::vector<std::string> scenes = {
      R"(# a scene in block style
source:
  type: image_sequence
  left: "images/left_%04d.png"
  frames: [0, 100]
models:
  - type: hand
    name: right
  - {type: rigid_box, name: box, size_mm: [60, 80, 120.5]}
optimizer:
  type: pso
  file: a.png
  particles: 64
  radius_mm: 2.5
  range_deg: 1e1
  mode: bilinear
  center: [1, -2, .5]
  weights: [0.25, 1]
  parts:
    - size: 3
      label: 'it''s'
    - size: .inf
)",
      R"({optimizer: {file: "a\tb\u00e9", name: größe, enabled: false, words: [a, b c, 'true'],
 inner: {depth: 3}, nested: {type: x, list: [[1, 2], {a: ~}, null]}, maybe: 4}, empty: , seed: 7})",
      R"(optimizer:
  name: |
    literal
      text
  file: >-
    folded
    text
  words:
  - one
  -   two # comment
  inner:
    depth:   12
notes: "a long
  line"
)",
      R"(optimizer: "@other.yaml"
models: ["@other.yaml#optimizer.words", {type: "@other.yaml#optimizer.words.1"}]
empty: '@other.yaml'
)",
      R"(tracker: "@trackers/quick"
optimizer: {particles: 8}
seed: 7
)",
      R"({tracker: {from: '@trackers/quick.yaml', patience: 3}, seed: 1, "empty": ''}
)"};
  return scenes;
}

/// Returns damaged copies of the valid scenes.
fuzz::Damage damage_of_scenes(std::uint64_t seed) {
  return fuzz::Damage(seed, valid_scenes(), fuzz::read_dictionary("yaml"));
}

class DamagedScenes : public ::testing::Test {
 protected:
  DamagedScenes() : folder_(fuzz::scratch_file("damaged/scene.yaml", "").parent_path()) {
    write_other_scene(folder_);
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

TEST_F(DamagedScenes, ValidOnesAreRead) {
  for (const std::string& text : valid_scenes()) EXPECT_TRUE(read_scene(text, folder())) << text;
}

TEST_F(DamagedScenes, AreReadOrRefusedWithTheirPosition) {
  fuzz::Damage damage = damage_of_scenes(2017);
  int read = 0;
  constexpr int kCases = 6000;
  for (int i = 0; i < kCases; ++i) {
    const std::string text = damage.damaged();
    try {
      read += read_scene(text, folder());
    } catch (const std::exception& error) {
      FAIL() << "case " << i << ": " << error.what() << "\n" << text;
    }
  }
  // Both ends of the reader are exercised.
  EXPECT_GT(read, kCases / 100);
  EXPECT_LT(read, kCases / 2);
}

TEST_F(DamagedScenes, AreRefusedWhereverTheyEnd) {
  for (const std::string& text : valid_scenes()) {
    for (std::size_t length = 0; length < text.size(); ++length) {
      EXPECT_NO_THROW(read_scene(text.substr(0, length), folder())) << text.substr(0, length);
    }
  }
}

TEST_F(DamagedScenes, DamagedOverridesAreAppliedOrRefused) {
  const auto file = folder() / "scene.yaml";
  std::ofstream(file) << valid_scenes().front();
  const std::vector<std::string> valid = {"models.0.type=box", "optimizer.center=[1, 2, 3]",
                                          "models.2={type: a}", "source.left='x.png'",
                                          "optimizer=@" + (folder() / "other.yaml").string()};
  fuzz::Damage damage = damage_of_scenes(7);
  int applied = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::string> overrides = {damage.pick(valid)};
    for (auto n = damage.below(3); n > 0; --n) damage.change(overrides[0]);
    try {
      applied += ConfigNode::load_scene(file, overrides).is_map();
    } catch (const ConfigError& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with("--set ")) << error.what();
    }
  }
  EXPECT_GT(applied, 250);
  EXPECT_LT(applied, 1000);
}

}  // namespace
}  // namespace hypotrack::test
