# The libraries of others: first what every part of Downwash needs, then the components that need more and are left out where
# that is not installed. docs/dependencies.md says what each library is for.

find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json REQUIRED)
find_package(fcl REQUIRED)

include(cmake/libompl.cmake)
downwash_add_libompl(downwash_libompl)

# downwash_component(NAME "what it is" NEEDS components... FINDS packages... DEBIAN packages...)
# Sets DOWNWASH_HAS_NAME, and says what is left out and why. DOWNWASH_BUILD_NAME decides: ON (an error if a package is missing),
# OFF, or AUTO, which builds the component if its packages are installed.
macro(downwash_component NAME WHAT)
  cmake_parse_arguments(COMPONENT "" "" "NEEDS;FINDS;DEBIAN" ${ARGN})
  set(DOWNWASH_BUILD_${NAME} AUTO CACHE STRING "Build ${WHAT}: ON, OFF, or AUTO if the packages are installed")
  set(component_missing "")
  foreach(needed IN LISTS COMPONENT_NEEDS)
    if(NOT DOWNWASH_HAS_${needed})
      list(APPEND component_missing "the component ${needed}")
    endif()
  endforeach()
  foreach(package IN LISTS COMPONENT_FINDS)
    find_package(${package} QUIET)
    if(NOT ${package}_FOUND)
      list(APPEND component_missing ${package})
    endif()
  endforeach()
  set(DOWNWASH_HAS_${NAME} OFF)
  if(NOT DOWNWASH_BUILD_${NAME})
    message(STATUS "Left out: ${WHAT}, as DOWNWASH_BUILD_${NAME} is ${DOWNWASH_BUILD_${NAME}}")
  elseif(component_missing)
    list(JOIN component_missing ", " component_missing)
    list(JOIN COMPONENT_DEBIAN " " component_packages)
    set(component_message "${WHAT}. Missing: ${component_missing}. Debian packages: ${component_packages}")
    if(NOT DOWNWASH_BUILD_${NAME} STREQUAL "AUTO")
      message(FATAL_ERROR "DOWNWASH_BUILD_${NAME} is ${DOWNWASH_BUILD_${NAME}}, but not all is there for ${component_message}")
    endif()
    message(STATUS "Left out: ${component_message}")
  else()
    set(DOWNWASH_HAS_${NAME} ON)
  endif()
endmacro()

list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)  # the package brings its own finder
downwash_component(JUDGE "the judge of plans, and downwash validate")
downwash_component(FITTING "fits of surface-effect models to measurements, and downwash aeromap fit and compare"
  FINDS Ceres DEBIAN libceres-dev)
downwash_component(EXPORTS "exports of runs for other programs, and downwash export"
  FINDS GeographicLib DEBIAN libgeographiclib-dev)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # finders of our own
downwash_component(ROBOT_IMPORT "robots from URDF, SDF and MJCF, and downwash robot import"
  FINDS URDFDOM SDFormat MuJoCo pugixml DEBIAN liburdfdom-dev libsdformat-dev libmujoco-dev libpugixml-dev)
downwash_component(IDENTIFICATION "vehicles identified from logs, and downwash identify"
  FINDS Ceres DEBIAN libceres-dev)
downwash_component(REPORT "pictures and pages of runs"
  FINDS fmt ZLIB DEBIAN libfmt-dev zlib1g-dev)
downwash_component(CAMPAIGNS "campaigns and studies, downwash bench and downwash study"
  FINDS fmt SQLite3 DEBIAN libfmt-dev libsqlite3-dev)
downwash_component(CLI "the program downwash and its documentation"
  NEEDS REPORT
  FINDS CLI11 fmt DEBIAN libcli11-dev libfmt-dev)
