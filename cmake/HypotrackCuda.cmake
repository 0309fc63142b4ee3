# Sets HYPOTRACK_HAS_CUDA and enables the language where a toolkit is found and wanted.
set(HYPOTRACK_CUDA AUTO CACHE STRING
  "GPU backend: AUTO builds it where a CUDA toolkit is found, ON demands one, OFF leaves it out")
set_property(CACHE HYPOTRACK_CUDA PROPERTY STRINGS AUTO ON OFF)
set(hypotrack_cuda_oldest 12.4)  # C++20, programmatic launches in graphs

set(HYPOTRACK_HAS_CUDA OFF)
if(HYPOTRACK_CUDA)
  if(NOT CMAKE_CUDA_ARCHITECTURES)
    # Real code for every generation and PTX for those to come.
    set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86-real 89-real 90)
  endif()
  find_package(CUDAToolkit ${hypotrack_cuda_oldest} QUIET)
  if(CUDAToolkit_FOUND AND NOT CMAKE_CUDA_COMPILER)
    set(CMAKE_CUDA_COMPILER ${CUDAToolkit_NVCC_EXECUTABLE})
  endif()
  if(CUDAToolkit_FOUND AND CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    set(HYPOTRACK_HAS_CUDA ON)
  elseif(HYPOTRACK_CUDA STREQUAL "ON")
    message(FATAL_ERROR "HYPOTRACK_CUDA is ON but no CUDA toolkit ${hypotrack_cuda_oldest} or newer "
      "was found: install one, say where it is with -DCUDAToolkit_ROOT=DIR, or build with "
      "-DHYPOTRACK_CUDA=OFF")
  endif()
endif()
if(HYPOTRACK_HAS_CUDA)
  set(CMAKE_CUDA_STANDARD 20)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  set(CMAKE_CUDA_EXTENSIONS OFF)
  set(CMAKE_CUDA_VISIBILITY_PRESET hidden)
  message(STATUS "CUDA ${CUDAToolkit_VERSION}: the GPU backend is built for ${CMAKE_CUDA_ARCHITECTURES}")
else()
  message(STATUS "The GPU backend is not built (HYPOTRACK_CUDA=${HYPOTRACK_CUDA})")
endif()
