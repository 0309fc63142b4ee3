# Installation and the package that find_package(hypotrack) finds.
#
# Components, which Debian packages are made of:
#   library        libhypotrack, what it loads, and whatever is built otherwise with CUDA
#   program        the program, other plugins, data
#   development    headers, CMake files, the contract test
#   python, lab, documentation
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hypotrack)

install(TARGETS hypotrack EXPORT hypotrack LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT library NAMELINK_COMPONENT development)
set(in_library hypotrack hypotrack_hand_detector hypotrack_plugin_probe hypotrack_doctor_probe)
get_property(plugins GLOBAL PROPERTY HYPOTRACK_PLUGINS)
foreach(plugin IN LISTS plugins)
  set(component program)
  get_target_property(parts ${plugin} LINK_LIBRARIES)
  foreach(part IN LISTS parts ITEMS ${plugin})
    if(TARGET ${part})
      get_target_property(has_variant ${part} HYPOTRACK_HAS_CUDA_VARIANT)
      if(has_variant)
        set(component library)
        list(APPEND in_library ${plugin})
      endif()
    endif()
  endforeach()
  install(TARGETS ${plugin} LIBRARY DESTINATION ${HYPOTRACK_PLUGIN_DIR} COMPONENT ${component})
endforeach()
add_custom_target(hypotrack_library DEPENDS ${in_library})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/core/include/hypotrack
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT hypotrack NAMESPACE hypotrack:: FILE hypotrack-targets.cmake
  DESTINATION ${package_dir} COMPONENT development)

set(built_for)
if(CMAKE_CUDA_COMPILER)
  set(built_for ${CMAKE_CUDA_ARCHITECTURES})
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/hypotrack-config.cmake.in
  ${PROJECT_BINARY_DIR}/hypotrack-config.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_BINDIR)
# Before 1.0 a minor version may change the plugin ABI.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hypotrack-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/hypotrack-config.cmake
  ${PROJECT_BINARY_DIR}/hypotrack-config-version.cmake
  ${CMAKE_CURRENT_LIST_DIR}/HypotrackCuda.cmake
  ${CMAKE_CURRENT_LIST_DIR}/HypotrackPlugin.cmake
  DESTINATION ${package_dir} COMPONENT development)
# configs/data is the user's: recordings and meshes that scenes name.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${HYPOTRACK_DATA_DIR}
  REGEX "/configs/data$" EXCLUDE)
# `hypotrack plugins new` writes what the guide for authors shows.
install(FILES ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md RENAME plugin_guide.md
  DESTINATION ${HYPOTRACK_DATA_DIR})
configure_file(${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
  ${PROJECT_BINARY_DIR}/${HYPOTRACK_DATA_DIR}/plugin_guide.md COPYONLY)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
# The build tree has the configs, too, in the same place.
file(GLOB_RECURSE configs CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/configs/*)
list(FILTER configs EXCLUDE REGEX "^configs/data(/|$)")
foreach(config IN LISTS configs)
  configure_file(${PROJECT_SOURCE_DIR}/${config}
    ${PROJECT_BINARY_DIR}/${HYPOTRACK_DATA_DIR}/${config} COPYONLY)
endforeach()
