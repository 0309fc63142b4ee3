#include "hypotrack/plugin/plugin.hpp"

#include "settings.hpp"
#include "skin.hpp"

HYPOTRACK_PLUGIN(hypotrack::skin::Skin,
                 "coverage of what looks like foreground, by colour, mask or depth",
                 hypotrack::skin::capabilities())
