# cmake --install: the programs, their manual pages, completions and problems, and the package that other projects find with find_package(downwash).

include(CMakePackageConfigHelpers)

# Builds all that is installed, without tests and benchmarks.
add_custom_target(installed)
get_property(programs GLOBAL PROPERTY DOWNWASH_PROGRAMS)
if(programs)
  add_dependencies(installed ${programs})
  install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET downwash_python)
  add_dependencies(installed downwash_python)
endif()
if(DOWNWASH_HELP)
  add_dependencies(installed downwash_help)
  install(DIRECTORY ${DOWNWASH_HELP}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(FILES ${DOWNWASH_HELP}/downwash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${DOWNWASH_HELP}/_downwash DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${DOWNWASH_HELP}/downwash.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  # Where Debian's zsh looks below /usr.
  install(FILES ${DOWNWASH_HELP}/_downwash DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
    COMPONENT debian EXCLUDE_FROM_ALL)
endif()
set(DOWNWASH_INSTALL_DATADIR ${CMAKE_INSTALL_DATADIR}/downwash)
install(DIRECTORY problems/ DESTINATION ${DOWNWASH_INSTALL_DATADIR}/problems
  FILES_MATCHING PATTERN generators EXCLUDE PATTERN "*.yaml" PATTERN "*.json" PATTERN "*.stl" PATTERN "*.bt" PATTERN "*.csv")
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Shared libraries hide what the modules are built with (Eigen, OMPL, yaml-cpp), so a program that links them needs none of it.
# Static libraries would pass it all on, so they are for this build only.
if(NOT BUILD_SHARED_LIBS)
  message(STATUS "Static modules: only the program and its problems will be installed, no libraries and headers")
  return()
endif()

get_property(modules GLOBAL PROPERTY DOWNWASH_MODULES)
set(in_wheel "")
if(TARGET downwash_python)
  downwash_linked_targets(in_wheel downwash_python)
endif()
set(DOWNWASH_PKGCONFIG_LIBS "")
foreach(module IN LISTS modules)
  # The component ompl needs OMPL, so it is exported apart.
  set(export downwash_targets)
  if(module STREQUAL ompl)
    set(export downwash_ompl_targets)
  endif()
  add_dependencies(installed downwash_${module})
  install(TARGETS downwash_${module} EXPORT ${export}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/downwash/${module})
  if(downwash_${module} IN_LIST in_wheel)
    # Beside the module. The headers of this component are never installed.
    install(TARGETS downwash_${module}
      LIBRARY DESTINATION downwash COMPONENT wheel EXCLUDE_FROM_ALL NAMELINK_SKIP
      PUBLIC_HEADER DESTINATION downwash COMPONENT no_headers EXCLUDE_FROM_ALL)
  endif()
  if(NOT module STREQUAL ompl)
    string(PREPEND DOWNWASH_PKGCONFIG_LIBS "-ldownwash_${module} ")
  endif()
endforeach()
string(STRIP "${DOWNWASH_PKGCONFIG_LIBS}" DOWNWASH_PKGCONFIG_LIBS)

install(FILES ${DOWNWASH_INCLUDE_DIR}/downwash/standard_library.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/downwash)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/downwash)
install(EXPORT downwash_targets NAMESPACE downwash:: DESTINATION ${package_dir})
install(EXPORT downwash_ompl_targets NAMESPACE downwash:: DESTINATION ${package_dir})
install(FILES cmake/libompl.cmake DESTINATION ${package_dir})
configure_package_config_file(cmake/downwash-config.cmake.in ${PROJECT_BINARY_DIR}/cmake/downwash-config.cmake
  INSTALL_DESTINATION ${package_dir}
  PATH_VARS DOWNWASH_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/downwash-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/cmake/downwash-config.cmake
  ${PROJECT_BINARY_DIR}/cmake/downwash-config-version.cmake
  DESTINATION ${package_dir})

set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH DOWNWASH_PKGCONFIG_PREFIX /prefix/${pkgconfig_dir} /prefix)
string(REGEX REPLACE "/$" "" DOWNWASH_PKGCONFIG_PREFIX ${DOWNWASH_PKGCONFIG_PREFIX})
configure_file(cmake/downwash.pc.in ${PROJECT_BINARY_DIR}/cmake/downwash.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cmake/downwash.pc DESTINATION ${pkgconfig_dir})

include(cmake/package.cmake)
