#include "scene/posed_scene.hpp"  // of its own layer
#include "model/posing.hpp"       // of one below
#include "track/tracker.hpp"      // of one above: an error
