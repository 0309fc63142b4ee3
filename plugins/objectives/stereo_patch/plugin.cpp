#include "hypotrack/plugin/plugin.hpp"

#include "settings.hpp"
#include "stereo_patch.hpp"

HYPOTRACK_PLUGIN(hypotrack::stereo_patch::StereoPatch,
                 "patch consistency of the two views of a stereo pair (ZNCC or census)",
                 hypotrack::stereo_patch::capabilities())
