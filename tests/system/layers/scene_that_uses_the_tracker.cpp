#include "model/posing.hpp"              // of one below
#include "scene/posed_scene.hpp"         // of its own layer
#include "track/loop/scene_tracker.hpp"  // of one above: an error
