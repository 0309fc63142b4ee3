#pragma once

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <string>

#include "lab/study/plan.hpp"
#include "lab/study/study_file.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A test with a folder of its own and two scene files in it, which nobody opens.
class StudyTest : public testing::Test {
 protected:
  StudyTest() {
    write("box.yaml", "models: []\n");
    write("hand.yaml", "models: [hand]\n");
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }

  std::string read(const std::filesystem::path& file) const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  study::Study load(const std::string& text,
                    const std::optional<std::string>& variant = std::nullopt) const {
    write("study.yaml", text);
    return study::load_study(path("study.yaml"), variant);
  }

  study::Plan plan(const std::string& text) const { return study::make_plan(load(text)); }

 private:
  TemporaryDirectory folder_;
};

/// Two scenes, two axes, two seeds: 2 x (2 x 2) x 2 runs.
inline std::string small_study() {
  return R"(title: Small
about: Nothing much.
scenes:
  box: {file: box.yaml, label: "A box", set: {tile.size: 32}}
  hand: {file: hand.yaml, set: {objective: {type: stereo_color, window: 3}}}
set: {tile.size: 64, tile.padding: 0.1}
grid:
  optimizer.particles: [8, 16]
  method:
    pso: {optimizer: {type: pso}}
    random: {optimizer: {type: random_search}, search.angle_deg: 20}
seeds: 2
frames: 5
plots:
  - {kind: curve, x: optimizer.particles, y: mean_error_mm, color: method, facet: scene}
variants:
  quick: {seeds: [7], frames: 3, grid: {optimizer.particles: [4]}}
  one: {scenes: [hand], set: {tile.size: 16}}
)";
}

}  // namespace hypotrack::test
