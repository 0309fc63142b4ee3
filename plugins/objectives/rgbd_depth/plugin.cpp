#include "hypotrack/plugin/plugin.hpp"

#include "rgbd_depth.hpp"
#include "settings.hpp"

HYPOTRACK_PLUGIN(hypotrack::rgbd_depth::RgbdDepth,
                 "agreement with a depth image and its foreground (Oikonomidis et al., 2011)",
                 hypotrack::rgbd_depth::capabilities())
