# Layers: the parts of the core, from the bottom up. Each may use those added before it.
#
# hypotrack_add_layer(NAME SOURCES... [PACKAGES ...])
#
# Compiles the sources of one layer, an object library hypotrack_<NAME>. Its headers are included as
# "NAME/header.hpp". The include path of a layer has the public headers, its own, and those of the
# layers below: a header of a layer above is not found.
add_library(hypotrack_internals INTERFACE)  # headers of all layers, for tests and benchmarks

function(hypotrack_add_layer name)
  cmake_parse_arguments(ARG "" "" "PACKAGES" ${ARGN})
  set(layer hypotrack_${name})
  add_library(${layer} OBJECT ${ARG_UNPARSED_ARGUMENTS})
  hypotrack_compile_alone(${ARG_UNPARSED_ARGUMENTS})
  # A folder that holds nothing but the layer's own one.
  set(root ${PROJECT_BINARY_DIR}/layers/${name})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${name} SYMBOLIC)
  target_include_directories(${layer} PUBLIC ${root})
  target_include_directories(hypotrack_internals INTERFACE ${root})
  get_property(below GLOBAL PROPERTY HYPOTRACK_LAYERS)
  if(below)
    list(GET below -1 nearest)
    target_link_libraries(${layer} PUBLIC ${nearest})
  else()
    target_include_directories(${layer} PUBLIC ${PROJECT_SOURCE_DIR}/core/include)
    target_compile_features(${layer} PUBLIC cxx_std_20)
  endif()
  target_link_libraries(${layer} PUBLIC ${ARG_PACKAGES} PRIVATE hypotrack_options)
  set(precompiled)
  if(name STREQUAL base)  # which has neither Eigen nor OpenCV
    set(precompiled NO_PRECOMPILED)
  endif()
  hypotrack_hide_names(${layer} ${precompiled})
  set_property(GLOBAL APPEND PROPERTY HYPOTRACK_LAYERS ${layer})
endfunction()
