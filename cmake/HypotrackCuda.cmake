# CUDA for hypotrack and, installed, for plugins outside its tree.
set(HYPOTRACK_CUDA AUTO CACHE STRING
  "GPU code: AUTO builds it where a CUDA toolkit is found, ON demands one, OFF leaves it out")
set_property(CACHE HYPOTRACK_CUDA PROPERTY STRINGS AUTO ON OFF)
set(hypotrack_cuda_oldest 12.4)  # C++20, programmatic launches in graphs
if(NOT hypotrack_cuda_architectures)  # an installed package says what hypotrack was built for
  # Real code for every generation and PTX for those to come.
  set(hypotrack_cuda_architectures 75-real 80-real 86-real 89-real 90)
endif()

# hypotrack_find_cuda()
#
# Enables the language where a toolkit is found and wanted, and sets HYPOTRACK_HAS_CUDA. Sets
# hypotrack_cuda_target to what the code is built for, or hypotrack_why_no_cuda. A macro, because
# enable_language() has to happen at file scope.
macro(hypotrack_find_cuda)
  set(HYPOTRACK_HAS_CUDA OFF)
  set(hypotrack_why_no_cuda "HYPOTRACK_CUDA is OFF: set it to AUTO or ON")
  if(HYPOTRACK_CUDA)
    if(NOT CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
      set(CMAKE_CUDA_ARCHITECTURES ${hypotrack_cuda_architectures})
    endif()
    find_package(CUDAToolkit ${hypotrack_cuda_oldest} QUIET)
    if(CUDAToolkit_FOUND AND NOT CMAKE_CUDA_COMPILER)
      set(CMAKE_CUDA_COMPILER ${CUDAToolkit_NVCC_EXECUTABLE})
    endif()
    if(CUDAToolkit_FOUND AND CMAKE_CUDA_COMPILER)
      get_property(hypotrack_languages GLOBAL PROPERTY ENABLED_LANGUAGES)
      if(CMAKE_CURRENT_FUNCTION AND NOT CUDA IN_LIST hypotrack_languages)
        message(FATAL_ERROR "CUDA can be enabled at file scope only, this is the function "
          "${CMAKE_CURRENT_FUNCTION}: write project(... LANGUAGES CXX CUDA) or call "
          "hypotrack_find_cuda() before it")
      endif()
      enable_language(CUDA)
      if(NOT DEFINED CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 stops at 17
        set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
        set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
      endif()
      set(HYPOTRACK_HAS_CUDA ON)
      set(hypotrack_cuda_target "${CMAKE_CUDA_ARCHITECTURES} with CUDA ${CUDAToolkit_VERSION}")
    else()
      string(CONCAT hypotrack_why_no_cuda "no CUDA toolkit ${hypotrack_cuda_oldest} or newer was "
        "found (found: ${CUDAToolkit_VERSION}): install one, or say where it is with "
        "-DCUDAToolkit_ROOT=DIR")
      string(REPLACE "(found: )" "(found: none)" hypotrack_why_no_cuda "${hypotrack_why_no_cuda}")
      if(HYPOTRACK_CUDA STREQUAL "ON")
        message(FATAL_ERROR "HYPOTRACK_CUDA is ON, but ${hypotrack_why_no_cuda}, or build without: "
          "-DHYPOTRACK_CUDA=OFF")
      endif()
    endif()
  endif()
endmacro()

# hypotrack_cuda_sources(TARGET SOURCES... [NO_CUDA_SOURCES SOURCES...])
#
# Gives a target sources that are built with CUDA only (.cu, and C++ that uses the runtime), and
# those that stand in for them without it.
function(hypotrack_cuda_sources target)
  cmake_parse_arguments(ARG "" "" "NO_CUDA_SOURCES" ${ARGN})
  set_target_properties(${target} PROPERTIES HYPOTRACK_HAS_CUDA_VARIANT ON)
  if(HYPOTRACK_HAS_CUDA)
    target_sources(${target} PRIVATE ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${target} PRIVATE CUDA::cudart_static)
    # Products and sums are contracted where the code says fmaf() and nowhere else: else the compiler
    # decides, and differently for every kernel that the same arithmetic is in.
    target_compile_options(${target} PRIVATE
      "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;--fmad=false>")
    # Every library has a runtime of its own; they share the device's primary context.
    set_target_properties(${target} PROPERTIES CUDA_RUNTIME_LIBRARY Static
      CUDA_STANDARD 20 CUDA_STANDARD_REQUIRED ON CUDA_EXTENSIONS OFF)
  elseif(ARG_NO_CUDA_SOURCES)
    target_sources(${target} PRIVATE ${ARG_NO_CUDA_SOURCES})
  else()
    list(JOIN ARG_UNPARSED_ARGUMENTS ", " sources)
    message(FATAL_ERROR "${target}: ${sources} cannot be built, ${hypotrack_why_no_cuda}; or list "
      "what stands in for it: NO_CUDA_SOURCES cuda_absent.cpp")
  endif()
endfunction()
