# hypotrack_add_plugin(KIND NAME SOURCES... [VERSION 1.2.3] [LICENCE Apache-2.0] [LIBRARIES ...])
#
# Builds libhypotrack_<KIND>_<NAME>.so, which a scene names with `type: NAME`. KIND is model,
# objective, optimizer or source. Inside the project the library goes where hypotrack looks for it
# and is installed; outside, it goes to the build folder: put that on --plugin-path or
# HYPOTRACK_PLUGIN_PATH. With enable_testing() the contract tests of its kind run on it.
function(hypotrack_add_plugin kind name)
  cmake_parse_arguments(ARG "" "VERSION;LICENCE" "LIBRARIES" ${ARGN})
  if(NOT kind MATCHES "^(model|objective|optimizer|source)$")
    message(FATAL_ERROR "hypotrack_add_plugin: '${kind}' is no plugin kind: expected model, "
      "objective, optimizer or source")
  endif()
  if(NOT ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "hypotrack_add_plugin(${kind} ${name}): no source files given")
  endif()
  if(NOT ARG_VERSION)
    set(ARG_VERSION ${PROJECT_VERSION})
  endif()
  if(NOT ARG_VERSION)
    set(ARG_VERSION 0.0.0)
  endif()
  if(NOT ARG_LICENCE)
    set(ARG_LICENCE Apache-2.0)
  endif()

  set(target hypotrack_${kind}_${name})
  add_library(${target} MODULE ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${target} PRIVATE hypotrack::hypotrack ${ARG_LIBRARIES})
  target_compile_definitions(${target} PRIVATE
    HYPOTRACK_PLUGIN_KIND=${kind} HYPOTRACK_PLUGIN_NAME=${name}
    HYPOTRACK_PLUGIN_VERSION="${ARG_VERSION}" HYPOTRACK_PLUGIN_LICENCE="${ARG_LICENCE}")
  set_target_properties(${target} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
  if(TARGET hypotrack_options)  # inside the project
    target_link_libraries(${target} PRIVATE hypotrack_options)
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${HYPOTRACK_PLUGIN_DIR}
      INSTALL_RPATH "$ORIGIN/../..")
    install(TARGETS ${target} LIBRARY DESTINATION ${HYPOTRACK_PLUGIN_DIR})
    set_property(GLOBAL APPEND PROPERTY HYPOTRACK_PLUGINS ${target})
  endif()
endfunction()
