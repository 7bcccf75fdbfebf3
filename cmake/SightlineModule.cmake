# One module of the house: a library that is built, installed and exported under the name
# sightline::<module>.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(SIGHTLINE_INSTALL_CMAKE ${CMAKE_INSTALL_LIBDIR}/cmake/sightline)
# Below a folder of our own, so that <linespace/scene.h> cannot meet somebody else's.
set(SIGHTLINE_INSTALL_INCLUDE ${CMAKE_INSTALL_INCLUDEDIR}/sightline)

# sightline_module(<module>
#                  SOURCES file...       the .cpp files
#                  HEADERS file...       the public headers, those at the top of the module
#                  [MODULES module...]   modules of ours below this one
#                  [PUBLIC target...]    what the public headers include
#                  [PRIVATE target...]   what only the .cpp files use
#                  [PACKAGES "find_package arguments"...])
#
# PACKAGES are repeated by the installed package's configuration: a static library hands
# even its private dependencies on to the final link.
function(sightline_module module)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" ""
                        "SOURCES;HEADERS;MODULES;PUBLIC;PRIVATE;PACKAGES")
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "sightline_module(${module}): unknown ${ARG_UNPARSED_ARGUMENTS}")
  endif()

  add_library(${module} ${ARG_SOURCES})
  add_library(sightline::${module} ALIAS ${module})
  set_target_properties(
    ${module} PROPERTIES OUTPUT_NAME sightline_${module} EXPORT_NAME ${module}
                         VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  target_sources(${module} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                                  FILES ${ARG_HEADERS})
  target_compile_features(${module} PUBLIC cxx_std_20)
  list(TRANSFORM ARG_MODULES PREPEND sightline:: OUTPUT_VARIABLE ours)
  target_link_libraries(${module} PUBLIC ${ours} ${ARG_PUBLIC}
                                  PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:sightline_flags>)

  install(TARGETS ${module} EXPORT sightline-${module}-targets
          FILE_SET HEADERS DESTINATION ${SIGHTLINE_INSTALL_INCLUDE})
  install(EXPORT sightline-${module}-targets NAMESPACE sightline::
          DESTINATION ${SIGHTLINE_INSTALL_CMAKE})
  sightline_install_module_config(${module} "${ARG_MODULES}" "${ARG_PACKAGES}")
  set_property(GLOBAL APPEND PROPERTY SIGHTLINE_MODULES ${module})
endfunction()

# sightline-<module>.cmake: finds what the module needs, then defines its target.
function(sightline_install_module_config module modules packages)
  set(file ${PROJECT_BINARY_DIR}/sightline-${module}.cmake)
  list(TRANSFORM packages REPLACE "(.+)" "find_dependency(\\1)\n")
  list(TRANSFORM modules REPLACE
       "(.+)" "include(\"\${CMAKE_CURRENT_LIST_DIR}/sightline-\\1.cmake\")\n")
  list(JOIN packages "" packages)
  list(JOIN modules "" modules)
  file(WRITE ${file} "${packages}${modules}"
       "include(\"\${CMAKE_CURRENT_LIST_DIR}/sightline-${module}-targets.cmake\")\n")
  install(FILES ${file} DESTINATION ${SIGHTLINE_INSTALL_CMAKE})
endfunction()

# Installs sightline-config.cmake for the modules that were built; call it last.
function(sightline_install_package)
  get_property(SIGHTLINE_MODULES GLOBAL PROPERTY SIGHTLINE_MODULES)
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/sightline-config.cmake.in
    ${PROJECT_BINARY_DIR}/sightline-config.cmake
    INSTALL_DESTINATION ${SIGHTLINE_INSTALL_CMAKE} NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/sightline-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/sightline-config.cmake
                ${PROJECT_BINARY_DIR}/sightline-config-version.cmake
          DESTINATION ${SIGHTLINE_INSTALL_CMAKE})
endfunction()
