# hypotrack_plugin_kinds(OUT): the names in the table of kinds in hypotrack/plugin/plugin.hpp. This file lies
# in the source tree, in PREFIX/lib/cmake/hypotrack or in PREFIX/lib/ARCHITECTURE/cmake/hypotrack.
function(hypotrack_plugin_kinds out)
  set(here ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  find_file(header hypotrack/plugin/plugin.hpp NO_CACHE NO_DEFAULT_PATH REQUIRED
    PATHS ${here}/../core/include ${here}/../../../include ${here}/../../../../include)
  file(READ ${header} text)
  string(REGEX MATCHALL "\n  KIND\\([a-z]+," kinds "${text}")
  list(TRANSFORM kinds REPLACE "[^a-z]" "")
  set(${out} ${kinds} PARENT_SCOPE)
endfunction()

# hypotrack_add_plugin(KIND NAME SOURCES... [CUDA_SOURCES ...] [NO_CUDA_SOURCES ...]
#                      [VERSION 1.2.3] [LICENCE Apache-2.0] [LIBRARIES ...]
#                      [CONTRACT_CONFIG parameters.yaml])
#
# Builds libhypotrack_<KIND>_<NAME>.so, which a scene names with `type: NAME`. KIND is one of
# hypotrack_plugin_kinds(). Inside the project the library goes where hypotrack looks for it and is
# installed; outside, it goes to the build folder: put that on --plugin-path or HYPOTRACK_PLUGIN_PATH. With enable_testing() the contract tests of its kind run on it, with the
# parameters in CONTRACT_CONFIG (what stands in the plugin's place in a scene) or the defaults.
#
# CUDA_SOURCES, and .cu files among SOURCES, need a CUDA toolkit; where there is none,
# NO_CUDA_SOURCES are built in their place. HYPOTRACK_CUDA=ON demands a toolkit, OFF does without.
# The architectures are those of hypotrack itself unless CMAKE_CUDA_ARCHITECTURES says otherwise.
# Call it at file scope, not in a function: it enables the language.
macro(hypotrack_add_plugin kind name)
  set(hypotrack_cuda_files ${ARGN})
  list(FILTER hypotrack_cuda_files INCLUDE REGEX "^CUDA_SOURCES$|\\.cu$")
  if(hypotrack_cuda_files)
    hypotrack_find_cuda()
  endif()
  hypotrack_add_plugin_library(${kind} ${name} ${ARGN})
endmacro()

# hypotrack_compile_alone(SOURCES...): keeps sources that include themselves once per instruction set
# (hypotrack/plugin/foreach_target-inl.hpp) out of unity builds and without a precompiled header: GCC takes
# options such as -ffp-contract from there, where a pragma selects an instruction set.
function(hypotrack_compile_alone)
  foreach(source IN LISTS ARGN)
    get_filename_component(file ${source} ABSOLUTE)
    if(EXISTS ${file})
      file(STRINGS ${file} includes_itself REGEX "define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
      if(includes_itself)
        set_source_files_properties(${file} PROPERTIES
          SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
        if(HYPOTRACK_FUZZ)  # they read no files, and clang takes minutes for them
          set_property(SOURCE ${file} APPEND PROPERTY COMPILE_OPTIONS
            -fno-sanitize=all -O0 -DHWY_COMPILE_ONLY_STATIC)
        endif()
      endif()
    endif()
  endforeach()
endfunction()

function(hypotrack_add_plugin_library kind name)
  cmake_parse_arguments(ARG "" "VERSION;LICENCE;CONTRACT_CONFIG"
    "LIBRARIES;CUDA_SOURCES;NO_CUDA_SOURCES" ${ARGN})
  hypotrack_plugin_kinds(kinds)
  if(NOT kind IN_LIST kinds)
    list(JOIN kinds ", " kinds)
    message(FATAL_ERROR "hypotrack_add_plugin: '${kind}' is no plugin kind: expected one of ${kinds}")
  endif()
  if(NOT name MATCHES "^[a-z0-9_]+$")
    message(FATAL_ERROR "hypotrack_add_plugin: '${name}' is no name of a plugin: expected small "
      "letters, digits and underscores")
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
  set(cuda_sources ${ARG_UNPARSED_ARGUMENTS})
  list(FILTER cuda_sources INCLUDE REGEX "\\.cu$")
  list(FILTER ARG_UNPARSED_ARGUMENTS EXCLUDE REGEX "\\.cu$")
  list(APPEND cuda_sources ${ARG_CUDA_SOURCES})
  add_library(${target} MODULE ${ARG_UNPARSED_ARGUMENTS})
  hypotrack_compile_alone(${ARG_UNPARSED_ARGUMENTS})
  if(cuda_sources)
    hypotrack_cuda_sources(${target} ${cuda_sources} NO_CUDA_SOURCES ${ARG_NO_CUDA_SOURCES})
  endif()
  # Highway's foreach_target includes a source by its name.
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE hypotrack::hypotrack ${ARG_LIBRARIES})
  if(NOT "${HYPOTRACK_SANITIZE} ${CMAKE_CXX_FLAGS}" MATCHES "address|thread|undefined|sanitize")
    target_link_options(${target} PRIVATE -Wl,-z,defs)  # what is missing is an error now, not when loading
  endif()
  target_compile_definitions(${target} PRIVATE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>
    HYPOTRACK_PLUGIN_KIND=${kind} HYPOTRACK_PLUGIN_NAME=${name}
    HYPOTRACK_PLUGIN_VERSION="${ARG_VERSION}" HYPOTRACK_PLUGIN_LICENCE="${ARG_LICENCE}")
  set_target_properties(${target} PROPERTIES
    CXX_VISIBILITY_PRESET hidden CUDA_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON
    HYPOTRACK_PLUGIN_ID "${kind};${name}")
  if(ARG_CONTRACT_CONFIG)
    get_filename_component(contract_config ${ARG_CONTRACT_CONFIG} ABSOLUTE)
    set_target_properties(${target} PROPERTIES HYPOTRACK_CONTRACT_CONFIG ${contract_config})
  endif()
  if(TARGET hypotrack_options)  # inside the project
    target_link_libraries(${target} PRIVATE hypotrack_options)
    hypotrack_hide_names(${target})
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${HYPOTRACK_PLUGIN_DIR}
      INSTALL_RPATH "$ORIGIN/../..")
    set_property(GLOBAL APPEND PROPERTY HYPOTRACK_PLUGINS ${target})
  elseif(CMAKE_TESTING_ENABLED)  # inside the project tests/contract does it
    hypotrack_add_contract_test(${target})
  endif()
endfunction()

# hypotrack_add_contract_test(TARGET)
#
# A test `contract.KIND.NAME` that holds a plugin of hypotrack_add_plugin() to the contract of its
# kind, by the program that hypotrack was built with or that lies in its installation.
function(hypotrack_add_contract_test target)
  if(TARGET hypotrack_contract_test)
    set(program hypotrack_contract_test)
  else()
    # This file lies in PREFIX/lib/cmake/hypotrack or PREFIX/lib/ARCHITECTURE/cmake/hypotrack.
    find_program(HYPOTRACK_CONTRACT_TEST hypotrack_contract_test
      HINTS ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../../../bin
            ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../../../../bin)
    if(NOT HYPOTRACK_CONTRACT_TEST)
      message(WARNING "hypotrack_contract_test is not installed: ${target} gets no contract test")
      return()
    endif()
    set(program ${HYPOTRACK_CONTRACT_TEST})
  endif()
  get_target_property(id ${target} HYPOTRACK_PLUGIN_ID)
  list(GET id 0 kind)
  list(GET id 1 name)
  get_target_property(config ${target} HYPOTRACK_CONTRACT_CONFIG)
  if(NOT config)
    set(config "")
  endif()
  add_test(NAME contract.${kind}.${name}
    COMMAND ${program} ${kind} $<TARGET_FILE:${target}> ${config})
  set_tests_properties(contract.${kind}.${name} PROPERTIES TIMEOUT 300)
endfunction()
