# Headers that most sources include, compiled once per set of flags. To check that every source
# includes what it uses: -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=OFF.
set(HYPOTRACK_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <optional>
  <span> <stdexcept> <string> <string_view> <unordered_map> <utility> <vector>
  <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <opencv2/core.hpp>)

# hypotrack_add_precompiled(NAME [HEADERS ...] [LIBRARIES ...] [PROGRAM])
#
# Makes a target that holds the common headers and others, for
# target_precompile_headers(... REUSE_FROM NAME) of targets with the same flags. PROGRAM: these are
# programs, whose code is not that of shared libraries.
function(hypotrack_add_precompiled name)
  cmake_parse_arguments(ARG "PROGRAM" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  if(ARG_PROGRAM)
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}  // holds the precompiled header\n")
    add_executable(${name} EXCLUDE_FROM_ALL ${source})
  else()
    file(CONFIGURE OUTPUT ${source} CONTENT "// Holds the precompiled header.\n")
    add_library(${name} OBJECT ${source})
  endif()
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt opencv_core hypotrack_options ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${HYPOTRACK_COMMON_HEADERS} ${ARG_HEADERS})
endfunction()

hypotrack_add_precompiled(hypotrack_precompiled)  # for the layers, the lab and plugins
set_target_properties(hypotrack_precompiled PROPERTIES CXX_VISIBILITY_PRESET hidden)

# hypotrack_hide_names(TARGET [NO_PRECOMPILED]): a library exports only what its sources mark as
# visible: HYPOTRACK_API, the namespaces `internal`, the entry of a plugin. Precompiled headers hold
# the same flag.
function(hypotrack_hide_names target)
  cmake_parse_arguments(ARG "NO_PRECOMPILED" "" "" ${ARGN})
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden CUDA_VISIBILITY_PRESET hidden)
  if(NOT ARG_NO_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM hypotrack_precompiled)
  endif()
endfunction()
