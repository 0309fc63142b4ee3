# Takes the place of cmake/HypotrackCuda.cmake where this folder is on CMAKE_MODULE_PATH: GPU code is
# compiled as C++ and runs on the CPU, without a CUDA toolkit.

# Has the signature of the macro that it replaces.
macro(hypotrack_find_cuda)
  if(NOT TARGET hypotrack_cuda_on_cpu)
    add_subdirectory(${PROJECT_SOURCE_DIR}/tests/cuda_on_cpu)
  endif()
  set(HYPOTRACK_HAS_CUDA ON)
  set(hypotrack_cuda_target "the CPU, to be tested there")
endmacro()

# Has the signature of the function that it replaces.
function(hypotrack_cuda_sources target)
  cmake_parse_arguments(ARG "" "" "NO_CUDA_SOURCES" ${ARGN})
  target_sources(${target} PRIVATE ${ARG_UNPARSED_ARGUMENTS})
  # In front of hypotrack's own folders, for it has headers in their place.
  target_include_directories(${target} BEFORE PRIVATE
    $<TARGET_PROPERTY:hypotrack_cuda_on_cpu,INTERFACE_INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE CUDA::cudart_static)
  set(kernels ${ARG_UNPARSED_ARGUMENTS})
  list(FILTER kernels INCLUDE REGEX "\\.cu$")
  list(TRANSFORM kernels PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  set_source_files_properties(${kernels} TARGET_DIRECTORY ${target} PROPERTIES LANGUAGE CXX
    SKIP_PRECOMPILE_HEADERS ON
    COMPILE_OPTIONS "-x;c++;-D__CUDACC__;-D__CUDA_ARCH__=750;-include;cuda_runtime.h;-ffp-contract=off;-Wno-unknown-pragmas;-Wno-unused-parameter;-Wno-maybe-uninitialized;-Wno-shadow")
endfunction()
