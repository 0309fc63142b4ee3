#include "hand_asset.hpp"

#include "hand_shape.hpp"

namespace hypotrack::hand_mesh {

HandAsset make_hand(int texture_size) {
  const HandSurface surface;
  HandAsset hand;
  hand.skeleton = surface.skeleton();
  hand.mesh = hand_shape(surface);
  hand.weights = skin_weights(hand.mesh, hand.skeleton);
  hand.texture_map = unwrap(hand.mesh, hand.weights, hand.skeleton);
  hand.attributes = skin_attributes(hand.mesh, surface, hand.weights);
  hand.texture = skin_texture(hand.mesh, hand.attributes, hand.texture_map, surface, texture_size);
  return hand;
}

}  // namespace hypotrack::hand_mesh
