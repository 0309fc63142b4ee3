# Flags for the project's own targets; an installed package carries none of them but the standard.
add_library(hypotrack_options INTERFACE)
target_compile_options(hypotrack_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual>
  # Of Clang: sources open the namespaces `internal` without saying that they are inline.
  $<$<COMPILE_LANGUAGE:CXX>:-Wno-inline-namespace-reopened-noninline>
  # Of GCC 13 and newer: it takes equal destructors of vectors of two types for one that frees wrongly.
  $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-free-nonheap-object>
  $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra>
  $<$<BOOL:${HYPOTRACK_WERROR}>:$<$<COMPILE_LANGUAGE:CXX>:-Werror>$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Werror --Werror=all-warnings>>)
# GCC collects its garbage from 128 MiB on, which takes a tenth of the time of such large sources.
target_compile_options(hypotrack_options INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=524288>)
# Libraries call their own functions, inline where they are small, as if these were hidden.
target_compile_options(hypotrack_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-fno-semantic-interposition>)
target_link_options(hypotrack_options INTERFACE -Wl,-Bsymbolic-functions)
# As fmt::fmt has them, for targets that include fmt with the precompiled header only.
target_compile_definitions(hypotrack_options INTERFACE
  $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
if(HYPOTRACK_SANITIZE)
  target_compile_options(hypotrack_options INTERFACE
    -fsanitize=${HYPOTRACK_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(hypotrack_options INTERFACE -fsanitize=${HYPOTRACK_SANITIZE})
  if(HYPOTRACK_SANITIZE STREQUAL "thread")  # GCC warns of the fences in Asio
    target_compile_options(hypotrack_options INTERFACE
      $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-tsan>)
  endif()
endif()

# hypotrack_export_own_names(TARGET): of what is not hidden (hypotrack_hide_names) the library exports
# what is in the namespace hypotrack, and nothing of the libraries that are compiled into it: their
# templates are visible where their headers say so.
function(hypotrack_export_own_names target)
  set(names ${PROJECT_SOURCE_DIR}/cmake/exported_names.map)
  target_link_options(${target} PRIVATE -Wl,--version-script=${names})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${names})
endfunction()
