# cpack in the build folder, or `./dev package`: a Debian package of all that is installed, for machines without a compiler.

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(DOWNWASH_PACKAGE_CONTACT "The Downwash authors <downwash@localhost>" CACHE STRING "Who maintains the Debian package")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME downwash)
set(CPACK_PACKAGE_CONTACT "${DOWNWASH_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
  "The program, its manual pages and completions, problems to begin with, the C++ library, and the Python package if it was built.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_VERBATIM_VARIABLES ON)

# One package of what `cmake --install` puts below a prefix, with Python and zsh files where Debian wants them.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_COMPONENTS_ALL Unspecified debian)

# The libraries that programs and modules need are found in them; programs that Downwash starts, and what headers include, are not.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS libompl-dev)
if(TARGET downwash_python)
  # The module is of one version of Python. The program does not need it.
  math(EXPR next_minor "${DOWNWASH_PYTHON_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS
    ", python3 (>= 3.${DOWNWASH_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", python3-matplotlib, python3-pandas")
endif()

include(CPack)
