# Flags for the project's own targets; an installed package carries none of them but the standard.
add_library(hypotrack_options INTERFACE)
target_compile_options(hypotrack_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual>
  $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra>
  $<$<BOOL:${HYPOTRACK_WERROR}>:$<$<COMPILE_LANGUAGE:CXX>:-Werror>$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Werror --Werror=all-warnings>>)
# As fmt::fmt has them, for targets that include fmt with the precompiled header only.
target_compile_definitions(hypotrack_options INTERFACE
  $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
if(HYPOTRACK_SANITIZE)
  target_compile_options(hypotrack_options INTERFACE
    -fsanitize=${HYPOTRACK_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(hypotrack_options INTERFACE -fsanitize=${HYPOTRACK_SANITIZE})
endif()
