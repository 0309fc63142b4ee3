#pragma once

#include <memory>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "palm.hpp"
#include "rig.hpp"
#include "stick_hand.hpp"
#include "target.hpp"
#include "test_models.hpp"

namespace hypotrack::fuzz {

/// A hand of a rig, with the directions of the plugin `hand`.
class StickHand final : public Model {
 public:
  using Model::Model;

 private:
  std::vector<NamedDirection> do_directions() const override { return palm_directions(*this); }
};

/// Returns a scene of `hand`, which is made of sticks, and `box`.
inline const Scene& hand_and_box() {
  static const Scene scene = [] {
    const Rig rig = read_rig(fuzz_folder() / "corpus" / "rig" / "axes.yaml");
    return Scene(
        {{"hand", std::make_shared<StickHand>(rig_hand(test::stick_hand(), rig, "axes.yaml"))},
         {"box", std::make_shared<Model>(test::make_test_box())}});
  }();
  return scene;
}

}  // namespace hypotrack::fuzz
