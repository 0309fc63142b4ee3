#include "hypotrack/plugin/plugin.hpp"

#include "settings.hpp"
#include "stereo_color.hpp"

HYPOTRACK_PLUGIN(hypotrack::stereo_color::StereoColor,
                 "colour consistency of the two views of a stereo pair (Back to RGB, 2017)",
                 hypotrack::stereo_color::capabilities())
